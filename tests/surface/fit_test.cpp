// Typed fits: vertices of tessellations lie on the true surface and give its parameters back.
#include "surface/fit.h"

#include "surface_samples.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>
#include <string>

namespace quadseg::surface {
namespace {

using namespace samples;
constexpr double pi = std::numbers::pi;

struct Case {
    std::string name;
    Surface surface;
    Range u, v;
    double bend = 0.1;
    double tolerance = 1e-10;
};

const Vec3 tilted = normalized({.3, -.5, .8});
const Vec3 place{.2, -.1, .4};

std::vector<Case> exact_cases() {
    return {
        {"plane", plane(place, tilted), {-1, 1, 6}, {-1, 1, 7}},
        {"plane of 4 vertices", plane(place, tilted), {-1, 1, 2}, {-1, 1, 2}},
        {"whole sphere", sphere(place, .7), {-pi, 2.9, 12}, {-1.4, 1.4, 7}},
        {"sphere cap", sphere(place, .7), {-pi, 2.9, 8}, {1.2, 1.5, 4}},
        {"sphere of two rims", sphere(place, .7), {-pi, 2.9, 12}, {.2, .6, 2}},
        {"whole cylinder", cylinder(place, tilted, .4), {-pi, 2.9, 16}, {0, 1, 4}},
        {"two rims of a cylinder, 16 facets", cylinder(place, tilted, .4), {-pi, pi * 7 / 8, 16}, {0, 1, 2}},
        {"two rims of a cylinder, 8 facets", cylinder(place, tilted, .4), {-pi, pi * 3 / 4, 8}, {0, .05, 2}},
        {"quarter cylinder of 4 facets", cylinder(place, tilted, .4), {0, pi / 2, 5}, {0, 1, 2}, .15},
        {"long quarter cylinder of 4 facets", cylinder(place, tilted, .04), {0, pi / 2, 5}, {0, 10, 2}, .05, 1e-9},
        {"two facets", cylinder(place, tilted, .4), {0, .5, 3}, {0, 1, 2}, .05, 1e-9},
        {"whole cone", cone(place, tilted, .5), {-pi, 2.9, 16}, {.5, 1.5, 4}},
        {"two rims of a cone", cone(place, tilted, .5), {-pi, pi * 7 / 8, 16}, {1, 1.5, 2}},
        {"chamfer, 8 facets", cone(place, tilted, pi / 4), {-pi, pi * 3 / 4, 8}, {1, 1.1, 2}, .1, 1e-9},
        {"quarter cone of 4 facets", cone(place, tilted, .5), {0, pi / 2, 5}, {1, 2, 3}, .1, 1e-9},
        {"flat cone", cone(place, tilted, 1.4), {-pi, 2.9, 16}, {.5, 1.5, 3}},
        {"cone with its apex", cone(place, tilted, .6), {-pi, 2.9, 16}, {0, 1, 4}},
        {"slender cone", cone(place, tilted, .01), {-pi, 2.9, 16}, {50, 60, 3}, .02, 1e-8},
        {"whole torus", torus(place, tilted, .8, .25), {-pi, 2.9, 20}, {-pi, 2.8, 10}},
        {"half torus", torus(place, tilted, .8, .25), {0, 3, 12}, {-pi, 2.8, 8}},
        {"rounded edge: quarter fillet", torus(place, tilted, .8, .1), {-pi, 2.9, 16}, {0, pi / 2, 5}},
        {"inner quarter fillet", torus(place, tilted, .8, .1), {-pi, 2.9, 16}, {pi / 2, pi, 5}},
        {"fillet of one row, three rims", torus(place, tilted, .8, .1), {-pi, 2.9, 16}, {0, pi / 2, 3}},
        {"three rims, few columns", torus(place, tilted, .8, .1), {0, .9, 5}, {0, pi / 2, 3}, .1, 1e-8},
        {"top of a torus", torus(place, tilted, .8, .3), {-pi, 2.9, 16}, {pi / 2 - .4, pi / 2 + .4, 4}, .05},
        {"corner of a fillet", torus(place, tilted, .3, .2), {0, pi / 2, 6}, {0, pi / 2, 6}},
        {"apple", torus(place, tilted, .2, .5), {-pi, 2.9, 16}, {-1, 1, 6}},
        {"lemon", torus(place, tilted, -.2, .5), {-pi, 2.9, 16}, {-1, 1, 6}},
        {"slender lemon", torus(place, tilted, -3, 3.3), {-pi, 2.9, 16}, {-.3, .3, 6}, .03},
        {"large fillet", torus(place, tilted, 20, .5), {0, .1, 6}, {0, pi / 2, 6}, .02, 1e-7},
    };
}

SurfaceFit fit_of(const Surface& s, const Patch& patch, const FitOptions& options = {}) {
    return fit(s.type, {patch.points, patch.normals, {}}, options);
}

TEST(Fit, ExactDataGiveTheParametersBack) {
    for (const Case& c : exact_cases()) {
        for (bool outward : {true, false}) {
            if (c.surface.type == SurfaceType::plane && !outward) continue;
            Surface truth = c.surface;
            truth.outward = outward;
            const Patch patch = grid(truth, c.u, c.v, c.bend);
            const SurfaceFit f = fit_of(truth, patch);
            ASSERT_TRUE(f.ok) << c.name;
            const double size = std::max({truth.radius, truth.minor_radius, 1.0});
            EXPECT_LT(parameter_error(f.surface, truth, size), c.tolerance) << c.name;
            EXPECT_LT(f.max, 1e-14 * std::max(1.0, size)) << c.name;
            EXPECT_EQ(f.surface.outward, outward) << c.name;
        }
    }
}

TEST(Fit, ScaleAndPlaceDoNotMatter) {
    for (const Case& c : exact_cases()) {
        const Patch patch = grid(c.surface, c.u, c.v, c.bend);
        for (double scale : {1e-6, 1e6}) {
            Patch scaled = patch;
            for (Vec3& p : scaled.points) p *= scale;
            FitOptions options;
            options.minimum_scale *= scale;
            const SurfaceFit f = fit_of(c.surface, scaled, options);
            ASSERT_TRUE(f.ok) << c.name << scale;
            EXPECT_LT(f.max, 1e-14 * scale * std::max({c.surface.radius, c.surface.minor_radius, 1.0})) << c.name;
        }
        Patch far = patch;
        for (Vec3& p : far.points) p += Vec3{1e3, -2e3, 5e2};
        const SurfaceFit f = fit_of(c.surface, far);
        ASSERT_TRUE(f.ok) << c.name;
        EXPECT_LT(f.max, 5e-12) << c.name;  // rounding of the coordinates: 2e-13
    }
}

TEST(Fit, OneVertexInFiveOffTheSurfaceDoesNotMatter) {
    for (const Case& c : exact_cases()) {
        if (c.u.count * c.v.count < 40) continue;
        Patch patch = grid(c.surface, c.u, c.v, c.bend);
        Random random(3);
        for (std::size_t i = 0; i < patch.points.size(); i += 5) patch.points[i] += 1e-5 * random.direction();
        const SurfaceFit f = fit_of(c.surface, patch);
        ASSERT_TRUE(f.ok) << c.name;
        EXPECT_LT(f.median, 1e-10) << c.name;
    }
}

TEST(Fit, NoiseGivesTheLikelySurface) {
    for (const Case& c : exact_cases()) {
        if (c.u.count * c.v.count < 40) continue;
        Patch patch = grid(c.surface, {c.u.low, c.u.high, 24}, {c.v.low, c.v.high, 12}, c.bend);
        const double sigma = 1e-5;
        add_noise(patch, sigma);
        FitOptions options;
        options.robust = false;
        const SurfaceFit f = fit_of(c.surface, patch, options);
        ASSERT_TRUE(f.ok) << c.name;
        const double expected = sigma * std::sqrt(1 - degrees_of_freedom(c.surface.type) / double(patch.points.size()));
        EXPECT_LT(f.rms, expected * 1.15) << c.name;
        EXPECT_GT(f.rms, expected * 0.85) << c.name;
    }
}

TEST(Fit, LeastSquaresAreRefusedAboveTheRmsThatIsOfUse) {
    for (const Case& c : exact_cases()) {
        // Planes have one solution, which takes no steps.
        if (c.u.count * c.v.count < 40 || c.surface.type == SurfaceType::plane) continue;
        Patch patch = grid(c.surface, c.u, c.v, c.bend);
        add_noise(patch, 1e-5);
        FitOptions options;
        options.robust = false;
        const SurfaceFit any = fit_of(c.surface, patch, options);
        ASSERT_TRUE(any.ok) << c.name;
        options.most_rms = any.rms * 1.1;
        const SurfaceFit of_use = fit_of(c.surface, patch, options);
        ASSERT_TRUE(of_use.ok) << c.name;
        EXPECT_NEAR(of_use.rms, any.rms, any.rms * 1e-3) << c.name;
        options.most_rms = any.rms * 0.9;
        EXPECT_FALSE(fit_of(c.surface, patch, options).ok) << c.name;
    }
}

TEST(Fit, LargeRadiusUpToTheLimit) {
    for (double radius : {1e2, 1e3}) {
        const Surface s = sphere({0, 0, -radius}, radius);
        const Patch cap = grid(s, {-pi, 2.9, 12}, {pi / 2 - 1 / radius, pi / 2 - .1 / radius, 5}, 1e-3 / radius);
        const SurfaceFit f = fit_of(s, cap);
        ASSERT_TRUE(f.ok);
        EXPECT_NEAR(f.surface.radius / radius, 1, 1e-15 * radius * radius * 20);
        const Surface tube = cylinder({0, 0, -radius}, {0, 1, 0}, radius);
        const Patch arc = grid(tube, {-1 / radius, 1 / radius, 9}, {-1, 1, 5}, 1e-3 / radius);
        const SurfaceFit g = fit_of(tube, arc);
        ASSERT_TRUE(g.ok);
        EXPECT_NEAR(g.surface.radius / radius, 1, 1e-15 * radius * radius * 20);
    }
    const Patch flat = grid(plane(place, tilted), {-1, 1, 6}, {-1, 1, 7}, 0.01);
    EXPECT_FALSE(fit(SurfaceType::sphere, {flat.points, flat.normals, {}}).ok);
    EXPECT_FALSE(fit(SurfaceType::cylinder, {flat.points, flat.normals, {}}).ok);
}

TEST(Fit, DegenerateDataAreRefused) {
    const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    Random random(5);
    std::vector<std::vector<Vec3>> sets;
    sets.push_back({});
    sets.push_back({{1, 2, 3}});
    sets.push_back(std::vector<Vec3>(20, Vec3{1, 2, 3}));
    std::vector<Vec3> line, with_nan, with_inf, denormal;
    for (int i = 0; i < 20; ++i) {
        line.push_back(double(i) * Vec3{1, 2, 3});
        with_nan.push_back(random.direction());
        with_inf.push_back(random.direction());
        denormal.push_back(1e-310 * random.direction());
    }
    with_nan[7].y = nan;
    with_inf[3].z = inf;
    sets.insert(sets.end(), {line, with_nan, with_inf, denormal});
    for (const auto& points : sets) {
        std::vector<Vec3> normals;
        for (std::size_t i = 0; i < points.size(); ++i) normals.push_back(random.direction());
        for (SurfaceType type : {SurfaceType::plane, SurfaceType::sphere, SurfaceType::cylinder, SurfaceType::cone,
                                 SurfaceType::torus, SurfaceType::quadric}) {
            EXPECT_FALSE(fit(type, {points, normals, {}}).ok);
            EXPECT_FALSE(fit(type, {points, {}, {}}).ok);
        }
    }
    // Fewer independent points than parameters.
    const Patch rim = grid(cylinder(place, tilted, .4), {-pi, 2.9, 16}, {0, 0, 1});
    for (SurfaceType type : {SurfaceType::sphere, SurfaceType::cone, SurfaceType::torus})
        EXPECT_FALSE(fit(type, {rim.points, rim.normals, {}}).ok) << int(type);
    EXPECT_TRUE(fit(SurfaceType::plane, {rim.points, rim.normals, {}}).ok);
    const Patch rims = grid(cylinder(place, tilted, .4), {-pi, 2.9, 16}, {0, 1, 2});
    EXPECT_FALSE(fit(SurfaceType::torus, {rims.points, rims.normals, {}}).ok);
    // NaN normals.
    Patch bad = grid(cylinder(place, tilted, .4), {-pi, 2.9, 16}, {0, 1, 3});
    bad.normals[3].x = nan;
    for (SurfaceType type :
         {SurfaceType::plane, SurfaceType::sphere, SurfaceType::cylinder, SurfaceType::cone, SurfaceType::torus}) {
        const SurfaceFit f = fit(type, {bad.points, bad.normals, {}});
        EXPECT_TRUE(!f.ok || std::isfinite(f.rms));
    }
}

TEST(Fit, RandomPointsNeverCrash) {
    Random random(77);
    for (int run = 0; run < 300; ++run) {
        Patch patch;
        const int n = 1 + int(random.next() % 40);
        for (int i = 0; i < n; ++i) {
            const double length = random.uniform(0, 1);
            patch.points.push_back(random.direction() * length);
            patch.normals.push_back(random.direction());
            if (random.next() % 5 == 0) patch.points.back() = patch.points[0];
        }
        for (SurfaceType type :
             {SurfaceType::plane, SurfaceType::sphere, SurfaceType::cylinder, SurfaceType::cone, SurfaceType::torus}) {
            const SurfaceFit f = fit(type, {patch.points, patch.normals, {}});
            if (f.ok) {
                EXPECT_TRUE(std::isfinite(f.rms));
                EXPECT_LE(f.median, f.q90);
                EXPECT_LE(f.q90, f.q97);
                EXPECT_LE(f.q97, f.max);
            }
        }
    }
}

TEST(Fit, RefineConvergesFromAfarAndKeepsTheType) {
    const Surface truth = torus(place, tilted, .8, .25);
    const Patch patch = grid(truth, {-pi, 2.9, 20}, {-pi, 2.8, 10});
    Surface start = truth;
    start.radius *= 1.2;
    start.minor_radius *= .7;
    start.point[0] += .1;
    start.axis = to_array(normalized(tilted + Vec3{.2, .1, 0}));
    const SurfaceFit f = refine(start, {patch.points, patch.normals, {}});
    ASSERT_TRUE(f.ok);
    EXPECT_LT(parameter_error(f.surface, truth, 1), 1e-12);
}

TEST(Fit, MeasureReportsQuantilesOfDistances) {
    std::vector<Vec3> points;
    points.reserve(100);
    for (int i = 0; i < 100; ++i) points.push_back({double(i), 0, i * .01});
    const SurfaceFit f = measure(plane({0, 0, 0}, {0, 0, 1}), {points, {}, {}});
    EXPECT_NEAR(f.median, .50, 1e-15);
    EXPECT_NEAR(f.q90, .90, 1e-15);
    EXPECT_NEAR(f.q97, .97, 1e-15);
    EXPECT_NEAR(f.max, .99, 1e-15);
}

}  // namespace
}  // namespace quadseg::surface
