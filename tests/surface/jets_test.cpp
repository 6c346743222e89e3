// Normals and curvatures from local polynomials.
#include "surface/jets.h"

#include "surface/fit.h"
#include "surface_samples.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>

namespace quadseg::surface {
namespace {

using namespace samples;

TEST(Jets, PolynomialsOfTheOrderAreExact) {
    const Vec3 n = normalized({1, -2, .5}), u = any_perpendicular(n), v = cross(n, u);
    // Without a component along 1, a, b the mean plane is the graph's own.
    std::vector<Vec3> points;
    for (int i = 0; i < 8; ++i) {
        for (int j = 0; j < 8; ++j) {
            const double a = (i - 3.5) / 7, b = (j - 3.5) / 7;
            points.push_back(a * u + b * v + (.3 * a * b + .2 * (a * a - b * b) - .1 * a * a * b * b) * n);
        }
    }
    double residual = 1;
    const auto normals = patch_normals(points, n, &residual);
    EXPECT_LT(residual, 1e-14);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double a = dot(points[i], u), b = dot(points[i], v);
        const double da = .3 * b + .4 * a - .2 * a * b * b, db = .3 * a - .4 * b - .2 * a * a * b;
        EXPECT_LT(norm(normals[i] - normalized(n - da * u - db * v)), 1e-12);
    }
}

TEST(Jets, OrderByNumberOfPoints) {
    const Vec3 n{0, 0, 1};
    Random random(4);
    auto some = [&](int count) {
        std::vector<Vec3> points;
        for (int i = 0; i < count; ++i) {
            const double a = random.uniform(-1, 1), b = random.uniform(-1, 1);
            points.push_back({a, b, -.1 * (a * a + b * b)});
        }
        return points;
    };
    EXPECT_EQ(fit_jet(some(40), n).order, 4);
    EXPECT_EQ(fit_jet(some(20), n).order, 3);
    EXPECT_EQ(fit_jet(some(10), n).order, 2);
    EXPECT_EQ(fit_jet(some(5), n).order, 1);
    EXPECT_EQ(fit_jet(some(2), n).order, 0);
}

TEST(Jets, CurvaturesOfKnownSurfaces) {
    for (double scale : {1e-6, 1.0, 1e6}) {
        const Surface ball = sphere(scale * Vec3{1, 2, 3}, scale);
        std::vector<Vec3> points;
        for (int i = -3; i <= 3; ++i)
            for (int j = -3; j <= 3; ++j) points.push_back(point_on(ball, .05 * i, .05 * j));
        std::swap(points[0], points[24]);
        const Vec3 n = true_normal(ball, points[0]);
        const Jet jet = fit_jet(points, n);
        EXPECT_LT(norm(jet.normal - n), 1e-6);
        EXPECT_NEAR(jet.curvature_min * scale, 1, 1e-3);
        EXPECT_NEAR(jet.curvature_max * scale, 1, 1e-3);
        const Jet inside = fit_jet(points, -n);
        EXPECT_NEAR(inside.curvature_max * scale, -1, 1e-3);
    }
    const Surface tube = cylinder({0, 0, 0}, {0, 0, 1}, .5);
    std::vector<Vec3> points;
    for (int i = -3; i <= 3; ++i)
        for (int j = -3; j <= 3; ++j) points.push_back(point_on(tube, .1 * i, .05 * j));
    std::swap(points[0], points[24]);
    const Jet jet = fit_jet(points, true_normal(tube, points[0]));
    EXPECT_NEAR(jet.curvature_min, 0, 1e-6);
    EXPECT_NEAR(jet.curvature_max, 2, 2e-3);
}

TEST(Jets, PatchNormalsBeatFaceNormals) {
    const Surface s = torus({0, 0, 0}, {0, 0, 1}, 1, .3);
    const Patch patch = grid(s, {0, .5, 7}, {.3, 1.2, 7});
    double residual = 0;
    const auto normals = patch_normals(patch.points, patch.normals[24], &residual);
    double worst = 0;
    for (std::size_t i = 0; i < normals.size(); ++i) worst = std::max(worst, norm(normals[i] - patch.normals[i]));
    EXPECT_LT(worst, 0.02);  // at the rim; faces are off by 0.075
    EXPECT_LT(residual, 1e-4);
    EXPECT_GT(residual, 0);
}

TEST(Jets, DegeneratePointsKeepTheOrientation) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const Vec3 n = normalized({1, 1, 1});
    EXPECT_EQ(fit_jet({}, n).normal, n);
    const std::vector<Vec3> same(12, Vec3{1, 2, 3});
    EXPECT_LT(norm(fit_jet(same, n).normal - n), 1e-15);
    std::vector<Vec3> line;
    for (int i = 0; i < 30; ++i) line.push_back(double(i) * Vec3{1, -1, 0});
    EXPECT_NEAR(norm(fit_jet(line, n).normal), 1, 1e-12);
    line[3].x = nan;
    EXPECT_LT(norm(fit_jet(line, n).normal - n), 1e-15);
    EXPECT_EQ(patch_normals({}, n).size(), 0u);
    EXPECT_LT(norm(patch_normals(line, n)[5] - n), 1e-15);
}

TEST(Jets, PatchNormalsStartTori) {
    // With normals as coarse as those of faces the line complex finds no axis, with those of a jet it does.
    const Surface s = torus({0, 0, 0}, {0, 0, 1}, 1, .3);
    const Patch patch = grid(s, {0, .5, 7}, {.3, 1.2, 7}, .1);
    const auto normals = patch_normals(patch.points, true_normal(s, patch.points[24]));
    const Surface coarse = initial_torus({patch.points, patch.normals, {}});
    const Surface fine = initial_torus({patch.points, normals, {}});
    EXPECT_LT(parameter_error(fine, s, 1), 0.1);
    EXPECT_LT(parameter_error(fine, s, 1), parameter_error(coarse, s, 1));
}

}  // namespace
}  // namespace quadseg::surface
