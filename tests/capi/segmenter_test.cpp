// The Segmenter of C: one prepared mesh, many operations; the same as in C++.
#include <quadseg/quadseg.h>
#include <quadseg/segmenter.h>

#include "tests/capi/shapes.h"

#include <gtest/gtest.h>
#include <memory>
#include <string>

namespace quadseg::capi_test {
namespace {

struct Destroy {
    void operator()(quadseg_segmenter* s) const { quadseg_segmenter_destroy(s); }
    void operator()(quadseg_segmentation* s) const { quadseg_segmentation_destroy(s); }
    void operator()(quadseg_context* c) const { quadseg_context_destroy(c); }
};
template <class Handle>
using Owned = std::unique_ptr<Handle, Destroy>;

quadseg_options paper_options() {
    quadseg_options o;
    quadseg_options_init(&o, sizeof o);
    o.preset = QUADSEG_PRESET_PAPER;
    return o;
}

Options cpp_options() {
    Options o;
    o.preset = Preset::paper;
    return o;
}

class CSegmenter : public testing::Test {
  protected:
    Arrays mesh = can();
    quadseg_mesh_view view = mesh.view();
    std::size_t faces = mesh.triangles.size() / 3;
    quadseg_options options = paper_options();

    Owned<quadseg_segmenter> create(quadseg_context* context = nullptr) {
        quadseg_segmenter* s = nullptr;
        EXPECT_EQ(quadseg_segmenter_create(&view, &options, context, &s), QUADSEG_OK) << quadseg_last_error();
        return Owned<quadseg_segmenter>(s);
    }
    std::vector<std::int32_t> labels(const Owned<quadseg_segmenter>& s) const {
        std::vector<std::int32_t> result(faces);
        EXPECT_EQ(quadseg_segmenter_labels(s.get(), result.data(), faces), QUADSEG_OK);
        return result;
    }
    static std::vector<std::int32_t> copy(std::span<const std::int32_t> l) { return {l.begin(), l.end()}; }
};

TEST_F(CSegmenter, StepsAsInCpp) {
    const auto s = create();
    Segmenter ours({mesh.positions, mesh.triangles}, cpp_options());
    EXPECT_EQ(quadseg_segmenter_regions(s.get()), 1U);
    std::int32_t label = 0;
    for (int i = 0; i < 3; ++i) {
        ASSERT_EQ(quadseg_segmenter_insert(s.get(), QUADSEG_WORST_FACE, &label), QUADSEG_OK);
        EXPECT_EQ(label, ours.insert());
    }
    ASSERT_EQ(quadseg_segmenter_insert(s.get(), 5, nullptr), QUADSEG_OK);
    ours.insert(5);
    double energy = 0;
    ASSERT_EQ(quadseg_segmenter_relax(s.get(), 4, &energy), QUADSEG_OK);
    EXPECT_EQ(energy, ours.relax(4));
    EXPECT_EQ(labels(s), copy(ours.labels()));
    double increase = 0;
    std::int32_t valid = -1;
    std::int32_t a = -1, b = -1;
    for (std::int32_t i = 0; i < 5 && b < 0; ++i) {
        for (std::int32_t j = i + 1; j < 5 && b < 0; ++j) {
            if (quadseg_segmenter_merge_candidate(s.get(), i, j, &increase, &valid) != QUADSEG_OK) continue;
            a = i;
            b = j;
        }
    }
    ASSERT_GE(b, 0);
    EXPECT_EQ(increase, ours.merge_candidate(a, b).increase);
    EXPECT_EQ(valid != 0, ours.merge_candidate(a, b).valid);
    ASSERT_EQ(quadseg_segmenter_merge(s.get(), a, b), QUADSEG_OK);
    ASSERT_EQ(quadseg_segmenter_smooth(s.get()), QUADSEG_OK);
    ours.merge(a, b);
    ours.smooth();
    EXPECT_EQ(labels(s), copy(ours.labels()));
    std::int32_t undone = -1;
    ASSERT_EQ(quadseg_segmenter_undo(s.get(), &undone), QUADSEG_OK);
    EXPECT_EQ(undone, 1);
    ours.undo();
    EXPECT_EQ(labels(s), copy(ours.labels()));
}

TEST_F(CSegmenter, OnePreparedMeshManyRuns) {
    const auto s = create();
    for (const std::uint64_t regions : {2U, 3U, 5U}) {
        options.regions = regions;
        ASSERT_EQ(quadseg_segmenter_set_options(s.get(), &options), QUADSEG_OK) << quadseg_last_error();
        std::int32_t stop = -1;
        ASSERT_EQ(quadseg_segmenter_run(s.get(), &stop), QUADSEG_OK);
        EXPECT_EQ(stop, QUADSEG_STOP_REGIONS);
        quadseg_segmentation *whole = nullptr, *reused = nullptr;
        ASSERT_EQ(quadseg_segment(&view, &options, nullptr, &whole), QUADSEG_OK);
        const Owned<quadseg_segmentation> whole_owner(whole);
        ASSERT_EQ(quadseg_segmenter_result(s.get(), &reused), QUADSEG_OK);
        const Owned<quadseg_segmentation> reused_owner(reused);
        std::vector<std::int32_t> theirs(faces), ours(faces);
        ASSERT_EQ(quadseg_segmentation_labels(whole, theirs.data(), faces), QUADSEG_OK);
        ASSERT_EQ(quadseg_segmentation_labels(reused, ours.data(), faces), QUADSEG_OK);
        EXPECT_EQ(ours, theirs);
    }
    ASSERT_EQ(quadseg_segmenter_set_options(s.get(), nullptr), QUADSEG_OK);
    ASSERT_EQ(quadseg_segmenter_run(s.get(), nullptr), QUADSEG_OK);
    EXPECT_EQ(quadseg_segmenter_regions(s.get()), 3U) << "side and two lids";
}

TEST_F(CSegmenter, MistakesAreNamedAndChangeNothing) {
    const auto s = create();
    const auto before = labels(s);
    const auto expect_refused = [&](quadseg_status status, const char* word) {
        EXPECT_EQ(status, QUADSEG_INVALID_ARGUMENT);
        EXPECT_NE(std::string(quadseg_last_error()).find(word), std::string::npos) << quadseg_last_error();
    };
    expect_refused(quadseg_segmenter_insert(s.get(), -2, nullptr), "face");
    expect_refused(quadseg_segmenter_insert(s.get(), 1000000, nullptr), "face");
    expect_refused(quadseg_segmenter_merge(s.get(), 0, 7), "region");
    expect_refused(quadseg_segmenter_relax(s.get(), -1, nullptr), "iterations");
    expect_refused(quadseg_segmenter_set_labels(s.get(), before.data(), 3), "labels");
    expect_refused(quadseg_segmenter_set_labels(s.get(), nullptr, faces), "labels");
    expect_refused(quadseg_segmenter_run(nullptr, nullptr), "segmenter");
    expect_refused(quadseg_segmenter_set_options(nullptr, &options), "segmenter");
    expect_refused(quadseg_segmenter_labels(nullptr, nullptr, 0), "segmenter");
    expect_refused(quadseg_segmenter_labels(s.get(), nullptr, faces), "labels");
    expect_refused(quadseg_segmenter_result(s.get(), nullptr), "segmentation");
    expect_refused(quadseg_segmenter_create(&view, &options, nullptr, nullptr), "segmenter");
    std::vector<std::int32_t> small(3, 77);
    EXPECT_EQ(quadseg_segmenter_labels(s.get(), small.data(), small.size()), QUADSEG_BUFFER_TOO_SMALL);
    EXPECT_EQ(small, std::vector<std::int32_t>(3, 77));
    options.detail = -1;
    expect_refused(quadseg_segmenter_set_options(s.get(), &options), "detail");
    quadseg_segmenter* none = s.get();
    expect_refused(quadseg_segmenter_create(&view, &options, nullptr, &none), "detail");
    EXPECT_EQ(none, nullptr);
    EXPECT_EQ(labels(s), before);
    EXPECT_EQ(quadseg_segmenter_regions(nullptr), 0U);
    quadseg_segmenter_destroy(nullptr);
}

TEST_F(CSegmenter, ACancelledContextIsReplaced) {
    quadseg_context* context = nullptr;
    ASSERT_EQ(quadseg_context_create(&context), QUADSEG_OK);
    Owned<quadseg_context> owner(context);
    const auto s = create(context);
    quadseg_context_cancel(context);
    EXPECT_EQ(quadseg_segmenter_relax(s.get(), 1, nullptr), QUADSEG_CANCELLED);
    owner.reset();  // the segmenter keeps what it needs
    EXPECT_EQ(quadseg_segmenter_relax(s.get(), 1, nullptr), QUADSEG_CANCELLED);
    ASSERT_EQ(quadseg_segmenter_set_context(s.get(), nullptr), QUADSEG_OK);
    std::vector<std::int32_t> two(faces, 4);
    two.front() = 2;
    ASSERT_EQ(quadseg_segmenter_set_labels(s.get(), two.data(), faces), QUADSEG_OK);
    EXPECT_EQ(quadseg_segmenter_regions(s.get()), 2U);
    EXPECT_EQ(labels(s).front(), 0);
}

}  // namespace
}  // namespace quadseg::capi_test
