#include <quadseg/context.h>
#include <quadseg/segmentation.h>

#include "bench/rivals/adapter.h"

namespace quadseg::bench {
namespace {

/// One thread, as the rivals have.
class Ours : public Adapter {
  public:
    Ours(Preset preset, bool automatic) : automatic_(automatic) { options_.preset = preset; }

    void prepare(const Mesh& mesh, std::size_t regions) override {
        mesh_ = &mesh;
        if (!automatic_) options_.regions = regions;
        context_.set_threads(1);
    }
    void segment() override { labels_ = quadseg::segment(mesh_->view(), options_, &context_).labels; }
    std::vector<std::int32_t> labels() const override { return labels_; }

  private:
    const Mesh* mesh_ = nullptr;
    bool automatic_;
    Options options_;
    Context context_;
    std::vector<std::int32_t> labels_;
};

}  // namespace

std::unique_ptr<Adapter> make_ours() {
    return std::make_unique<Ours>(Preset::standard, false);
}
std::unique_ptr<Adapter> make_ours_automatic() {
    return std::make_unique<Ours>(Preset::standard, true);
}
std::unique_ptr<Adapter> make_ours_paper() {
    return std::make_unique<Ours>(Preset::paper, false);
}

}  // namespace quadseg::bench
