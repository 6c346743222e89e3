#include "flow/coarse.h"

#include "datasets/generate.h"
#include "flow/dispatch.h"
#include "flow/paper.h"
#include "flow/paper_loop.h"
#include "flow/project_labels.h"
#include "runtime/parallel.h"
#include "tests/flow/loop_support.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <optional>
#include <set>

namespace quadseg::test {
namespace {

using flow::FlowInput;
using flow::FlowResult;
using partition::Labels;

/// What a flow owes, made by hand: the six sides of a box told apart by their normals.
FlowResult by_normal(const FlowInput& input) {
    FlowResult result;
    for (const Vec3& n : input.mesh.normals) {
        const int axis = std::abs(n.x) > 0.7 ? 0 : std::abs(n.y) > 0.7 ? 1 : 2;
        result.labels.push_back(2 * axis + (n[axis] > 0 ? 1 : 0));
    }
    result.regions = partition::compact(result.labels);
    return result;
}

FlowResult as_projected(const FlowInput&, const Labels& labels) {
    FlowResult result;
    result.labels = labels;
    result.regions = partition::compact(result.labels);
    return result;
}

simplify::Decimated to_200_faces(const FlowInput& fine) {
    return flow::simplified(fine, fine.mesh.positions, 200, 30);
}

TEST(Coarse, SidesOfABoxComeBackExactly) {
    const mesh::WorkMesh mesh = work_mesh(box(24));
    const Options options;
    const runtime::RunControl control(nullptr);
    const FlowInput input{mesh, nullptr, options, control};
    std::size_t coarse_faces = 0;
    const FlowResult result = flow::run_coarse(
        input, to_200_faces,
        [&](const FlowInput& coarse) {
            coarse_faces = coarse.mesh.face_count();
            EXPECT_NEAR(coarse.mesh.total_area, mesh.total_area, 1e-6);
            EXPECT_EQ(coarse.mesh.frame.scale, mesh.frame.scale);
            return by_normal(coarse);
        },
        as_projected);
    EXPECT_LE(coarse_faces, 200U);
    Labels expected = by_normal(input).labels;
    EXPECT_EQ(result.regions, 6U);
    EXPECT_EQ(result.labels, expected);
}

TEST(Coarse, FeaturesComeAlongToTheSimplifiedMesh) {
    const mesh::WorkMesh mesh = work_mesh(box(24));
    Options options;
    options.feature_angle = 30;
    const runtime::RunControl control(nullptr);
    const mesh::FeatureEdges features = mesh::find_feature_edges(mesh, 30, control);
    std::size_t groups = 0;
    flow::run_coarse(
        {mesh, &features, options, control}, to_200_faces,
        [&](const FlowInput& coarse) {
            EXPECT_NE(coarse.features, nullptr);
            if (coarse.features != nullptr) mesh::feature_groups(coarse.mesh, *coarse.features, groups);
            return by_normal(coarse);
        },
        as_projected);
    EXPECT_EQ(groups, 6U);
}

TEST(Coarse, MeshThatCannotBeSimplifiedIsSegmentedAsItIs) {
    const mesh::WorkMesh mesh = work_mesh(box(1));
    const Options options;
    const runtime::RunControl control(nullptr);
    bool refined = false;
    const FlowResult result = flow::run_coarse(
        {mesh, nullptr, options, control},
        [](const FlowInput& fine) { return flow::simplified(fine, fine.mesh.positions, 11, 30); },
        [&](const FlowInput& given) {
            EXPECT_EQ(given.mesh.face_count(), mesh.face_count());
            return by_normal(given);
        },
        [&](const FlowInput& given, const Labels& labels) {
            refined = true;
            return as_projected(given, labels);
        });
    EXPECT_FALSE(refined);
    EXPECT_EQ(result.labels.size(), mesh.face_count());
}

TEST(Coarse, CancelledRunReturnsALabelForEveryFace) {
    const mesh::WorkMesh mesh = work_mesh(box(24));
    Options options = paper_options(6);
    Context context;
    context.cancel();
    const runtime::RunControl control(&context);
    const FlowResult result = flow::run_paper_coarse({mesh, nullptr, options, control}, 200);
    EXPECT_TRUE(result.partial);
    ASSERT_EQ(result.labels.size(), mesh.face_count());
    EXPECT_GE(*std::min_element(result.labels.begin(), result.labels.end()), 0);
}

TEST(Coarse, PaperLoopEndsNoHigherThanWithout) {
    const mesh::WorkMesh mesh = work_mesh(dome_on_plate(64, 24));
    const Options options = paper_options(2);
    const runtime::RunControl control(nullptr);
    const FlowInput input{mesh, nullptr, options, control};
    const auto energy = [&](const FlowResult& result) {
        flow::VariationalLoop loop(input);
        loop.start_from_labels(result.labels);
        return loop.state().energy;
    };
    const FlowResult plain = flow::run_paper(input), coarse = flow::run_paper_coarse(input, 1000);
    EXPECT_EQ(coarse.regions, 2U);
    EXPECT_LE(energy(coarse), 1.02 * energy(plain));
}

TEST(Coarse, SameLabelsAtAnyThreadCount) {
    const mesh::WorkMesh mesh = work_mesh(dome_on_plate(64, 24));
    const Options options = paper_options(4);
    const runtime::RunControl control(nullptr);
    const FlowInput input{mesh, nullptr, options, control};
    std::optional<Labels> reference;
    for (const int threads : {1, 2, 8}) {
        FlowResult result;
        runtime::in_arena(threads, [&] { result = flow::run_paper_coarse(input, 1000); });
        if (!reference) reference = result.labels;
        EXPECT_EQ(result.labels, *reference) << threads;
    }
}

/// Every face of the input labelled, as many regions as wanted, each edge-connected.
void expect_partition(const mesh::WorkMesh& mesh, const FlowResult& result, std::size_t regions) {
    EXPECT_EQ(result.regions, regions);
    ASSERT_EQ(result.labels.size(), mesh.face_count());
    EXPECT_GE(*std::min_element(result.labels.begin(), result.labels.end()), 0);
    Labels parts = result.labels;
    EXPECT_EQ(partition::split_disconnected(mesh, parts), regions);
}

TEST(Coarse, DefaultPresetEndsNearThePlainFlow) {
    const datasets::Generated plate = datasets::generate("plate", 30000);
    const runtime::RunControl control(nullptr);
    const mesh::WorkMesh mesh = mesh::build_work_mesh(plate.mesh.view(), control);
    Options options;
    options.regions = plate.surfaces.size();
    const FlowInput plain{mesh, nullptr, options, control};
    Options coarse_options = options;
    coarse_options.coarse = 3000;
    const FlowResult direct = flow::run_flow(plain);
    const FlowResult coarse = flow::run_flow({mesh, nullptr, coarse_options, control});
    expect_partition(mesh, coarse, options.regions);
    EXPECT_GT(coarse.coarse_seconds, 0);
    const auto energy = [&](const FlowResult& result) {
        const partition::RegionFaces faces = partition::region_faces(result.labels, result.regions);
        double sum = 0;
        for (const auto& fit : partition::fit_regions(mesh, faces, {}, control)) sum += fit.total;
        return sum;
    };
    EXPECT_LE(energy(coarse), 1.1 * energy(direct));
}

TEST(Coarse, DefaultPresetWithoutANumberToo) {
    const mesh::WorkMesh mesh = work_mesh(box(24));
    Options options;
    options.coarse = 300;
    const runtime::RunControl control(nullptr);
    expect_partition(mesh, flow::run_flow({mesh, nullptr, options, control}), 6);
}

TEST(Coarse, DefaultPresetIsTheSameAtAnyThreadCount) {
    const mesh::WorkMesh mesh = work_mesh(dome_on_plate(64, 24));
    Options options;
    options.regions = 5;
    const runtime::RunControl control(nullptr);
    std::optional<Labels> reference;
    for (const int threads : {1, 2, 8}) {
        FlowResult result;
        runtime::in_arena(threads, [&] { result = flow::run_fast_coarse({mesh, nullptr, options, control}, 1000); });
        if (!reference) reference = result.labels;
        EXPECT_EQ(result.labels, *reference) << threads;
        expect_partition(mesh, result, 5);
    }
}

TEST(Coarse, DefaultPresetCancelledReturnsALabelForEveryFace) {
    const mesh::WorkMesh mesh = work_mesh(box(24));
    Options options;
    options.regions = 6;
    Context context;
    context.cancel();
    const runtime::RunControl control(&context);
    const FlowResult result = flow::run_fast_coarse({mesh, nullptr, options, control}, 200);
    EXPECT_TRUE(result.partial);
    ASSERT_EQ(result.labels.size(), mesh.face_count());
    EXPECT_GE(*std::min_element(result.labels.begin(), result.labels.end()), 0);
}

TEST(Coarse, AutomaticChoice) {
    Options options = paper_options();
    options.coarse = -1;
    EXPECT_EQ(flow::coarse_face_count(options, 9999), 0U);
    EXPECT_EQ(flow::coarse_face_count(options, 10000), 1000U);
    EXPECT_EQ(flow::coarse_face_count(options, 200000), 20000U);
    options.preset = Preset::standard;
    EXPECT_EQ(flow::coarse_face_count(options, 200000), 0U);
    options.coarse = 500;
    EXPECT_EQ(flow::coarse_face_count(options, 200000), 500U);
    EXPECT_EQ(flow::coarse_face_count(options, 400), 0U);
    options.coarse = 0;
    EXPECT_EQ(flow::coarse_face_count(options, 200000), 0U);
}

TEST(ConnectLabels, OrphansAndGapsJoinTheirNeighbours) {
    const mesh::WorkMesh mesh = work_mesh(box(12));
    const partition::Passage passage{&mesh, nullptr, {}};
    const runtime::RunControl control(nullptr);
    const Options options;
    const Labels sides = by_normal({mesh, nullptr, options, control}).labels;
    Labels labels = sides;
    // Lone faces of a foreign label and of none, inside sides.
    std::size_t changed = 0;
    for (std::size_t f = 0; f < labels.size(); f += 97) {
        const auto inner = [&](std::size_t k) {
            const std::int32_t g = mesh.neighbors[f][k];
            return g >= 0 && labels[static_cast<std::size_t>(g)] == sides[f];
        };
        if (!inner(0) || !inner(1) || !inner(2)) continue;
        labels[f] = changed++ % 2 == 0 ? (sides[f] + 2) % 6 : -1;
    }
    ASSERT_GT(changed, 4U);
    EXPECT_EQ(flow::connect_labels(passage, labels, 0.25, control), 6U);
    EXPECT_EQ(labels, sides);
    // A label of two equal parts becomes two regions; no label at all becomes one.
    Labels halves;
    for (const Vec3& n : mesh.normals) halves.push_back(std::abs(n.x) > 0.7 ? 0 : std::abs(n.y) > 0.7 ? 1 : 2);
    EXPECT_EQ(flow::connect_labels(passage, halves, 0.25, control), 6U);
    Labels none(mesh.face_count(), -1);
    EXPECT_EQ(flow::connect_labels(passage, none, 0.25, control), 1U);
}

/// The parts that grow into what was dropped stay connected, so that their numbers are all that is left to do.
TEST(ConnectLabels, NumbersConnectedPartsByFirstFace) {
    const mesh::WorkMesh mesh = work_mesh(bumpy_grid(40));
    const partition::Passage passage{&mesh, nullptr, {}};
    const runtime::RunControl control(nullptr);
    for (const std::size_t step : {7U, 61U, 400U}) {
        Labels labels;
        for (std::size_t f = 0; f < mesh.face_count(); ++f)
            labels.push_back(f % step == 0 ? 9 : static_cast<std::int32_t>(f / step * 37 % 5) - 1);
        const std::size_t count = flow::connect_labels(passage, labels, 0.25, control);
        Labels parts = labels;
        EXPECT_EQ(partition::connected_parts(passage, parts), count);
        EXPECT_EQ(parts, labels);
    }
}

}  // namespace
}  // namespace quadseg::test
