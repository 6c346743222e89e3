#include "partition/border_price.h"

#include "tests/partition/box.h"

#include <cmath>
#include <gtest/gtest.h>

namespace quadseg {
namespace {

using partition::BorderPrice;

quadric::Proxy plane(const Vec3& normal, double offset, double steepness = 1) {
    quadric::Proxy p;
    p.c[0] = offset * steepness;
    for (int k = 0; k < 3; ++k) p.c[1 + static_cast<std::size_t>(k)] = normal[k] * steepness;
    return p;
}

struct Edge {
    std::size_t f, k, g;
    double length;
    Vec3 middle;
};

/// An inner edge of a flat square in the plane z = 0 of the unit frame.
Edge inner_edge(const mesh::WorkMesh& mesh) {
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        for (std::size_t k = 0; k < 3; ++k) {
            if (mesh.neighbors[f][k] < 0) continue;
            const Vec3 a = mesh.corner(f, static_cast<int>(k)), b = mesh.corner(f, static_cast<int>((k + 1) % 3));
            return {f, k, static_cast<std::size_t>(mesh.neighbors[f][k]), norm(a - b), (a + b) / 2.0};
        }
    }
    return {};
}

TEST(BorderPrice, IsTheLengthWhereGapsCostNothing) {
    const mesh::WorkMesh mesh = test::work_mesh(test::grid(4, 4));
    const Edge e = inner_edge(mesh);
    const quadric::Proxy a = plane({0, 0, 1}, 0), b = plane({0, 0, 1}, -5);
    EXPECT_DOUBLE_EQ((BorderPrice{3, 0}.of_edge(mesh, e.f, e.k, e.g, a, b)), 3 * e.length);
    EXPECT_EQ((BorderPrice{0, 2}.of_edge(mesh, e.f, e.k, e.g, a, b)), 0);
}

TEST(BorderPrice, RisesWithTheSquareOfTheGapUpToElevenfold) {
    const mesh::WorkMesh mesh = test::work_mesh(test::grid(4, 4));
    const Edge e = inner_edge(mesh);
    const BorderPrice price{1, 100};
    const auto apart = [&](double d) {
        return price.of_edge(mesh, e.f, e.k, e.g, plane({0, 0, 1}, 0.2), plane({0, 0, 1}, 0.2 - d)) / e.length;
    };
    EXPECT_DOUBLE_EQ(apart(0), 1);
    EXPECT_NEAR(apart(0.1), 2, 1e-12);
    EXPECT_NEAR(apart(-0.2), 5, 1e-12);
    EXPECT_NEAR(apart(10), 11, 1e-12);
    EXPECT_NEAR(apart(std::nan("")), 11, 1e-12);  // a surface that is no number is nowhere near
}

/// Neither the sign of an implicit function nor its steepness says where a surface is.
TEST(BorderPrice, SeesSurfacesNotTheirEquations) {
    const mesh::WorkMesh mesh = test::work_mesh(test::grid(4, 4));
    const Edge e = inner_edge(mesh);
    const BorderPrice price{1, 100};
    const quadric::Proxy a = plane({0, 0, 1}, 0), b = plane({0, 0, 1}, 0.1), turned = plane({0, 0, -1}, -0.1, 7);
    const double expected = price.of_edge(mesh, e.f, e.k, e.g, a, b);
    EXPECT_NEAR(price.of_edge(mesh, e.f, e.k, e.g, a, turned), expected, 1e-12);
    EXPECT_NEAR(price.of_edge(mesh, e.f, e.k, e.g, turned, a), expected, 1e-12);
    const auto slot = mesh::matching_edge(mesh, e.f, e.k);
    EXPECT_NEAR(price.of_edge(mesh, e.g, slot, e.f, a, b), expected, 1e-12);
}

/// A crease through the middle of the edge: whatever its angle, there both surfaces are at hand.
TEST(BorderPrice, IsLowestWhereSurfacesMeet) {
    const mesh::WorkMesh mesh = test::work_mesh(test::grid(4, 4));
    const Edge e = inner_edge(mesh);
    const BorderPrice price{1, 1e4};
    for (const double angle : {0.2, 1.0, 1.5}) {
        const Vec3 n{std::sin(angle), 0, std::cos(angle)};
        const auto meets_at = [&](double x) { return plane(n, -n.x * x); };
        const quadric::Proxy flat = plane({0, 0, 1}, 0);
        EXPECT_NEAR(price.of_edge(mesh, e.f, e.k, e.g, flat, meets_at(e.middle.x)), e.length, 1e-9 * e.length);
        EXPECT_GT(price.of_edge(mesh, e.f, e.k, e.g, flat, meets_at(e.middle.x + 0.1)), 2 * e.length);
    }
}

}  // namespace
}  // namespace quadseg
