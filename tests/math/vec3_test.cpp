#include "math/vec3.h"

#include <gtest/gtest.h>

namespace quadseg {
namespace {

TEST(Vec3, CrossIsPerpendicularAndRightHanded) {
    const Vec3 a{1, 2, 3}, b{-4, 0.5, 2}, c = cross(a, b);
    EXPECT_NEAR(dot(a, c), 0, 1e-15);
    EXPECT_NEAR(dot(b, c), 0, 1e-15);
    EXPECT_EQ(cross({1, 0, 0}, {0, 1, 0}), (Vec3{0, 0, 1}));
    EXPECT_NEAR(squared_norm(c), squared_norm(a) * squared_norm(b) - dot(a, b) * dot(a, b), 1e-12);
}

TEST(Vec3, NormalizedKeepsZero) {
    EXPECT_EQ(normalized({}), Vec3{});
    EXPECT_EQ(normalized({0, -3, 4}), (Vec3{0, -0.6, 0.8}));
}

TEST(Vec3, AngleIsAccurateNearZeroAndPi) {
    const double tiny = 1e-9;
    EXPECT_NEAR(angle_between({1, 0, 0}, {std::cos(tiny), std::sin(tiny), 0}), tiny, 1e-18);
    EXPECT_NEAR(M_PI - angle_between({1, 0, 0}, {-std::cos(tiny), std::sin(tiny), 0}), tiny, 1e-15);
    EXPECT_DOUBLE_EQ(angle_between({2, 0, 0}, {0, 0, 5}), M_PI / 2);
    EXPECT_EQ(angle_between({}, {1, 0, 0}), 0);
}

TEST(Vec3, AnyPerpendicularIsUnitAndPerpendicular) {
    for (const Vec3& v : {Vec3{1, 0, 0}, Vec3{0, -1, 0}, Vec3{0, 0, 1}, Vec3{0.6, 0, 0.8}, Vec3{1, 1, 1}}) {
        const Vec3 n = normalized(v), p = any_perpendicular(n);
        EXPECT_NEAR(dot(n, p), 0, 1e-16);
        EXPECT_NEAR(norm(p), 1, 1e-15);
    }
}

TEST(Vec3, IndexAndArray) {
    Vec3 v{1, 2, 3};
    v[1] = 5;
    EXPECT_EQ(to_array(v), (std::array<double, 3>{1, 5, 3}));
    EXPECT_EQ(to_vec3({1, 5, 3}), v);
    EXPECT_EQ(v[2], 3);
}

}  // namespace
}  // namespace quadseg
