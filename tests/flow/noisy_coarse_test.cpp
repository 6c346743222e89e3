#include "flow/noisy_coarse.h"

#include "datasets/generate.h"
#include "flow/noisy.h"
#include "runtime/parallel.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <string>

namespace quadseg {
namespace {

using flow::FlowResult;

constexpr flow::NoisyCoarseSizes small{30000, 20000};

struct Scan {
    datasets::Generated generated;
    mesh::WorkMesh mesh;

    Scan(const std::string& name, std::size_t faces, double noise)
        : generated(datasets::generate(name, faces, noise)),
          mesh(mesh::build_work_mesh(generated.mesh.view(), runtime::RunControl(nullptr))) {}

    FlowResult coarse(Context* context = nullptr, const flow::NoisyCoarseSizes& sizes = small) const {
        const runtime::RunControl control(context), free_run(nullptr);
        return flow::run_noisy_coarse({mesh, nullptr, {}, control}, flow::estimate_noise(mesh, free_run), sizes);
    }
    FlowResult directly() const {
        const runtime::RunControl control(nullptr);
        return flow::run_noisy({mesh, nullptr, {}, control}, flow::estimate_noise(mesh, control));
    }
    std::size_t surfaces() const { return generated.surfaces.size(); }
};

/// Under light noise on denoised vertices, under strong noise on their means.
TEST(NoisyCoarse, FindsAboutAsManyRegionsAsThereAreSurfaces) {
    for (const double noise : {0.001, 0.004}) {
        const Scan scan("quadrics", 100000, noise);
        const FlowResult result = scan.coarse();
        EXPECT_FALSE(result.partial);
        EXPECT_GE(result.regions, scan.surfaces() * 8 / 10) << noise;
        EXPECT_LE(result.regions, scan.surfaces() * 14 / 10) << noise;
        EXPECT_LT(result.regions, scan.directly().regions) << noise;
        EXPECT_GT(result.coarse_seconds, 0);
        ASSERT_EQ(result.labels.size(), scan.mesh.face_count());
        std::vector<std::size_t> faces(result.regions, 0);
        for (const std::int32_t label : result.labels) {
            ASSERT_GE(label, 0);
            ASSERT_LT(static_cast<std::size_t>(label), result.regions);
            ++faces[static_cast<std::size_t>(label)];
        }
        EXPECT_EQ(std::count(faces.begin(), faces.end(), 0U), 0);
    }
}

/// Folded faces would ruin the borders (flow/softened_mesh.h).
TEST(NoisyCoarse, NoiseAsLargeAsEdgesIsBorne) {
    const Scan scan("flange", 100000, 0.01);
    const FlowResult result = scan.coarse();
    EXPECT_FALSE(result.partial);
    EXPECT_GE(result.regions, scan.surfaces() / 2);
    EXPECT_LE(result.regions, scan.surfaces() * 14 / 10);
    ASSERT_EQ(result.labels.size(), scan.mesh.face_count());
    EXPECT_GE(*std::min_element(result.labels.begin(), result.labels.end()), 0);
    EXPECT_GT(result.noise, 0);
}

TEST(NoisyCoarse, SmallMeshesAreSegmentedDirectly) {
    const Scan scan("shaft", 20000, 0.001);
    EXPECT_EQ(scan.coarse().labels, scan.directly().labels);
}

TEST(NoisyCoarse, DetailRaisesTheSizes) {
    const Scan scan("shaft", 40000, 0.001);
    Options options;
    options.detail = 2;
    const runtime::RunControl control(nullptr);
    const flow::FlowInput input{scan.mesh, nullptr, options, control};
    const flow::NoiseEstimate noise = flow::estimate_noise(scan.mesh, control);
    EXPECT_EQ(flow::run_noisy_coarse(input, noise, small).labels, flow::run_noisy(input, noise).labels);
}

TEST(NoisyCoarse, SameLabelsAtAnyThreadCount) {
    const Scan scan("shaft", 40000, 0.001);
    partition::Labels alone, together;
    runtime::in_arena(1, [&] { alone = scan.coarse().labels; });
    runtime::in_arena(3, [&] { together = scan.coarse().labels; });
    EXPECT_EQ(alone, together);
}

TEST(NoisyCoarse, StoppedRunHasALabelForEveryFace) {
    const Scan scan("shaft", 40000, 0.001);
    Context context;
    context.cancel();
    const FlowResult result = scan.coarse(&context);
    EXPECT_TRUE(result.partial);
    EXPECT_EQ(result.stop, StopReason::cancelled);
    ASSERT_EQ(result.labels.size(), scan.mesh.face_count());
    EXPECT_GE(*std::min_element(result.labels.begin(), result.labels.end()), 0);
}

}  // namespace
}  // namespace quadseg
