#include "flow/rough_planes.h"

#include <quadseg/segmentation.h>

#include "datasets/generate.h"
#include "flow/finish.h"
#include "partition/leaves.h"
#include "tests/mesh/shapes.h"
#include "tests/pipeline/result_checks.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

namespace quadseg {
namespace {

const runtime::RunControl free_run(nullptr);

TEST(RoughPlanes, OfTheSidesOfACubeAreExact) {
    const test::Shape cube = test::cube();
    const mesh::WorkMesh mesh = mesh::build_work_mesh(cube.view(), free_run);
    partition::Leaves sides = partition::grow_leaves({&mesh, nullptr, {}}, {}, free_run);
    ASSERT_EQ(sides.count, 6U);
    const std::vector<flow::RoughPlane> planes = flow::rough_planes(mesh, sides.labels, 7);  // the last one has no face
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        const flow::RoughPlane& plane = planes[static_cast<std::size_t>(sides.labels[f])];
        EXPECT_NEAR(dot(plane.normal, mesh.normals[f]), 1, 1e-12);
        EXPECT_NEAR(dot(plane.normal, mesh.corner(f, 0) - plane.point), 0, 1e-12);
    }
    for (std::size_t r = 0; r < 6; ++r) {
        EXPECT_NEAR(planes[r].area, mesh.total_area / 6, 1e-12);
        EXPECT_NEAR(planes[r].normal_energy, 0, 1e-12);
        EXPECT_NEAR(planes[r].max_distance, 0, 1e-12);
        EXPECT_TRUE(planes[r].agrees);
    }
    EXPECT_EQ(planes[6].area, 0);
    EXPECT_EQ(norm(planes[6].normal), 1);
}

TEST(RoughPlanes, KnowAllNormalsAndLeaveUnlabelledFacesOut) {
    const test::Shape bump = test::bumpy_grid(12);
    const mesh::WorkMesh mesh = mesh::build_work_mesh(bump.view(), free_run);
    partition::Labels labels(mesh.face_count(), 0);
    labels[3] = labels[40] = -1;
    const flow::RoughPlane plane = flow::rough_planes(mesh, labels, 1)[0];
    double area = 0, energy = 0;
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        if (labels[f] < 0) continue;
        area += mesh.areas[f];
        energy += mesh.areas[f] * squared_norm(mesh.normals[f] - plane.normal);
    }
    EXPECT_NEAR(plane.area, area, 1e-12);
    EXPECT_NEAR(plane.normal_energy, energy, 1e-12);
    EXPECT_GT(energy, 1e-3);
    EXPECT_GT(plane.max_distance, 0);
    EXPECT_LE(plane.squared_distance, plane.area * plane.max_distance * plane.max_distance);
}

/// A flow that was stopped among its leaves once took 0.6 µs for each of them, twice: 70 ms for a million faces.
TEST(RoughPlanes, DescribeAFlowThatWasStoppedAmongItsLeaves) {
    const datasets::Generated part = datasets::generate("flange", 20000, 1e-3);
    const mesh::WorkMesh mesh = mesh::build_work_mesh(part.mesh.view(), free_run);
    partition::Leaves leaves = partition::grow_leaves({&mesh, nullptr, {}}, {}, free_run);
    ASSERT_GT(leaves.count, flow::most_rough_fits);
    Context context;
    context.cancel();
    const runtime::RunControl stopped(&context);
    const Options options;
    flow::FlowResult flow;
    flow.labels = leaves.labels;
    flow.regions = leaves.count;
    flow.partial = true;
    flow.stop = StopReason::cancelled;
    const Segmentation s = flow::finish({mesh, nullptr, options, stopped}, std::move(flow));
    EXPECT_EQ(test::broken_rule(part.mesh.view(), s), "");
    EXPECT_TRUE(s.partial);
    ASSERT_EQ(s.regions.size(), leaves.count);
    double area = 0, farthest = 0;
    for (const Region& region : s.regions) {
        area += region.area;
        EXPECT_EQ(region.surface.type, SurfaceType::plane);
        EXPECT_NEAR(norm(to_vec3(region.surface.axis)), 1, 1e-12);
        // The plane says the same in both of its forms.
        const Quadric& c = region.surface.coefficients;
        const std::array<double, 3>& p = region.surface.point;
        farthest = std::max(farthest, std::abs(c[0] + c[1] * p[0] + c[2] * p[1] + c[3] * p[2]));
    }
    EXPECT_NEAR(area, s.input.area, 1e-9 * s.input.area);
    EXPECT_LE(farthest, 1e-9 * s.input.diagonal);
    EXPECT_LT(s.rms, 0.01);
}

}  // namespace
}  // namespace quadseg
