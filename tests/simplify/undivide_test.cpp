#include "simplify/undivide.h"

#include "tests/simplify/small_meshes.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>

namespace quadseg::simplify {
namespace {

const UndivideOptions options{1e-9, [] {}};

Vec3 area_vector(const std::vector<Vec3>& p, const std::array<std::uint32_t, 3>& f) {
    return cross(p[f[1]] - p[f[0]], p[f[2]] - p[f[0]]) * 0.5;
}

/// Facets by normal: right for shapes without parallel neighbours.
std::vector<std::int32_t> facets_by_normal(const SmallMesh& mesh) {
    std::map<std::array<long, 3>, std::int32_t> known;
    std::vector<std::int32_t> facet;
    for (const auto& f : mesh.faces) {
        const Vec3 n = normalized(area_vector(mesh.positions, f));
        const std::array<long, 3> key{std::lround(1e6 * n.x), std::lround(1e6 * n.y), std::lround(1e6 * n.z)};
        facet.push_back(known.try_emplace(key, static_cast<std::int32_t>(known.size())).first->second);
    }
    return facet;
}

/// Every triangle into four.
SmallMesh subdivided(const SmallMesh& mesh) {
    SmallMesh fine{mesh.positions, {}};
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const auto [at, fresh] =
            middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(fine.positions.size()));
        if (fresh) fine.positions.push_back((mesh.positions[a] + mesh.positions[b]) * 0.5);
        return at->second;
    };
    for (const auto& f : mesh.faces) {
        const std::uint32_t x = middle(f[0], f[1]), y = middle(f[1], f[2]), z = middle(f[2], f[0]);
        fine.faces.insert(fine.faces.end(), {{f[0], x, z}, {x, f[1], y}, {z, y, f[2]}, {x, y, z}});
    }
    return fine;
}

Undivided undivide(const SmallMesh& mesh, const std::vector<std::int32_t>& facet) {
    return simplify::undivide(mesh.positions, mesh.faces, facet, options);
}

TEST(Undivide, ADividedCubeHasEightCornersAgain) {
    const SmallMesh mesh = cube(7);
    const auto facet = facets_by_normal(mesh);
    const Undivided plain = undivide(mesh, facet);
    EXPECT_EQ(plain.positions.size(), 8U);
    ASSERT_EQ(plain.faces.size(), 12U);
    std::map<std::int32_t, double> area;
    for (std::size_t i = 0; i < plain.faces.size(); ++i) {
        const Vec3 a = area_vector(plain.positions, plain.faces[i]);
        const std::uint32_t source = plain.source_face[i];
        EXPECT_GT(dot(a, area_vector(mesh.positions, mesh.faces[source])), 0);
        area[facet[source]] += norm(a);
    }
    ASSERT_EQ(area.size(), 6U);
    for (const auto& [f, a] : area) EXPECT_NEAR(a, 1, 1e-12);
}

TEST(Undivide, FindsBackWhatSubdivisionAdded) {
    // Facets of a dome: no two of one normal.
    const SmallMesh plain =
        height_field(9, [](double x, double y) { return 0.3 * std::sin(2 * x) * std::cos(1.7 * y); });
    const SmallMesh fine = subdivided(subdivided(plain));
    const Undivided found = undivide(fine, facets_by_normal(fine));
    ASSERT_EQ(found.positions.size(), plain.positions.size());
    EXPECT_EQ(found.faces.size(), plain.faces.size());
    for (std::size_t v = 0; v < found.positions.size(); ++v) {
        EXPECT_LT(found.source_vertex[v], plain.positions.size());
        EXPECT_EQ(norm(found.positions[v] - fine.positions[found.source_vertex[v]]), 0);
    }
}

TEST(Undivide, KeepsCornersOfBordersAndWhatIsNoManifold) {
    const SmallMesh square = flat_grid(6);
    const std::vector<std::int32_t> one(square.faces.size(), 0);
    EXPECT_EQ(undivide(square, one).positions.size(), 4U);

    // A third sheet on an edge in the middle of the square: its ends and the edge stay.
    SmallMesh flag = square;
    const std::uint32_t a = 3 * 7 + 3, b = a + 1, top = static_cast<std::uint32_t>(flag.positions.size());
    flag.positions.push_back({0.5, 0.5, 1});
    flag.faces.push_back({a, b, top});
    std::vector<std::int32_t> facet = one;
    facet.push_back(1);
    const Undivided found = undivide(flag, facet);
    EXPECT_EQ(found.positions.size(), 7U);
    std::set<std::uint32_t> kept(found.source_vertex.begin(), found.source_vertex.end());
    EXPECT_TRUE(kept.contains(a) && kept.contains(b) && kept.contains(top));
}

TEST(Undivide, TwoFoldedTrianglesStayTwo) {
    // Vertices 4 and 5 lie on the edges of two triangles that share all three corners: without them nothing would be
    // left.
    SmallMesh pillow;
    pillow.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, 0, 0}};
    pillow.faces = {{0, 3, 2}, {3, 1, 2}, {0, 2, 3}, {3, 2, 1}};
    const Undivided found = undivide(pillow, {0, 0, 1, 1});
    EXPECT_EQ(found.faces.size() % 2, 0U);
    EXPECT_GE(found.faces.size(), 2U);
    for (const auto& f : found.faces) EXPECT_GT(norm(area_vector(found.positions, f)), 0);
}

TEST(Undivide, WhatCheckThrowsLeaves) {
    const SmallMesh mesh = cube(3);
    struct Enough : std::runtime_error {
        Enough() : std::runtime_error("enough") {}
    };
    EXPECT_THROW(simplify::undivide(mesh.positions, mesh.faces, facets_by_normal(mesh), {0, [] { throw Enough(); }}),
                 Enough);
}

}  // namespace
}  // namespace quadseg::simplify
