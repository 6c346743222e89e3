#include "partition/flood.h"

#include "box.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <limits>
#include <numeric>
#include <set>
#include <tuple>

namespace quadseg::test {
namespace {

const runtime::RunControl never(nullptr);

/// The definition: every pair of a face and a neighbouring proxy is queued, the smallest (priority, face, label) wins.
partition::Labels flood_by_definition(const partition::Passage& passage,
                                      const std::vector<partition::SeededRegion>& regions,
                                      const partition::FaceMetric& metric) {
    const mesh::WorkMesh& mesh = *passage.mesh;
    partition::Labels labels(mesh.face_count(), -1);
    std::set<std::tuple<float, std::size_t, std::int32_t, std::size_t>> queue;
    const auto push_neighbors = [&](std::size_t f, std::size_t i) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::int32_t g = passage.across(f, k);
            if (g < 0 || labels[static_cast<std::size_t>(g)] >= 0) continue;
            const auto u = static_cast<std::size_t>(g);
            const double d = partition::error_density(mesh, u, *regions[i].proxy, metric);
            queue.insert({static_cast<float>(d), u, regions[i].label, i});
        }
    };
    for (const auto& r : regions) labels[r.seed] = r.label;
    for (std::size_t i = 0; i < regions.size(); ++i) push_neighbors(regions[i].seed, i);
    while (!queue.empty()) {
        const auto [priority, face, label, i] = *queue.begin();
        queue.erase(queue.begin());
        if (labels[face] >= 0) continue;
        labels[face] = label;
        push_neighbors(face, i);
    }
    return labels;
}

std::vector<std::uint32_t> all_faces(const mesh::WorkMesh& mesh) {
    std::vector<std::uint32_t> faces(mesh.face_count());
    std::iota(faces.begin(), faces.end(), 0U);
    return faces;
}

struct Seeds {
    std::vector<quadric::Proxy> proxies;
    std::vector<partition::SeededRegion> regions;
};
Seeds plane_seeds(const mesh::WorkMesh& mesh, const std::vector<std::uint32_t>& faces) {
    Seeds seeds;
    for (const std::uint32_t f : faces) {
        seeds.proxies.push_back(quadric::plane_proxy(mesh.centroid(f), mesh.normals[f]));
    }
    for (std::size_t i = 0; i < faces.size(); ++i) {
        seeds.regions.push_back({static_cast<std::int32_t>(i), faces[i], &seeds.proxies[i]});
    }
    return seeds;
}

TEST(Flood, EqualsItsDefinitionOnACurvedMesh) {
    const mesh::WorkMesh mesh = work_mesh(bumpy_grid(30));
    const partition::Passage passage{&mesh, nullptr, {}};
    const Seeds seeds = plane_seeds(mesh, {3, 200, 401, 777, 1203, 1500, 1799});
    partition::Labels labels(mesh.face_count(), -1);
    std::vector<double> density(mesh.face_count(), 0);
    partition::Flood(passage).run(seeds.regions, all_faces(mesh), {}, labels, density, never);
    EXPECT_EQ(labels, flood_by_definition(passage, seeds.regions, {}));
    for (std::size_t f = 0; f < labels.size(); ++f) {
        const auto r = static_cast<std::size_t>(labels[f]);
        EXPECT_EQ(density[f], partition::error_density(mesh, f, seeds.proxies[r], {}));
    }
}

TEST(Flood, GivesEverySideOfABoxToItsPlane) {
    const mesh::WorkMesh mesh = work_mesh(box(6));
    const partition::Passage passage{&mesh, nullptr, {}};
    std::vector<std::uint32_t> side_seed;
    std::vector<Vec3> normals;
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
        const auto same = [&](const Vec3& n) { return dot(n, mesh.normals[f]) > 0.5; };
        if (std::none_of(normals.begin(), normals.end(), same)) {
            normals.push_back(mesh.normals[f]);
            side_seed.push_back(f);
        }
    }
    ASSERT_EQ(side_seed.size(), 6U);
    const Seeds seeds = plane_seeds(mesh, side_seed);
    partition::Labels labels(mesh.face_count(), -1);
    std::vector<double> density(mesh.face_count(), 0);
    partition::Flood(passage).run(seeds.regions, all_faces(mesh), {}, labels, density, never);
    for (std::size_t f = 0; f < labels.size(); ++f) {
        EXPECT_GT(dot(mesh.normals[f], normals[static_cast<std::size_t>(labels[f])]), 0.99);
    }
    expect_partition(passage, labels, 6);
}

TEST(Flood, StaysWithinItsFacesAndKnowsDensitiesByLabel) {
    const mesh::WorkMesh mesh = work_mesh(bumpy_grid(20));
    const partition::Passage passage{&mesh, nullptr, {}};
    const Seeds seeds = plane_seeds(mesh, {5, 300, 600});
    partition::Labels first(mesh.face_count(), -1);
    std::vector<double> density(mesh.face_count(), 0);
    partition::Flood flood(passage);
    flood.run(seeds.regions, all_faces(mesh), {}, first, density, never);

    // Flooding two of the regions again with the same proxies changes nothing, wherever the third lies.
    std::vector<std::uint32_t> faces;
    for (std::uint32_t f = 0; f < first.size(); ++f) {
        if (first[f] != 2) faces.push_back(f);
    }
    partition::Labels second = first;
    const std::vector<partition::SeededRegion> two(seeds.regions.begin(), seeds.regions.begin() + 2);
    flood.run(two, faces, {}, second, density, never);
    for (std::size_t f = 0; f < first.size(); ++f) {
        if (first[f] == 2) {
            EXPECT_EQ(second[f], 2);
        } else {
            EXPECT_NE(second[f], 2);
        }
    }
}

