#include "partition/relax.h"

#include "datasets/generate.h"
#include "partition/absorb.h"
#include "quadric/ladder.h"
#include "runtime/parallel.h"
#include "tests/partition/box.h"

#include <gtest/gtest.h>

namespace quadseg {
namespace {

using partition::Labels;
using partition::Passage;
using partition::Relaxed;
using partition::RelaxOptions;

const runtime::RunControl free_run(nullptr);

std::vector<partition::MergeRegion> measure(const mesh::WorkMesh& mesh, const Labels& labels, std::size_t count) {
    return partition::measure_regions(
        mesh, labels, count, [](const quadric::Moments&) { return partition::RegionScore{}; }, free_run);
}

double energy_of(const mesh::WorkMesh& mesh, const Labels& labels, std::size_t count) {
    double sum = 0;
    for (const auto& fit : partition::fit_regions(mesh, partition::region_faces(labels, count), {}, free_run)) {
        sum += fit.total;
    }
    return sum;
}

/// Sides of the box, the border between them moved by rows of faces.
Labels ragged_sides(const mesh::WorkMesh& mesh) {
    Labels labels(mesh.face_count());
    for (std::size_t f = 0; f < labels.size(); ++f) {
        const Vec3 c = mesh.centroid(f), n = mesh.normals[f];
        labels[f] = std::abs(n.x) > 0.5   ? (n.x > 0 ? 0 : 1)
                    : std::abs(n.y) > 0.5 ? (n.y > 0 ? 2 : 3)
                                          : (n.z > 0 ? 4 : 5);
        if (labels[f] == 4 && c.x > 0.3 + 0.1 * std::sin(20 * c.y)) labels[f] = 0;
    }
    return labels;
}

/// Energy of the labels under the surfaces that came with them.
double energy_under(const mesh::WorkMesh& mesh, const Labels& labels, const std::vector<quadric::RegionFit>& fits) {
    double sum = 0;
    for (std::size_t f = 0; f < labels.size(); ++f) {
        sum += quadric::triangle_energy(fits[static_cast<std::size_t>(labels[f])].proxy, mesh.corner(f, 0),
                                        mesh.corner(f, 1), mesh.corner(f, 2), mesh.normals[f], mesh.areas[f])
                   .hybrid(0.5);
    }
    return sum;
}

TEST(Relax, SettledRegionsKeepTheirSurfacesAndTheEnergyTheirFacesHave) {
    const Mesh part = datasets::generate("quadrics", 6000).mesh;
    const mesh::WorkMesh mesh = mesh::build_work_mesh(part.view(), free_run);
    const Passage passage{&mesh};
    const partition::Leaves leaves = partition::grow_leaves(passage, {}, free_run);
    std::vector<double> energies;
    for (const double settled : {0.0, 0.03, 1.0}) {
        Labels labels = leaves.labels;
        RelaxOptions options;
        options.moment_steps = 1;
        options.settled = settled;
        const Relaxed relaxed =
            partition::relax(passage, labels, measure(mesh, labels, leaves.count), options, free_run);
        test::expect_partition(passage, labels, leaves.count);
        EXPECT_NEAR(relaxed.energy, energy_under(mesh, labels, relaxed.fits), 1e-6 * relaxed.energy) << settled;
        energies.push_back(relaxed.energy);
    }
    EXPECT_LT(energies[1], 1.02 * energies[0]);
}

TEST(Relax, BringsBordersBackToTheCreases) {
    const mesh::WorkMesh mesh = test::work_mesh(test::box(24));
    const Passage passage{&mesh};
    for (const int moment_steps : {0, 3}) {
        Labels labels = ragged_sides(mesh);
        RelaxOptions options;
        options.moment_steps = moment_steps;
        const Relaxed relaxed = partition::relax(passage, labels, measure(mesh, labels, 6), options, free_run);
        EXPECT_LT(relaxed.energy, 1e-12);
        test::expect_partition(passage, labels, 6);
        for (std::size_t f = 0; f < labels.size(); ++f) {
            EXPECT_EQ(labels[f] == 4, mesh.normals[f].z > 0.5);
        }
    }
}

TEST(Relax, NeverEndsHigherAndReportsWhatItReached) {
    const mesh::WorkMesh mesh = test::work_mesh(test::bumpy_grid(50));
    const Passage passage{&mesh};
    partition::Leaves leaves = partition::grow_leaves(passage, {.angle = 20, .largest = 400}, free_run);
    const double before = energy_of(mesh, leaves.labels, leaves.count);
    RelaxOptions options;
    options.moment_steps = 0;
    const Relaxed relaxed =
        partition::relax(passage, leaves.labels, measure(mesh, leaves.labels, leaves.count), options, free_run);
    const double after = energy_of(mesh, leaves.labels, leaves.count);
    EXPECT_LT(after, before);
    EXPECT_NEAR(relaxed.energy, after, 1e-9 * after);
    partition::compact(leaves.labels);
    Labels parts = leaves.labels;
    EXPECT_EQ(partition::connected_parts(passage, parts), partition::compact(leaves.labels));
}

TEST(Relax, LeavesInactiveFacesAndBarriersAlone) {
    const mesh::WorkMesh mesh = test::work_mesh(test::box(12));
    std::vector<std::uint8_t> active(mesh.face_count(), 1);
    Labels labels = ragged_sides(mesh);
    for (std::size_t f = 0; f < labels.size(); ++f) {
        if (labels[f] == 5) active[f] = 0;
    }
    for (std::size_t f = 0; f < labels.size(); ++f) {
        if (active[f] == 0) labels[f] = -1;
    }
    const Passage passage{&mesh, nullptr, active};
    const Relaxed relaxed = partition::relax(passage, labels, measure(mesh, labels, 6), {}, free_run);
    EXPECT_LT(relaxed.energy, 1e-12);
    for (std::size_t f = 0; f < labels.size(); ++f) EXPECT_EQ(labels[f] < 0, active[f] == 0);
}

TEST(Relax, TheSameAtAnyThreadCount) {
    const datasets::Generated plate = datasets::generate("plate", 30000);
    const mesh::WorkMesh mesh = mesh::build_work_mesh(plate.mesh.view(), free_run);
    const Passage passage{&mesh};
    const partition::Leaves leaves = partition::grow_leaves(passage, {.angle = 15}, free_run);
    Labels one = leaves.labels, four = leaves.labels;
    double energy_one = 0, energy_four = 0;
    runtime::in_arena(
        1, [&] { energy_one = partition::relax(passage, one, measure(mesh, one, leaves.count), {}, free_run).energy; });
    runtime::in_arena(4, [&] {
        energy_four = partition::relax(passage, four, measure(mesh, four, leaves.count), {}, free_run).energy;
    });
    EXPECT_EQ(one, four);
    EXPECT_EQ(energy_one, energy_four);
}

TEST(Relax, StoppedKeepsTheLabels) {
    const mesh::WorkMesh mesh = test::work_mesh(test::box(12));
    const Passage passage{&mesh};
    Labels labels = ragged_sides(mesh);
    const Labels before = labels;
    Context context;
    context.cancel();
    const Relaxed relaxed =
        partition::relax(passage, labels, measure(mesh, labels, 6), {}, runtime::RunControl(&context));
    EXPECT_TRUE(relaxed.stopped);
    EXPECT_EQ(labels, before);
}

TEST(Absorb, CrumbsJoinTheSurfaceThatTheyLieOn) {
    const mesh::WorkMesh mesh = test::work_mesh(test::box(10));
    const Passage passage{&mesh};
    Labels labels(mesh.face_count());
    for (std::size_t f = 0; f < labels.size(); ++f) {
        const Vec3 n = mesh.normals[f];
        labels[f] = std::abs(n.x) > 0.5   ? (n.x > 0 ? 0 : 1)
                    : std::abs(n.y) > 0.5 ? (n.y > 0 ? 2 : 3)
                                          : (n.z > 0 ? 4 : 5);
    }
    const Labels truth = labels;
    std::int32_t next = 6;
    for (std::size_t f = 0; f < labels.size(); f += 37) labels[f] = next++;
    const auto fits =
        partition::fit_regions(mesh, partition::region_faces(labels, static_cast<std::size_t>(next)), {}, free_run);
    partition::AbsorbOptions options;
    options.tolerance = 1e-3;
    EXPECT_EQ(partition::absorb_small(passage, labels, static_cast<std::size_t>(next), fits, options, free_run), 6U);
    EXPECT_EQ(labels, truth);
}

TEST(Absorb, RegionsThatNoNeighbourExplainsStay) {
    const mesh::WorkMesh mesh = test::work_mesh(test::cube());
    const Passage passage{&mesh};
    Labels labels(mesh.face_count());
    for (std::size_t f = 0; f < labels.size(); ++f) {
        const Vec3 n = mesh.normals[f];
        labels[f] = std::abs(n.x) > 0.5   ? (n.x > 0 ? 0 : 1)
                    : std::abs(n.y) > 0.5 ? (n.y > 0 ? 2 : 3)
                                          : (n.z > 0 ? 4 : 5);
    }
    const auto fits = partition::fit_regions(mesh, partition::region_faces(labels, 6), {}, free_run);
    partition::AbsorbOptions options;
    options.smallest_region = 10;
    options.tolerance = 0.05;
    EXPECT_EQ(partition::absorb_small(passage, labels, 6, fits, options, free_run), 6U);
}

}  // namespace
}  // namespace quadseg
