#include "partition/smooth.h"

#include "partition/border_measure.h"
#include "runtime/parallel.h"
#include "tests/partition/box.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace quadseg {
namespace {

using partition::Labels;
using partition::Passage;
using partition::SmoothRules;

const runtime::RunControl free_run(nullptr);

/// A small generator of its own: the same everywhere.
struct Dice {
    std::uint64_t state;
    std::uint64_t next() {
        state += 0x9E3779B97F4A7C15ULL;
        std::uint64_t z = state;
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
        return z ^ (z >> 31);
    }
    std::uint64_t below(std::uint64_t n) { return next() % n; }
};

double nowhere(std::uint32_t, std::int32_t) {
    return 0;
}

partition::CutGraph random_graph(Dice& dice, std::uint32_t nodes) {
    std::vector<std::vector<partition::Capacity>> c(nodes, std::vector<partition::Capacity>(nodes, 0));
    for (std::uint32_t i = 0; i < nodes; ++i) {
        for (std::uint32_t j = 0; j < i; ++j) {
            if (dice.below(3) == 0) c[i][j] = c[j][i] = static_cast<partition::Capacity>(1 + dice.below(20));
        }
    }
    partition::CutGraph g;
    g.begin.push_back(0);
    for (std::uint32_t i = 0; i < nodes; ++i) {
        for (std::uint32_t j = 0; j < nodes; ++j) {
            if (c[i][j] == 0) continue;
            g.head.push_back(j);
            g.capacity.push_back(c[i][j]);
        }
        g.begin.push_back(static_cast<std::uint32_t>(g.head.size()));
        g.side0.push_back(static_cast<partition::Capacity>(dice.below(25)));
        g.side1.push_back(static_cast<partition::Capacity>(dice.below(25)));
    }
    return g;
}

TEST(MinimumCut, IsTheSmallestOfAllCuts) {
    Dice dice{7};
    for (int round = 0; round < 200; ++round) {
        const auto nodes = static_cast<std::uint32_t>(1 + dice.below(9));
        const partition::CutGraph g = random_graph(dice, nodes);
        partition::Capacity best = partition::cut_value(g, std::vector<std::uint8_t>(nodes, 0));
        for (std::uint32_t mask = 1; mask < 1U << nodes; ++mask) {
            std::vector<std::uint8_t> side(nodes);
            for (std::uint32_t v = 0; v < nodes; ++v) side[v] = static_cast<std::uint8_t>(mask >> v & 1U);
            best = std::min(best, partition::cut_value(g, side));
        }
        EXPECT_EQ(partition::cut_value(g, partition::minimum_cut(g)), best);
    }
}

TEST(MinimumCut, OfNothingIsNothing) {
    partition::CutGraph g;
    g.begin.push_back(0);
    EXPECT_TRUE(partition::minimum_cut(g).empty());
}

/// Two halves of a flat grid, the border between them ragged by up to `ragged` columns.
struct RaggedGrid {
    mesh::WorkMesh mesh;
    Labels labels;
};

RaggedGrid ragged_grid(std::uint32_t n, std::uint32_t ragged, std::uint64_t seed = 3) {
    RaggedGrid g{test::work_mesh(test::grid(n, n)), {}};
    Dice dice{seed};
    std::vector<double> border(n);
    for (double& b : border) b = static_cast<double>(n) / 2 + static_cast<double>(dice.below(ragged + 1));
    g.labels.resize(g.mesh.face_count());
    for (std::size_t f = 0; f < g.labels.size(); ++f) {
        const Vec3 c = g.mesh.frame.to_input(g.mesh.centroid(f));
        g.labels[f] = c.x < border[static_cast<std::size_t>(c.y)] ? 0 : 1;
    }
    g.labels = [&] {
        Labels parts = g.labels;  // a ragged border may leave islands
        EXPECT_EQ(partition::connected_parts({&g.mesh}, parts), 2U);
        return g.labels;
    }();
    return g;
}

TEST(Smooth, MakesRaggedBordersShorterAndStraighter) {
    const RaggedGrid g = ragged_grid(40, 2);
    Labels labels = g.labels;
    const std::size_t changed = partition::smooth_borders({&g.mesh}, labels, 2, nowhere, {3, 1}, free_run);
    EXPECT_GT(changed, 10U);
    const BorderMeasure before = partition::measure_borders(g.mesh, g.labels);
    const BorderMeasure after = partition::measure_borders(g.mesh, labels);
    EXPECT_LT(after.length, 0.8 * before.length);
    EXPECT_LT(after.zigzag, 0.5 * before.zigzag);
    test::expect_partition({&g.mesh}, labels, 2);
}

TEST(Smooth, OnlyFacesOfTheBandChange) {
    const RaggedGrid g = ragged_grid(30, 2);
    for (const int width : {1, 2, 4}) {
        Labels labels = g.labels;
        (void)partition::smooth_borders({&g.mesh}, labels, 2, nowhere, {width, 1}, free_run);
        const partition::BorderBands bands = partition::find_border_bands({&g.mesh}, g.labels, width, free_run);
        ASSERT_EQ(bands.pairs.size(), 1U);
        for (std::uint32_t f = 0; f < labels.size(); ++f) {
            if (labels[f] != g.labels[f]) {
                EXPECT_TRUE(std::binary_search(bands.face.begin(), bands.face.end(), f));
            }
        }
    }
}

TEST(Smooth, BandsHoldTheFacesSoFarFromTheBorder) {
    const mesh::WorkMesh mesh = test::work_mesh(test::grid(20, 4));
    Labels labels(mesh.face_count());
    for (std::size_t f = 0; f < labels.size(); ++f) labels[f] = mesh.frame.to_input(mesh.centroid(f)).x < 10 ? 0 : 1;
    for (const int width : {1, 2, 3, 4}) {
        const partition::BorderBands bands = partition::find_border_bands({&mesh}, labels, width, free_run);
        ASSERT_EQ(bands.pairs.size(), 1U);
        // A column of squares has a triangle on either of its sides: two faces a column and row.
        const std::size_t columns = static_cast<std::size_t>(width);
        EXPECT_GE(bands.face.size(), 4 * columns);
        EXPECT_LE(bands.face.size(), 8 * 2 * columns);
        EXPECT_EQ(width == 1 ? bands.face.size() : 8U, 8U);
    }
}

/// The paper's E(X) over one pair's band.
double paper_energy(const mesh::WorkMesh& mesh, const Labels& labels, const partition::BorderBands& bands,
                    const partition::FaceDistance& distance, double lambda) {
    const double mean_area = mesh.total_area / static_cast<double>(mesh.face_count());
    const double mean_edge = partition::mean_edge_length(mesh);
    double energy = 0;
    for (const std::uint32_t f : bands.face) {
        const double d0 = distance(f, 0), d1 = distance(f, 1);
        const double e0 = d0 + d1 > 0 ? d0 / (d0 + d1) : 0.5;
        energy += mesh.areas[f] / mean_area * (labels[f] == 0 ? e0 : 1 - e0);
    }
    for (std::size_t f = 0; f < labels.size(); ++f) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::int32_t g = mesh.neighbors[f][k];
            if (g < 0 || static_cast<std::size_t>(g) < f || labels[static_cast<std::size_t>(g)] == labels[f]) continue;
            const double length =
                norm(mesh.corner(f, static_cast<int>(k)) - mesh.corner(f, static_cast<int>((k + 1) % 3)));
            energy += lambda * length / (length + mean_edge);
        }
    }
    return energy;
}

