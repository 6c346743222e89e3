#include "surface/curvature_tensor.h"

#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

namespace quadseg::test {
namespace {

using surface::CurvatureTensor;
using surface::fit_curvature;

/// Principal curvatures, the smaller first.
std::array<double, 2> principal(const CurvatureTensor& t) {
    const double mean = (t.along_x + t.along_y) / 2, half = (t.along_x - t.along_y) / 2;
    const double spread = std::sqrt(half * half + t.mixed * t.mixed);
    return {mean - spread, mean + spread};
}

/// Points of z = height(x, y) around the origin.
template <class Height>
std::vector<Vec3> disc(double radius, const Height& height) {
    std::vector<Vec3> points{{0, 0, height(0, 0)}};
    for (int ring = 1; ring <= 2; ++ring) {
        for (int i = 0; i < 7; ++i) {
            const double a = 0.3 * ring + 2 * std::acos(-1.0) * i / 7, r = radius * ring / 2;
            points.push_back({r * std::cos(a), r * std::sin(a), height(r * std::cos(a), r * std::sin(a))});
        }
    }
    return points;
}

TEST(CurvatureTensor, OfASphereSeenFromOutside) {
    const auto points = disc(0.3, [](double x, double y) { return std::sqrt(1 - x * x - y * y); });
    const CurvatureTensor t = fit_curvature(points, points[0], {0, 0, 1});
    EXPECT_NEAR(principal(t)[0], -1, 5e-3);
    EXPECT_NEAR(principal(t)[1], -1, 5e-3);
    EXPECT_NEAR(t.normal.z, 1, 1e-9);
    EXPECT_LT(t.error, 1e-2);
}

TEST(CurvatureTensor, OfACylinderWhoseFacetsTurnFar) {
    // 18° from ring to ring, as meshers make small fillets: a parabola would be 5 % off.
    const auto points = disc(0.6, [](double x, double) { return std::sqrt(1 - x * x); });
    const CurvatureTensor t = fit_curvature(points, points[0], {0.1, 0, 1});
    EXPECT_NEAR(principal(t)[0], -1, 0.03);
    EXPECT_NEAR(principal(t)[1], 0, 0.03);
}

TEST(CurvatureTensor, OfASaddleInAnyFrame) {
    const auto points = disc(0.04, [](double x, double y) { return 2 * x * x - y * y; });
    for (const Vec3& up : {Vec3{0, 0, 1}, Vec3{0.2, -0.1, 1}}) {
        const CurvatureTensor t = fit_curvature(points, points[0], up);
        EXPECT_NEAR(principal(t)[0], -2, 0.05);
        EXPECT_NEAR(principal(t)[1], 4, 0.1);
    }
}

TEST(CurvatureTensor, DirectionsWithoutPointsBendLittle) {
    std::vector<Vec3> row;  // two columns of an extruded profile: nothing tells how it bends along x
    for (int i = -3; i <= 3; ++i) {
        row.push_back({-0.01, 0.1 * i, 0.5 * 0.01 * i * i});
        row.push_back({0.01, 0.1 * i, 0.5 * 0.01 * i * i});
    }
    const CurvatureTensor t = fit_curvature(row, {}, {0, 0, 1});
    EXPECT_NEAR(principal(t)[1], 1, 0.03);
    EXPECT_NEAR(principal(t)[0], 0, 0.1);
    const Vec3 y_axis = cross(t.normal, t.x_axis);
    const double along_row = std::abs(t.x_axis.y) > std::abs(y_axis.y) ? t.spread[0] : t.spread[4];
    EXPECT_GT(along_row, 1);
    EXPECT_LT(t.spread[2], 0.2);
}

TEST(CurvatureTensor, TooLittleToFitSaysSo) {
    const std::vector<Vec3> few{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0.5}};
    EXPECT_TRUE(std::isinf(fit_curvature(few, few[0], {0, 0, 1}).error));
    EXPECT_TRUE(std::isinf(fit_curvature({}, {}, {0, 0, 1}).error));
    EXPECT_TRUE(std::isinf(fit_curvature(few, few[0], {}).error));
    const std::vector<Vec3> same(12, Vec3{1, 2, 3});
    EXPECT_TRUE(std::isinf(fit_curvature(same, same[0], {0, 0, 1}).error));
}

}  // namespace
}  // namespace quadseg::test