TEST(Flood, DoesNotCrossFeatures) {
    const mesh::WorkMesh mesh = work_mesh(box(4));
    const mesh::FeatureEdges features = mesh::find_feature_edges(mesh, 30, never);
    const partition::Passage passage{&mesh, &features, {}};
    const Seeds seeds = plane_seeds(mesh, {0});
    partition::Labels labels(mesh.face_count(), -1);
    std::vector<double> density(mesh.face_count(), 0);
    partition::Flood(passage).run(seeds.regions, all_faces(mesh), {}, labels, density, never);
    EXPECT_EQ(std::count(labels.begin(), labels.end(), 0), 32);  // one side
}

TEST(Flood, BrokenProxiesTakeFacesLast) {
    const mesh::WorkMesh mesh = work_mesh(grid(8, 8));
    const partition::Passage passage{&mesh, nullptr, {}};
    Seeds seeds = plane_seeds(mesh, {0, 100});
    seeds.proxies[0].c.fill(std::numeric_limits<double>::quiet_NaN());
    partition::Labels labels(mesh.face_count(), -1);
    std::vector<double> density(mesh.face_count(), 0);
    partition::Flood(passage).run(seeds.regions, all_faces(mesh), {}, labels, density, never);
    EXPECT_EQ(std::count(labels.begin(), labels.end(), 0), 1);  // its seed
    expect_partition(passage, labels, 2);
}

TEST(Flood, FacesWithoutAreaAreNeitherWallsNorShortCuts) {
    Shape s = grid(6, 2);  // the middle column of vertices moved onto its neighbour: a strip of faces without area
    for (std::size_t v = 0; v < s.positions.size(); v += 3) {
        if (s.positions[v] == 3) s.positions[v] = 2;
    }
    const mesh::WorkMesh mesh = work_mesh(s);
    const partition::Passage passage{&mesh, nullptr, {}};
    const Seeds seeds = plane_seeds(mesh, {0});
    partition::Labels labels(mesh.face_count(), -1);
    std::vector<double> density(mesh.face_count(), 0);
    partition::Flood(passage).run(seeds.regions, all_faces(mesh), {}, labels, density, never);
    EXPECT_EQ(std::count(labels.begin(), labels.end(), 0), static_cast<std::ptrdiff_t>(mesh.face_count()));
}

TEST(Flood, IsReadyAgainAfterACancellation) {
    const mesh::WorkMesh mesh = work_mesh(bumpy_grid(60));
    const partition::Passage passage{&mesh, nullptr, {}};
    const Seeds seeds = plane_seeds(mesh, {5, 3000, 6000});
    partition::Flood flood(passage);
    partition::Labels labels(mesh.face_count(), -1);
    std::vector<double> density(mesh.face_count(), 0);
    Context cancelled;
    cancelled.cancel();
    EXPECT_THROW(flood.run(seeds.regions, all_faces(mesh), {}, labels, density, runtime::RunControl(&cancelled)),
                 runtime::Stopped);
    labels.assign(mesh.face_count(), -1);
    flood.run(seeds.regions, all_faces(mesh), {}, labels, density, never);
    EXPECT_EQ(labels, flood_by_definition(passage, seeds.regions, {}));
}

TEST(FaceMetric, AgreesWithTheEnergyOfTheFits) {
    const mesh::WorkMesh mesh = work_mesh(bumpy_grid(10));
    quadric::Proxy proxy;
    proxy.origin = mesh.centroid(50);
    proxy.c = {0.01, 0.1, -0.2, 0.95, 0.4, -0.3, 0.2, 0.5, 0.1, -0.6};
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        const auto e = partition::face_energy(mesh, f, proxy, true);
        const auto reference = quadric::triangle_energy(proxy, mesh.corner(f, 0), mesh.corner(f, 1), mesh.corner(f, 2),
                                                        mesh.normals[f], mesh.areas[f]);
        EXPECT_NEAR(e.distance, reference.distance, 1e-12 * mesh.areas[f]);
        EXPECT_NEAR(e.normal, reference.normal, 1e-12 * mesh.areas[f]);
        const double hybrid = (reference.distance + 0.5 * reference.normal) / mesh.areas[f];
        EXPECT_NEAR(partition::error_density(mesh, f, proxy, {}), hybrid, 1e-11 * (1 + hybrid));
    }
}

TEST(FaceMetric, UnnormalisedMetricIsThatOfKanai) {
    const mesh::WorkMesh mesh = work_mesh(grid(1, 1));
    quadric::Proxy proxy;  // f = 3z: no distance on z = 0, ∇f = 3n
    proxy.origin = mesh.centroid(0);
    proxy.c = {0, 0, 0, 3, 0, 0, 0, 0, 0, 0};
    EXPECT_NEAR(partition::face_energy(mesh, 0, proxy, false).normal, 4 * mesh.areas[0], 1e-14);
    EXPECT_NEAR(partition::face_energy(mesh, 0, proxy, true).normal, 0, 1e-14);
}

}  // namespace
}  // namespace quadseg::test