TEST(Smooth, MinimisesThePapersEnergy) {
    const RaggedGrid g = ragged_grid(16, 2, 5);
    Dice dice{11};
    std::vector<double> d(2 * g.labels.size());
    for (double& x : d) x = 0.01 + static_cast<double>(dice.below(1000)) / 1000;
    const partition::FaceDistance distance = [&](std::uint32_t f, std::int32_t r) {
        return d[2 * f + static_cast<std::size_t>(r)];
    };
    for (const double lambda : {0.2, 1.0, 5.0}) {
        Labels labels = g.labels;
        (void)partition::smooth_borders({&g.mesh}, labels, 2, distance, {2, lambda}, free_run);
        const partition::BorderBands bands = partition::find_border_bands({&g.mesh}, g.labels, 2, free_run);
        const double reached = paper_energy(g.mesh, labels, bands, distance, lambda);
        EXPECT_LE(reached, paper_energy(g.mesh, g.labels, bands, distance, lambda));
        if (lambda < 1) continue;  // islands are the minimum there, and they are not left
        // No change of one or two neighbouring faces of the band is better, unless it makes an island.
        for (const std::uint32_t f : bands.face) {
            Labels other = labels;
            other[f] = 1 - other[f];
            Labels parts = other;
            if (partition::connected_parts({&g.mesh}, parts) > 2) continue;
            EXPECT_GE(paper_energy(g.mesh, other, bands, distance, lambda), reached - 1e-4);
        }
    }
}

