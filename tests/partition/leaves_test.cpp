#include "partition/leaves.h"

#include "datasets/generate.h"
#include "mesh/features.h"
#include "runtime/parallel.h"
#include "tests/partition/box.h"

#include <gtest/gtest.h>

namespace quadseg {
namespace {

using partition::grow_leaves;
using partition::LeafOptions;
using partition::Leaves;
using partition::Passage;

const runtime::RunControl free_run(nullptr);

TEST(Leaves, CoplanarGroupsAreOneLeafWhateverTheirSize) {
    const mesh::WorkMesh mesh = test::work_mesh(test::box(20));
    const Passage passage{&mesh};
    const Leaves leaves = grow_leaves(passage, {}, free_run);
    EXPECT_EQ(leaves.count, 6U);
    test::expect_partition(passage, leaves.labels, leaves.count);
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        for (std::size_t g = 0; g < mesh.face_count(); g += 97) {
            EXPECT_EQ(leaves.labels[f] == leaves.labels[g], squared_norm(mesh.normals[f] - mesh.normals[g]) < 1e-9);
        }
    }
}

TEST(Leaves, CurvedLeavesKeepTheAngleAndTheSize) {
    const mesh::WorkMesh mesh = test::work_mesh(test::capped_cylinder(180, 30));
    const Passage passage{&mesh};
    LeafOptions options;
    options.largest = 50;
    options.smallest_coplanar = 0;
    const Leaves leaves = grow_leaves(passage, options, free_run);
    test::expect_partition(passage, leaves.labels, leaves.count);
    const partition::RegionFaces faces = partition::region_faces(leaves.labels, leaves.count);
    for (std::size_t r = 0; r < leaves.count; ++r) {
        const Vec3 first = mesh.normals[faces.face[faces.begin[r]]];
        if (std::abs(first.z) > 0.5) continue;
        EXPECT_LE(faces.size(r), 50U);
        for (std::size_t i = faces.begin[r]; i < faces.begin[r + 1]; ++i) {
            EXPECT_LT(angle_between(first, mesh.normals[faces.face[i]]), 0.3);
            EXPECT_LT(std::abs(mesh.normals[faces.face[i]].z), 0.5);
        }
    }
}

TEST(Leaves, BarriersAndInactiveFacesAreNeverCrossed) {
    const mesh::WorkMesh mesh = test::work_mesh(test::grid(12, 12));
    mesh::FeatureEdges barriers(mesh.face_count(), 0);
    std::vector<std::uint8_t> active(mesh.face_count(), 1);
    const auto left = [&](std::size_t f) { return mesh.centroid(f).x < 0; };
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        if (mesh.centroid(f).y > 0.4) active[f] = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::int32_t g = mesh.neighbors[f][k];
            if (g >= 0 && left(f) != left(static_cast<std::size_t>(g))) {
                barriers[f] = static_cast<std::uint8_t>(barriers[f] | 1U << k);
            }
        }
    }
    const Passage passage{&mesh, &barriers, active};
    const Leaves leaves = grow_leaves(passage, {}, free_run);
    EXPECT_EQ(leaves.count, 2U);
    test::expect_partition(passage, leaves.labels, leaves.count);
}

TEST(Leaves, FacesWithoutAreaFindALeaf) {
    test::Shape s = test::grid(6, 6);
    // A sliver of area 0 between two squares: its corners lie on one line.
    const std::uint32_t a = s.vertex(7, 0, 0), b = s.vertex(8, 0, 0), c = s.vertex(9, 0, 0);
    s.face(a, b, c);
    s.face(6, a, c);
    const mesh::WorkMesh mesh = test::work_mesh(s);
    const Passage passage{&mesh};
    const Leaves leaves = grow_leaves(passage, {}, free_run);
    test::expect_partition(passage, leaves.labels, leaves.count);
}

TEST(Leaves, TheSameAtAnyThreadCount) {
    const datasets::Generated plate = datasets::generate("plate", 60000);
    const mesh::WorkMesh mesh = mesh::build_work_mesh(plate.mesh.view(), free_run);
    const Passage passage{&mesh};
    Leaves one, four;
    runtime::in_arena(1, [&] { one = grow_leaves(passage, {}, free_run); });
    runtime::in_arena(4, [&] { four = grow_leaves(passage, {}, free_run); });
    EXPECT_EQ(one.labels, four.labels);
    test::expect_partition(passage, one.labels, one.count);
    // Nearly pure: on a clean mesh a leaf lies on one true surface, but for tangent neighbours.
    std::vector<std::int32_t> truth(one.count, -1);
    double impure = 0;
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        std::int32_t& t = truth[static_cast<std::size_t>(one.labels[f])];
        const std::int32_t own = plate.truth[mesh.input_face[f]];
        if (t < 0) t = own;
        if (t != own) impure += mesh.areas[f];
    }
    EXPECT_LT(impure, 0.04 * mesh.total_area);
}

/// Turned by a quarter, the mesh has other numbers and the same leaves.
TEST(Leaves, WithAnOrderTheyDoNotDependOnNumbers) {
    const datasets::Generated flange = datasets::generate("flange", 20000, 0.001);
    Mesh turned = flange.mesh;
    for (std::size_t i = 0; i < turned.positions.size(); i += 3) {
        const double x = turned.positions[i];
        turned.positions[i] = -turned.positions[i + 1];
        turned.positions[i + 1] = x;
    }
    const auto leaves_of = [](const Mesh& mesh) {
        const mesh::WorkMesh work = mesh::build_work_mesh(mesh.view(), free_run);
        std::vector<double> order(work.face_count());
        for (std::size_t f = 0; f < order.size(); ++f) order[f] = work.input_face[f] * 7919U % 1000003U;
        LeafOptions options;
        options.smallest_coplanar = 0;
        options.order = order;
        const Passage passage{&work};
        const Leaves leaves = grow_leaves(passage, options, free_run);
        test::expect_partition(passage, leaves.labels, leaves.count);
        std::vector<std::int32_t> labels(work.face_count());
        for (std::size_t f = 0; f < labels.size(); ++f) labels[work.input_face[f]] = leaves.labels[f];
        return std::pair(labels, work.input_face);
    };
    const auto [labels, numbers] = leaves_of(flange.mesh);
    const auto [labels_turned, numbers_turned] = leaves_of(turned);
    EXPECT_NE(numbers, numbers_turned);
    EXPECT_EQ(labels, labels_turned);
}

TEST(ConnectedParts, SplitsComponentsByFirstFace) {
    const mesh::WorkMesh mesh = test::work_mesh(test::joined(test::box(3), test::box(3, 5)));
    const Passage passage{&mesh};
    partition::Labels labels(mesh.face_count(), 0);
    EXPECT_EQ(partition::connected_parts(passage, labels), 2U);
    EXPECT_EQ(labels, mesh.components);
}

}  // namespace
}  // namespace quadseg
