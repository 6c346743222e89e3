#include "partition/insert.h"

#include "box.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <set>

namespace quadseg::test {
namespace {

TEST(RandomNumbers, AreTheSameEverywhere) {
    partition::RandomNumbers a(1), b(1), c(2);
    bool different = false;
    for (int i = 0; i < 100; ++i) {
        const std::uint32_t x = a.next();
        EXPECT_EQ(x, b.next());
        different |= x != c.next();
    }
    EXPECT_TRUE(different);
}

TEST(RandomNumbers, FillTheirRangeEvenly) {
    partition::RandomNumbers random(7);
    std::array<int, 10> hits{};
    for (int i = 0; i < 10000; ++i) ++hits[random.below(10)];
    for (const int h : hits) EXPECT_NEAR(h, 1000, 150);
}

TEST(RandomSeeds, AreDistinctAndCoverTheComponents) {
    const mesh::WorkMesh mesh = work_mesh(joined(box(3), box(2, 5)));
    const partition::Passage passage{&mesh, nullptr, {}};
    partition::Labels groups(mesh.face_count(), 0);
    const std::size_t count = partition::connected_parts(passage, groups);
    ASSERT_EQ(count, 2U);
    for (const std::size_t wanted : {0UL, 1UL, 2UL, 7UL, 100000UL}) {
        const auto seeds = partition::random_seeds(mesh, groups, count, wanted, 3);
        EXPECT_EQ(seeds.size(), std::min(std::max<std::size_t>(wanted, 2), mesh.face_count()));
        EXPECT_EQ(std::set<std::uint32_t>(seeds.begin(), seeds.end()).size(), seeds.size());
        std::set<std::int32_t> covered;
        for (const std::uint32_t s : seeds) covered.insert(groups[s]);
        EXPECT_EQ(covered.size(), 2U);
    }
    EXPECT_NE(partition::random_seeds(mesh, groups, count, 7, 3), partition::random_seeds(mesh, groups, count, 7, 4));
}

TEST(Faces, BestAndWorstBreakTiesByIndex) {
    const mesh::WorkMesh mesh = work_mesh(grid(3, 1));
    const std::vector<std::uint32_t> faces{0, 1, 2, 3, 4, 5};
    const std::vector<double> density{2, 1, 5, 1, 5, 3};
    EXPECT_EQ(partition::best_face(mesh, faces, density), 1U);
    EXPECT_EQ(partition::best_face(mesh, faces, density, 1U), 3U);
    EXPECT_EQ(partition::worst_face(mesh, faces, density, 0), 2U);
    EXPECT_EQ(partition::worst_face(mesh, faces, density, 2), 4U);
    EXPECT_EQ(partition::worst_face(mesh, std::vector<std::uint32_t>{3}, density, 3), std::nullopt);
}

TEST(Faces, SliversAreNoSeedsOfNewRegions) {
    Shape s = grid(4, 1);
    s.positions[3 * 2] = s.positions[3 * 1] + 1e-4;  // squares 1–2 and 2–3 of the lower row: one face nearly gone
    mesh::WorkMesh mesh = work_mesh(s);
    const auto sliver =
        static_cast<std::uint32_t>(std::min_element(mesh.areas.begin(), mesh.areas.end()) - mesh.areas.begin());
    std::vector<std::uint32_t> faces(mesh.face_count());
    for (std::uint32_t f = 0; f < faces.size(); ++f) faces[f] = f;
    std::vector<double> density(mesh.face_count(), 1);
    density[sliver] = 100;
    EXPECT_NE(partition::worst_face(mesh, faces, density, (sliver + 1) % 8), sliver);
}

TEST(Faces, SmoothingFindsThePatchAndNotTheSpike) {
    const mesh::WorkMesh mesh = work_mesh(grid(20, 20));
    const partition::Passage passage{&mesh, nullptr, {}};
    const partition::Labels labels(mesh.face_count(), 0);
    std::vector<std::uint32_t> faces(mesh.face_count());
    std::vector<double> density(mesh.face_count(), 0);
    const Vec3 middle = mesh.frame.to_unit({5, 5, 0});
    std::uint32_t spike = 0;
    for (std::uint32_t f = 0; f < faces.size(); ++f) {
        faces[f] = f;
        if (norm(mesh.centroid(f) - middle) < 0.15) density[f] = 1;
        if (norm(mesh.centroid(f) - mesh.frame.to_unit({16, 16, 0})) <
            norm(mesh.centroid(spike) - mesh.frame.to_unit({16, 16, 0}))) {
            spike = f;
        }
    }
    density[spike] = 3;
    EXPECT_EQ(partition::worst_face(mesh, faces, density, faces.back()), spike);
    const auto smooth = partition::smoothed_density(passage, faces, labels, density, 8);
    const auto found = partition::worst_face(mesh, faces, smooth, faces.back());
    ASSERT_TRUE(found);
    EXPECT_LT(norm(mesh.centroid(*found) - middle), 0.1);
}

TEST(FarthestRegions, InvalidFirstThenByDensityOverArea) {
    const std::vector<partition::InsertionCandidate> regions{{4, 1, true, 10},  {1, 0.1, true, 10}, {0.1, 1, false, 10},
                                                             {100, 1, true, 1}, {4, 1, true, 10},   {9, 0, true, 3}};
    EXPECT_EQ(partition::farthest_regions(regions), (std::vector<std::uint32_t>{2, 1, 0, 4, 5}));
}

}  // namespace
}  // namespace quadseg::test