/// True labels of a box: 0 … 5 by side; and distances to the planes of its sides.
struct LabelledBox {
    mesh::WorkMesh mesh;
    Labels labels;
    partition::FaceDistance distance;
};

LabelledBox labelled_box(std::uint32_t n) {
    LabelledBox box{test::work_mesh(test::box(n)), {}, {}};
    const auto side = [](const Vec3& normal) {
        for (int axis = 0; axis < 3; ++axis) {
            if (std::abs(normal[axis]) > 0.5) return 2 * axis + (normal[axis] > 0 ? 1 : 0);
        }
        return -1;
    };
    for (const Vec3& n_f : box.mesh.normals) box.labels.push_back(side(n_f));
    return box;
}

partition::FaceDistance side_distance(const mesh::WorkMesh& mesh) {
    return [&mesh](std::uint32_t f, std::int32_t r) {
        return std::abs(mesh.centroid(f)[r / 2] - (r % 2 == 0 ? -0.5 : 0.5));
    };
}

TEST(Smooth, BordersOnTrueEdgesStay) {
    const LabelledBox box = labelled_box(8);
    Labels labels = box.labels;
    EXPECT_EQ(partition::smooth_borders({&box.mesh}, labels, 6, side_distance(box.mesh), {}, free_run), 0U);
    EXPECT_EQ(labels, box.labels);
}

TEST(Smooth, WrongFacesAlongAnEdgeComeBack) {
    const LabelledBox box = labelled_box(10);
    Labels labels = box.labels;
    Dice dice{5};
    std::size_t wrong = 0;
    std::vector<std::uint8_t> stays(labels.size(), 0);  // a wrong face hangs on a right one
    for (std::size_t f = 0; f < labels.size(); ++f) {
        const Vec3 c = box.mesh.centroid(f);
        if (std::min({std::abs(c.x), std::abs(c.y), std::abs(c.z)}) > 0.3) continue;  // corners could be cut off
        for (const std::int32_t g : box.mesh.neighbors[f]) {
            const auto across = static_cast<std::size_t>(g);
            const std::int32_t beyond = box.labels[across];
            if (beyond == box.labels[f] || stays[f] != 0 || labels[across] != beyond || dice.below(3) != 0) continue;
            labels[f] = beyond;
            stays[across] = 1;
            ++wrong;
            break;
        }
    }
    ASSERT_GT(wrong, 20U);
    Labels parts = labels;
    ASSERT_EQ(partition::connected_parts({&box.mesh}, parts), 6U);
    EXPECT_GT(partition::smooth_borders({&box.mesh}, labels, 6, side_distance(box.mesh), {}, free_run), 0U);
    std::size_t still = 0;
    for (std::size_t f = 0; f < labels.size(); ++f) still += labels[f] != box.labels[f] ? 1U : 0U;
    EXPECT_LT(still * 5, wrong);
    test::expect_partition({&box.mesh}, labels, 6);
}

TEST(Smooth, NothingCrossesABarrier) {
    const LabelledBox box = labelled_box(6);
    const mesh::FeatureEdges features = mesh::find_feature_edges(box.mesh, 30, free_run);
    Labels labels = box.labels;
    EXPECT_EQ(partition::smooth_borders({&box.mesh, &features}, labels, 6, nowhere, {3, 5}, free_run), 0U);
}

