// What a service does: mesh after mesh. Little time goes by outside the segmentation itself, and no memory stays.
#include <quadseg/segmentation.h>

#include "datasets/generate.h"
#include "tests/pipeline/result_checks.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <malloc.h>
#include <unistd.h>

namespace quadseg::test {
namespace {

using Clock = std::chrono::steady_clock;

std::size_t resident_bytes() {
    std::ifstream statm("/proc/self/statm");
    std::size_t total = 0, resident = 0;
    statm >> total >> resident;
    return resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

datasets::Generated small_mesh(std::size_t i) {
    const std::vector<std::string> names = datasets::generator_names();
    // 1,000 to 20,000 faces, spread by the golden ratio; every fourth is a scan.
    const auto faces = static_cast<std::size_t>(1000 + 19000 * std::fmod(0.618034 * static_cast<double>(i), 1.0));
    return datasets::generate({names[i % names.size()], faces, i % 4 == 3 ? 1e-3 : 0, i + 1, true});
}

TEST(Service, ManySmallMeshesAreBoundByTheirSegmentation) {
    const bool all = std::getenv("QUADSEG_LONG_TESTS") != nullptr;
    const std::size_t meshes = all ? 1000 : 20, warm = meshes / 10;
    double loop = 0, kernels = 0;
    std::size_t before = 0, faces = 0;
    for (std::size_t i = 0; i < meshes; ++i) {
        if (i == warm) {
            malloc_trim(0);
            before = resident_bytes();
        }
        const datasets::Generated part = small_mesh(i);
        const auto start = Clock::now();
        {
            const Segmentation s = segment(part.mesh.view());
            kernels += s.seconds.prepare + s.seconds.coarse + s.seconds.fine + s.seconds.post;
            faces += s.labels.size();
        }
        loop += std::chrono::duration<double>(Clock::now() - start).count();
    }
    malloc_trim(0);
    const std::size_t after = resident_bytes();
    const double share = kernels / loop;
    RecordProperty("kernel_share", std::to_string(share));
    if (all) {
        std::printf("%zu meshes, %zu faces: %.1f s, %.1f %% of them in the phases; resident %.1f MB, then %.1f MB\n",
                    meshes, faces, loop, 100 * share, static_cast<double>(before) / 1e6,
                    static_cast<double>(after) / 1e6);
    }
    EXPECT_GE(share, 0.9);
    EXPECT_LE(after, before + (std::size_t{8} << 20));
}

}  // namespace
}  // namespace quadseg::test
