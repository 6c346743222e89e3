#include "math/symmetric3.h"

#include <cmath>
#include <gtest/gtest.h>
#include <vector>

namespace quadseg {
namespace {

void expect_decomposes(const Symmetric3& m, double relative = 1e-14) {
    const EigenSystem e = eigen_decomposition(m);
    const double size = std::max({std::abs(e.values[0]), std::abs(e.values[1]), std::abs(e.values[2])});
    EXPECT_LE(e.values[0], e.values[1]);
    EXPECT_LE(e.values[1], e.values[2]);
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(norm(m * e.vectors[i] - e.vectors[i] * e.values[i]), 0, relative * size);
        for (int j = 0; j < 3; ++j) EXPECT_NEAR(dot(e.vectors[i], e.vectors[j]), i == j ? 1 : 0, 1e-14);
    }
    EXPECT_NEAR(dot(cross(e.vectors[0], e.vectors[1]), e.vectors[2]), 1, 1e-14);
}

TEST(EigenDecomposition, KnownMatrix) {
    const EigenSystem e = eigen_decomposition({2, 1, 0, 2, 0, 5});
    EXPECT_NEAR(e.values[0], 1, 1e-15);
    EXPECT_NEAR(e.values[1], 3, 1e-15);
    EXPECT_NEAR(e.values[2], 5, 1e-15);
    EXPECT_NEAR(std::abs(e.vectors[0].x + e.vectors[0].y), 0, 1e-15);
}

TEST(EigenDecomposition, ManyMatricesOfManySizes) {
    double x = 0.5;
    const auto number = [&x] { return x = 3.99 * x * (1 - x); };  // chaotic enough
    for (const double size : {1e-30, 1e-6, 1.0, 1e12}) {
        for (int i = 0; i < 200; ++i) {
            Symmetric3 m;
            for (int k = 0; k < 4; ++k)
                m.add_outer({number() - 0.5, number() - 0.5, number() - 0.5}, size * (number() - 0.3));
            expect_decomposes(m);
        }
    }
}

TEST(EigenDecomposition, EqualAndVanishingValues) {
    expect_decomposes({});
    expect_decomposes({1, 0, 0, 1, 0, 1});
    expect_decomposes({0, 0, 0, 0, 0, -3});
    Symmetric3 rank_one;
    rank_one.add_outer({1e-3, 2e-3, -1e-3});
    expect_decomposes(rank_one);
    EXPECT_NEAR(eigen_decomposition(rank_one).values[2], 6e-6, 1e-20);
    Symmetric3 close{1, 1e-9, 0, 1, 1e-9, 1};
    expect_decomposes(close);
}

TEST(EigenDecomposition, SmallValueBesideLargeOnes) {
    // A thin slab: the smallest value is ten decades below the others and still points the right way.
    const Vec3 n = normalized({1, 2, -3}), u = any_perpendicular(n), w = cross(n, u);
    Symmetric3 m;
    m.add_outer(u, 1);
    m.add_outer(w, 0.7);
    m.add_outer(n, 1e-10);
    const EigenSystem e = eigen_decomposition(m);
    EXPECT_NEAR(std::abs(dot(e.vectors[0], n)), 1, 1e-14);
    EXPECT_NEAR(e.values[0], 1e-10, 1e-15);
}

}  // namespace
}  // namespace quadseg