TEST(Smooth, RegionsStayConnectedAndNoneIsLost) {
    const mesh::WorkMesh mesh = test::work_mesh(test::grid(24, 24));
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        // Random connected regions of very different sizes: single faces, strips, islands in others.
        Dice dice{seed};
        Labels labels(mesh.face_count(), -1);
        const std::size_t wanted = 2 + dice.below(120);
        std::vector<std::uint32_t> front;
        for (std::size_t r = 0; r < wanted; ++r) {
            const auto f = static_cast<std::uint32_t>(dice.below(mesh.face_count()));
            if (labels[f] >= 0) continue;
            labels[f] = static_cast<std::int32_t>(r);
            front.push_back(f);
        }
        while (!front.empty()) {
            const std::size_t i = dice.below(front.size());
            const std::uint32_t f = front[i];
            bool grown = false;
            for (const std::int32_t g : mesh.neighbors[f]) {
                if (g < 0 || labels[static_cast<std::size_t>(g)] >= 0 || dice.below(2) == 0) continue;
                labels[static_cast<std::size_t>(g)] = labels[f];
                front.push_back(static_cast<std::uint32_t>(g));
                grown = true;
            }
            if (grown) continue;
            const bool open = std::any_of(mesh.neighbors[f].begin(), mesh.neighbors[f].end(), [&](std::int32_t g) {
                return g >= 0 && labels[static_cast<std::size_t>(g)] < 0;
            });
            if (open) continue;
            front[i] = front.back();
            front.pop_back();
        }
        const std::size_t count = partition::compact(labels);
        const partition::FaceDistance noisy = [seed](std::uint32_t f, std::int32_t r) {
            return static_cast<double>(Dice{seed * 1000003 + f * 131 + static_cast<std::uint64_t>(r)}.below(100));
        };
        for (const int width : {1, 2, 5}) {
            Labels smoothed = labels;
            (void)partition::smooth_borders({&mesh}, smoothed, count, noisy, {width, 1}, free_run);
            test::expect_partition({&mesh}, smoothed, count);
        }
    }
}

TEST(Smooth, TheSameAtAnyThreadCount) {
    const LabelledBox box = labelled_box(20);
    Labels ragged = box.labels;
    Dice dice{9};
    for (std::size_t f = 0; f < ragged.size(); ++f) {
        for (const std::int32_t g : box.mesh.neighbors[f]) {
            const std::int32_t beyond = box.labels[static_cast<std::size_t>(g)];
            if (beyond != box.labels[f] && dice.below(2) == 0) ragged[f] = beyond;
        }
    }
    Labels one = ragged, four = ragged;
    runtime::in_arena(
        1, [&] { (void)partition::smooth_borders({&box.mesh}, one, 6, side_distance(box.mesh), {}, free_run); });
    runtime::in_arena(
        4, [&] { (void)partition::smooth_borders({&box.mesh}, four, 6, side_distance(box.mesh), {}, free_run); });
    EXPECT_NE(one, ragged);
    EXPECT_EQ(one, four);
}

TEST(Smooth, StoppedLeavesTheLabelsAlone) {
    const RaggedGrid g = ragged_grid(20, 2);
    Context context;
    context.cancel();
    Labels labels = g.labels;
    EXPECT_THROW((void)partition::smooth_borders({&g.mesh}, labels, 2, nowhere, {}, runtime::RunControl(&context)),
                 runtime::Stopped);
    EXPECT_EQ(labels, g.labels);
}

TEST(BorderMeasure, OfAStraightAndAStaircaseBorder) {
    const mesh::WorkMesh mesh = test::work_mesh(test::grid(10, 10));
    Labels straight(mesh.face_count()), stairs(mesh.face_count());
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        const Vec3 c = mesh.frame.to_input(mesh.centroid(f));
        straight[f] = c.x < 5 ? 0 : 1;
        stairs[f] = std::floor(c.x) + std::floor(c.y) < 10 ? 0 : 1;
    }
    const BorderMeasure a = partition::measure_borders(mesh, straight), b = partition::measure_borders(mesh, stairs);
    EXPECT_NEAR(a.length, 10 / std::sqrt(200.0), 1e-12);
    EXPECT_NEAR(a.zigzag, 0, 1e-9);
    EXPECT_NEAR(b.zigzag, 90, 1e-9);
    EXPECT_EQ(partition::measure_borders(mesh, Labels(mesh.face_count(), 0)).length, 0);
}

}  // namespace
}  // namespace quadseg
