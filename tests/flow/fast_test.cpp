#include "flow/fast.h"

#include "datasets/generate.h"
#include "runtime/parallel.h"
#include "tests/partition/box.h"

#include <gtest/gtest.h>
#include <set>

namespace quadseg {
namespace {

using flow::FastOptions;
using flow::FlowResult;
using partition::Passage;

const runtime::RunControl free_run(nullptr);

FlowResult run(const mesh::WorkMesh& mesh, std::size_t regions, const mesh::FeatureEdges* features = nullptr) {
    Options options;
    options.regions = regions;
    return flow::run_fast({mesh, features, options, free_run}, flow::fast_options(options));
}

TEST(FastFlow, FindsTheNumberOfRegionsByItself) {
    const mesh::WorkMesh box = test::work_mesh(test::box(12));
    EXPECT_EQ(run(box, 0).regions, 6U);
    const mesh::WorkMesh cylinder = test::work_mesh(test::capped_cylinder(60, 12));
    const FlowResult result = run(cylinder, 0);
    EXPECT_EQ(result.regions, 2U);
    EXPECT_EQ(result.stop, StopReason::converged);
    EXPECT_FALSE(result.partial);
    EXPECT_FALSE(result.history.empty());
}

TEST(FastFlow, ReturnsExactlyTheNumberAskedFor) {
    const mesh::WorkMesh mesh = test::work_mesh(test::joined(test::box(5), test::box(4, 3)));
    const Passage passage{&mesh};
    for (const std::size_t k : {2U, 3U, 11U, 12U, 13U, 40U, 150U, 400U, 491U, 492U}) {
        const FlowResult result = run(mesh, k);
        EXPECT_EQ(result.regions, k);
        EXPECT_EQ(result.stop, StopReason::regions);
        test::expect_partition(passage, result.labels, result.regions);
    }
    EXPECT_EQ(run(mesh, 1).regions, 2U) << "components set a floor";
    EXPECT_EQ(run(mesh, 5000).regions, mesh.face_count()) << "a region needs a face";
}

TEST(FastFlow, ReturnsTheNumberAskedForOnSmoothShapesToo) {
    const mesh::WorkMesh mesh = test::work_mesh(test::bumpy_grid(40));
    const Passage passage{&mesh};
    for (const std::size_t k : {1U, 7U, 30U, 333U, 1500U}) {
        const FlowResult result = run(mesh, k);
        EXPECT_EQ(result.regions, k);
        test::expect_partition(passage, result.labels, result.regions);
    }
}

TEST(FastFlow, TheNumberAskedForWeighsMoreThanFeatures) {
    const mesh::WorkMesh mesh = test::work_mesh(test::box(6));
    const mesh::FeatureEdges features = mesh::find_feature_edges(mesh, 30, free_run);
    EXPECT_EQ(run(mesh, 6, &features).regions, 6U);
    EXPECT_EQ(run(mesh, 3, &features).regions, 3U);
}

TEST(FastFlow, OnlyActiveFacesTakePart) {
    const mesh::WorkMesh mesh = test::work_mesh(test::box(8));
    std::vector<std::uint8_t> active(mesh.face_count());
    for (std::size_t f = 0; f < active.size(); ++f) active[f] = mesh.centroid(f).z > 0.1 ? 1 : 0;
    Options options;
    FastOptions fast = flow::fast_options(options);
    fast.active = active;
    const FlowResult result = flow::run_fast({mesh, nullptr, options, free_run}, fast);
    const Passage passage{&mesh, nullptr, active};
    EXPECT_EQ(result.regions, 5U);
    test::expect_partition(passage, result.labels, result.regions);
}

TEST(FastFlow, MoreDetailGivesMoreRegionsAndLessToleranceToo) {
    const mesh::WorkMesh mesh = test::work_mesh(test::bumpy_grid(60));
    std::size_t before = 0;
    for (const double detail : {0.1, 1.0, 10.0}) {
        Options options;
        options.detail = detail;
        const FlowResult result = flow::run_fast({mesh, nullptr, options, free_run}, flow::fast_options(options));
        EXPECT_GT(result.regions, before);
        before = result.regions;
    }
    before = 0;
    for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
        Options options;
        options.tolerance = tolerance;
        const FlowResult result = flow::run_fast({mesh, nullptr, options, free_run}, flow::fast_options(options));
        EXPECT_EQ(result.stop, StopReason::tolerance);
        EXPECT_GT(result.regions, before);
        before = result.regions;
    }
}

TEST(FastFlow, TheSameAtAnyThreadCount) {
    const datasets::Generated plate = datasets::generate("plate", 40000);
    const mesh::WorkMesh mesh = mesh::build_work_mesh(plate.mesh.view(), free_run);
    FlowResult one, four;
    for (const std::size_t k : {0U, 60U}) {
        runtime::in_arena(1, [&] { one = run(mesh, k); });
        runtime::in_arena(4, [&] { four = run(mesh, k); });
        EXPECT_EQ(one.labels, four.labels);
        EXPECT_EQ(one.energies, four.energies);
    }
}

TEST(FastFlow, HandsOnTheFitsOfItsRegions) {
    const datasets::Generated plate = datasets::generate("plate", 20000);
    const mesh::WorkMesh mesh = mesh::build_work_mesh(plate.mesh.view(), free_run);
    const FlowResult result = run(mesh, 50);
    ASSERT_EQ(result.fits.size(), result.regions);
    const partition::RegionFaces faces = partition::region_faces(result.labels, result.regions);
    quadric::RegionFitOptions options;
    options.plane_tolerance_per_area = true;
    const auto expected = partition::fit_regions(mesh, faces, options, free_run);
    double sum = 0;
    for (std::size_t r = 0; r < result.regions; ++r) {
        const double scale = std::max(expected[r].total, 1e-9);
        EXPECT_NEAR(result.fits[r].total, expected[r].total, 1e-6 * scale) << r;
        if (!expected[r].proxy.planar()) {
            EXPECT_EQ(result.fits[r].proxy.c, expected[r].proxy.c) << r;
        }
        sum += result.fits[r].total;
    }
    EXPECT_NEAR(sum, result.energies.back(), 1e-9 * sum);
}

TEST(FastFlow, RecoversMostTrueSurfacesOfAPlate) {
    const datasets::Generated plate = datasets::generate("plate", 40000);
    const mesh::WorkMesh mesh = mesh::build_work_mesh(plate.mesh.view(), free_run);
    const FlowResult result = run(mesh, plate.surfaces.size());
    // Share of the area in the largest true surface of its region.
    std::vector<std::vector<double>> overlap(result.regions, std::vector<double>(plate.surfaces.size(), 0));
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        overlap[static_cast<std::size_t>(result.labels[f])]
               [static_cast<std::size_t>(plate.truth[mesh.input_face[f]])] += mesh.areas[f];
    }
    double pure = 0;
    for (const auto& row : overlap) pure += *std::max_element(row.begin(), row.end());
    EXPECT_GT(pure, 0.97 * mesh.total_area);
}

