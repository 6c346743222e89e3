// Digests of many results, to be compared between builds (compilers.sh): other compilers and instruction sets must give
// the same bytes.
#include <quadseg/error.h>
#include <quadseg/io.h>
#include <quadseg/segmentation.h>

#include "datasets/generate.h"
#include "tests/pipeline/result_checks.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

namespace quadseg::test {
namespace {

constexpr std::size_t largest_file = 1000000;  // bytes: seconds a job, not minutes

/// FNV-1a, 64 bits.
std::uint64_t digest(const std::string& bytes) {
    std::uint64_t hash = 14695981039346656037ULL;
    for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
    return hash;
}

struct Way {
    const char* name;
    std::function<void(Options&)> set;
};

std::vector<Way> ways() {
    const auto paper = [](Options& o) {
        o.preset = Preset::paper;
        o.regions = 8;
        o.paper.lloyd_iterations = 4;
    };
    return {{"default", [](Options&) {}},
            {"regions", [](Options& o) { o.regions = 15; }},
            {"tolerance", [](Options& o) { o.tolerance = 1e-3; }},
            {"post",
             [](Options& o) {
                 o.smooth = o.project = o.project_joint = true;
                 o.feature_angle = 30;
             }},
            {"paper", paper},
            {"vsa",
             [=](Options& o) {
                 paper(o);
                 o.method = Method::vsa_l21;
             }},
            {"hybrid",
             [=](Options& o) {
                 paper(o);
                 o.method = Method::hybrid;
             }},
            {"hierarchical",
             [=](Options& o) {
                 paper(o);
                 o.method = Method::hierarchical;
             }},
            {"coarse", [=](Options& o) {
                 paper(o);
                 o.coarse = 1000;
             }}};
}

class Digests : public testing::Test {
  protected:
    void SetUp() override {
        const char* path = std::getenv("QUADSEG_DIGESTS");
        if (path == nullptr) GTEST_SKIP() << "QUADSEG_DIGESTS names no file to write them to";
        file_.open(path, std::ios::app);
        ASSERT_TRUE(file_) << path;
    }

    void add(const std::string& mesh_name, const MeshView& mesh, const Way& way) {
        Options options;
        way.set(options);
        const std::string first = bytes(mesh, options, 1);
        for (const int threads : {2, 3, 8}) {
            EXPECT_TRUE(bytes(mesh, options, threads) == first) << mesh_name << ' ' << way.name << ' ' << threads;
        }
        file_ << std::hex << digest(first) << ' ' << mesh_name << ' ' << way.name << '\n' << std::flush;
    }

  private:
    static std::string bytes(const MeshView& mesh, const Options& options, int threads) {
        Context context;
        context.set_threads(threads);
        return ResultBytes::of(segment(mesh, options, &context));
    }

    tbb::global_control eight_{tbb::global_control::max_allowed_parallelism, 8};

  protected:
    std::ofstream file_;
};

TEST_F(Digests, OfGeneratedMeshes) {
    for (const std::string& name : datasets::generator_names()) {
        for (const double noise : {0.0, 1e-3}) {
            const datasets::Generated part = datasets::generate(name, 1500, noise);
            const std::string mesh_name = name + (noise > 0 ? "-noisy" : "");
            file_ << std::hex
                  << digest(std::string(reinterpret_cast<const char*>(part.mesh.positions.data()),
                                        part.mesh.positions.size() * sizeof(double)))
                  << ' ' << mesh_name << " generated\n";
            for (const Way& way : ways()) add(mesh_name, part.mesh.view(), way);
        }
    }
}

TEST_F(Digests, OfSharedMeshes) {
    namespace fs = std::filesystem;
    const fs::path folder = fs::path(QUADSEG_SHARED_DIR) / "meshes";
    if (!fs::exists(folder)) GTEST_SKIP() << "no shared meshes here";
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (entry.is_regular_file() && entry.file_size() < largest_file) files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    for (const fs::path& path : files) {
        Mesh mesh;
        try {
            mesh = read_mesh(path.string());
        } catch (const Error&) {
            continue;  // a text beside the meshes
        }
        const std::vector<Way> all = ways();
        for (std::size_t w = 0; w < 2; ++w) add(path.filename().string(), mesh.view(), all[w]);
    }
}

}  // namespace
}  // namespace quadseg::test
