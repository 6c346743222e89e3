#include "quadric/region_fit.h"

#include "quadric/fit.h"
#include "tests/quadric/shapes.h"

#include <gtest/gtest.h>

namespace quadseg::quadric {
namespace {

using test::Random;
using test::Soup;

RegionFitOptions paper() {
    RegionFitOptions options;
    options.best_of = false;
    return options;
}

void expect_sound(const RegionFit& fit, const Soup& soup, const RegionFitOptions& options) {
    TriangleEnergy sum;
    double area = 0, mean = 0, along = 0;
    for (std::size_t t = 0; t < soup.size(); ++t) {
        if (!(soup.areas[t] > 0)) continue;
        const TriangleEnergy e = triangle_energy(fit.proxy, soup.corners[3 * t], soup.corners[3 * t + 1],
                                                 soup.corners[3 * t + 2], soup.normals[t], soup.areas[t]);
        sum.distance += e.distance;
        sum.normal += e.normal;
        const Vec3 x = (soup.corners[3 * t] + soup.corners[3 * t + 1] + soup.corners[3 * t + 2]) / 3.0;
        const Vec3 g = gradient(fit.proxy.c, x - fit.proxy.origin);
        area += soup.areas[t];
        mean += soup.areas[t] * norm(g);
        along += soup.areas[t] * dot(g, soup.normals[t]);
    }
    const double tolerance = 1e-9 * fit.total + 1e-14 * area;
    EXPECT_NEAR(fit.energy.distance, sum.distance, tolerance);
    EXPECT_NEAR(fit.energy.normal, sum.normal, tolerance);
    EXPECT_NEAR(fit.total, sum.hybrid(options.weight), tolerance);
    if (area > 0) {
        EXPECT_NEAR(mean / area, 1, 1e-9) << "mean gradient";
        EXPECT_GE(along, -1e-12 * area) << "orientation";
    }
}

std::vector<std::pair<const char*, Soup>> soups() {
    return {{"plane", test::plane_patch()},
            {"cylinder", test::cylinder_patch()},
            {"sphere", test::ellipsoid_patch(12, 1, 1, 1)},
            {"cone", test::cone_patch()},
            {"saddle", test::saddle_patch()},
            {"ellipsoid", test::ellipsoid_patch(12, 1, 0.7, 0.5)},
            {"crease", test::crease_patch()},
            {"whole cylinder", test::cylinder_patch(16, 1, 6.283185307)}};
}

TEST(FitRegion, ReportsTrueEnergiesOfAnOrientedScaledProxy) {
    for (const auto& [name, soup] : soups()) {
        SCOPED_TRACE(name);
        for (const RegionFitOptions& options : {RegionFitOptions{}, paper()}) {
            expect_sound(fit_region(soup.view(), options), soup, options);
        }
    }
}

TEST(FitRegion, TakesPlanesForPlanesAndQuadricsForTheRest) {
    for (const auto& [name, soup] : soups()) {
        const RegionFit fit = fit_region(soup.view(), {});
        EXPECT_EQ(fit.proxy.planar(), std::string(name) == "plane") << name;
        EXPECT_TRUE(fit.valid) << name;
    }
}

TEST(FitRegion, BestOfIsNeverWorseThanTheTwoStepsWhereBothAreValid) {
    for (const auto& [name, soup] : soups()) {
        const RegionFit best = fit_region(soup.view(), {}), two_steps = fit_region(soup.view(), paper());
        if (two_steps.valid) {
            EXPECT_LE(best.total, two_steps.total * (1 + 1e-12)) << name;
        }
    }
}

TEST(FitRegion, PlaneToleranceDecides) {
    const Soup soup = test::cylinder_patch(8, 1, 0.1);
    RegionFitOptions options;
    options.plane_tolerance = 1;
    EXPECT_TRUE(fit_region(soup.view(), options).proxy.planar());
    options.plane_tolerance = 0;
    EXPECT_FALSE(fit_region(soup.view(), options).proxy.planar());
    const double density = fit_region(soup.view(), {1e-9 + 0.5, 1, false, true, 1}).total / soup.area();
    options.plane_tolerance_per_area = true;
    options.plane_tolerance = density * 1.01;
    EXPECT_TRUE(fit_region(soup.view(), options).proxy.planar());
    options.plane_tolerance = density * 0.99;
    EXPECT_FALSE(fit_region(soup.view(), options).proxy.planar());
}

TEST(FitRegion, DoesNotDependOnPlaceRotationAndScale) {
    Random random(1);
    for (const auto& [name, soup] : soups()) {
        SCOPED_TRACE(name);
        RegionFitOptions options;
        options.plane_tolerance_per_area = true;
        const RegionFit fit = fit_region(soup.view(), options);
        for (int round = 0; round < 5; ++round) {
            const auto rotation = test::random_rotation(random);
            const Vec3 shift = random.vector(3);
            const double s = round < 3 ? 1 : 0.01;
            const Soup moved = soup.mapped([&](const Vec3& x) { return rotation * x * s + shift; });
            RegionFitOptions moved_options = options;
            moved_options.weight = scaled_weight(options.weight, s);
            moved_options.plane_tolerance *= s * s;
            const RegionFit other = fit_region(moved.view(), moved_options);
            EXPECT_NEAR(other.total, fit.total * s * s * s * s, (1e-7 * fit.total + 1e-12) * s * s);
            EXPECT_EQ(other.valid, fit.valid);
            EXPECT_EQ(other.proxy.planar(), fit.proxy.planar());
        }
    }
}

TEST(FitRegion, SmallCylindersFarFromTheOriginAreAsGoodAsLargeOnes) {
    Random random(2);
    std::vector<double> errors;
    for (const double radius : {1.0, 0.02, 0.002}) {
        const auto rotation = test::random_rotation(random);
        const Soup soup = test::cylinder_patch(24, radius, 1.5).mapped([&](const Vec3& x) {
            return rotation * x + Vec3{0.4, -0.4, 0.3};
        });
        RegionFitOptions options;
        options.plane_tolerance = 0;
        options.weight = scaled_weight(0.5, radius);
        const RegionFit fit = fit_region(soup.view(), options);
        // ∇f perpendicular to the axis everywhere.
        double along_axis = 0, length_error = 0;
        for (const Vec3& x : soup.corners) {
            const Vec3 g = gradient(fit.proxy.c, x - fit.proxy.origin);
            along_axis = std::max(along_axis, std::abs(dot(g, rotation.z)));
            length_error = std::max(length_error, std::abs(norm(g) - 1));
        }
        // What is left is the facets': their one-point weights are not quite symmetric along the axis. No rounding.
        EXPECT_LT(along_axis, 2e-7) << radius;
        EXPECT_LT(length_error, 0.01) << radius;
        errors.push_back(length_error);
    }
    EXPECT_NEAR(errors[1], errors[0], 1e-11);
    EXPECT_NEAR(errors[2], errors[0], 1e-11);
}

TEST(FitRegion, ConesNeedTaubinAndNoisyPlanesNeedLeastSquares) {
    const Soup cone = test::cone_patch(12, 0.05, 1);
    EXPECT_LT(fit_region(cone.view(), {}).total / cone.area(), 5e-3);
    Random random(3);
    Soup noisy;
    {
        const int n = 12;
        std::vector<Vec3> grid;
        for (int i = 0; i <= n; ++i) {
            for (int j = 0; j <= n; ++j) grid.push_back(Vec3{i * 0.1, j * 0.1, random.uniform(-1, 1) * 0.003});
        }
        const auto at = [&](int i, int j) { return grid[static_cast<std::size_t>(i * (n + 1) + j)]; };
        for (int i = 0; i < n; ++i) {
            for (int j = 0; j < n; ++j) {
                noisy.add(at(i, j), at(i + 1, j), at(i + 1, j + 1));
                noisy.add(at(i, j), at(i + 1, j + 1), at(i, j + 1));
            }
        }
    }
    RegionFitOptions plane_only;
    plane_only.plane_tolerance = 1;
    const double plane = fit_region(noisy.view(), plane_only).total;
    const RegionFit fit = fit_region(noisy.view(), {});
    EXPECT_LE(fit.total, plane);
    EXPECT_TRUE(fit.valid);
    // Also the paper's two steps must not end above the plane.
    EXPECT_LE(fit_region(noisy.view(), paper()).total, plane);
}

TEST(FitRegion, WithoutTheNormalTermStillFits) {
    RegionFitOptions options;
    options.weight = 0;
    options.plane_tolerance = 1e-12;
    for (const bool best_of : {true, false}) {
        options.best_of = best_of;
        const Soup soup = test::ellipsoid_patch(10, 1, 0.7, 0.5);
        const RegionFit fit = fit_region(soup.view(), options);
        EXPECT_FALSE(fit.proxy.planar());
        EXPECT_LT(fit.energy.distance / soup.area(), 1e-4);
        expect_sound(fit, soup, options);
    }
}

TEST(FitRegion, SurvivesSmallAndDegenerateRegions) {
    std::vector<Soup> hard(8);
    hard[1].add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    hard[2] = hard[1];
    hard[2].add({1, 0, 0}, {1, 1, 0.4}, {0, 1, 0});
    hard[3].add({0, 0, 0}, {1, 0, 0}, {2, 0, 0});  // no area
    hard[4] = hard[2];
    hard[4].append(hard[3]);
    for (int k = 0; k < 4; ++k) hard[5].append(hard[1]);  // the same triangle again and again
    for (int k = 0; k < 2; ++k) {
        hard[6].add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
        hard[6].add({0, 0, 0}, {0, 1, 0}, {1, 0, 0});  // and its back
    }
    hard[7].add({1, 1, 1}, {1 + 1e-9, 1, 1}, {1, 1 + 1e-9, 1});
    for (std::size_t k = 0; k < hard.size(); ++k) {
        SCOPED_TRACE(k);
        for (const RegionFitOptions& options : {RegionFitOptions{}, paper()}) {
            const RegionFit fit = fit_region(hard[k].view(), options);
            EXPECT_TRUE(std::isfinite(fit.total));
            for (const double v : fit.proxy.c) EXPECT_TRUE(std::isfinite(v));
            EXPECT_TRUE(std::isfinite(fit.proxy.origin.x));
            is_valid(fit.proxy, hard[k].view());
            if (k != 6) expect_sound(fit, hard[k], options);
        }
    }
    EXPECT_LT(fit_region(hard[1].view(), {}).total, 1e-12);
    EXPECT_LT(fit_region(hard[5].view(), {}).total, 1e-12);
}

TEST(FitRegion, IsNeverNotANumberOnGarbage) {
    Random random(4);
    for (int round = 0; round < 300; ++round) {
        Soup soup;
        const auto count = static_cast<int>(random.uniform(1, 30));
        const double size = std::pow(10, random.uniform(-8, 4));
        for (int k = 0; k < count; ++k) soup.add(random.vector(size), random.vector(size), random.vector(size));
        if (round % 3 == 0) {
            for (Vec3& n : soup.normals) n = random.direction();
        }
        for (RegionFitOptions options : {RegionFitOptions{}, paper()}) {
            options.reweightings = round % 4;
            const RegionFit fit = fit_region(soup.view(), options);
            EXPECT_TRUE(std::isfinite(fit.total));
            EXPECT_GE(fit.total, 0);
            for (const double v : fit.proxy.c) EXPECT_TRUE(std::isfinite(v));
        }
    }
    Soup broken = test::plane_patch(2);
    broken.areas[0] = NAN;
    broken.areas[1] = INFINITY;
    broken.corners[0].x = NAN;
    EXPECT_TRUE(std::isfinite(fit_region(broken.view(), {}).total));
}

TEST(FitRegion, IsTheSameEveryTime) {
    const Soup soup = test::ellipsoid_patch(23, 1, 0.7, 0.5);
    const RegionFit a = fit_region(soup.view(), {}), b = fit_region(soup.view(), {});
    EXPECT_EQ(a.proxy.c, b.proxy.c);
    EXPECT_EQ(a.total, b.total);
}

TEST(PlaneProxy, GoesThroughThePointWithTheNormal) {
    const Proxy proxy = plane_proxy({1, 2, 3}, {0, 0, 2});
    EXPECT_TRUE(proxy.planar());
    EXPECT_EQ(value(proxy.c, Vec3{5, 6, 4} - proxy.origin), 1);
    EXPECT_TRUE(plane_proxy({}, {}).planar());
}

}  // namespace
}  // namespace quadseg::quadric