TEST(FastFlow, StoppedGivesAMarkedPartition) {
    const mesh::WorkMesh mesh = test::work_mesh(test::joined(test::box(8), test::box(8, 3)));
    Context context;
    context.cancel();
    const runtime::RunControl stopped(&context);
    Options options;
    const FlowResult result = flow::run_fast({mesh, nullptr, options, stopped}, flow::fast_options(options));
    EXPECT_TRUE(result.partial);
    EXPECT_EQ(result.stop, StopReason::cancelled);
    test::expect_partition({&mesh}, result.labels, result.regions);
}

TEST(FastFlow, SurvivesFacesWithoutAreaAndSingleTriangles) {
    test::Shape one;
    one.vertex(0, 0, 0);
    one.vertex(1, 0, 0);
    one.vertex(0, 1, 0);
    one.face(0, 1, 2);
    const FlowResult single = run(test::work_mesh(one), 0);
    EXPECT_EQ(single.regions, 1U);
    test::Shape flat = test::grid(4, 4);
    for (std::size_t v = 1; v < flat.positions.size(); v += 3) flat.positions[v] = 0;  // every face has area 0
    flat.positions[1] = 1e-3;                                                          // but one
    const mesh::WorkMesh mesh = test::work_mesh(flat);
    for (const std::size_t k : {0U, 3U}) {
        const FlowResult result = run(mesh, k);
        test::expect_partition({&mesh}, result.labels, result.regions);
    }
}

}  // namespace
}  // namespace quadseg
