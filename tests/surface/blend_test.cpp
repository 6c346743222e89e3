// Rolling-ball blends: the radius comes from offset points that concentrate on the spine.
#include "surface/blend.h"

#include "surface_samples.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>

namespace quadseg::surface {
namespace {

using namespace samples;

/// Canal of radius r around a space curve, sections over `arc`; side −1: a concave fillet (normals towards the spine).
Patch canal(double r, double arc, int sections, int across, double side, double bend = 0) {
    Patch patch;
    Random random(5);
    for (int i = 0; i < sections; ++i) {
        const double t = 2.0 * i / (sections - 1);
        const Vec3 spine{t, .3 * t * t, .2 * std::sin(2 * t)};
        const Vec3 tangent = normalized({1, .6 * t, .4 * std::cos(2 * t)});
        const Vec3 e = normalized(cross(tangent, {0, .2, 1})), f = cross(tangent, e);
        for (int j = 0; j < across; ++j) {
            const double a = arc * j / (across - 1);
            const Vec3 n = std::cos(a) * e + std::sin(a) * f;
            patch.points.push_back(spine + r * n);
            patch.normals.push_back(side * normalized(n + bend * random.direction()));
        }
    }
    return patch;
}

BlendFit blend_of(const Patch& p) {
    return fit_blend({p.points, p.normals, {}});
}

TEST(Blend, CanalOfConstantRadius) {
    for (double side : {1.0, -1.0}) {
        for (int across : {3, 5, 9}) {
            const BlendFit f = blend_of(canal(.1, std::numbers::pi / 2, 40, across, side));
            ASSERT_TRUE(f.ok);
            EXPECT_NEAR(f.radius, .1, 1e-3) << across;
            EXPECT_EQ(f.outward, side > 0);
            EXPECT_LT(f.spine_residual, 2e-3) << across;
            EXPECT_LT(f.radius_spread, .05);
            EXPECT_GT(f.section_angle, .1);
            EXPECT_GT(f.spine_extent, .3);
        }
    }
}

TEST(Blend, CoarseNormalsAreTolerated) {
    const BlendFit f = blend_of(canal(.1, std::numbers::pi / 2, 40, 6, 1, .03));
    ASSERT_TRUE(f.ok);
    EXPECT_NEAR(f.radius, .1, 5e-3);
    EXPECT_LT(f.spine_residual, 1e-2);
}

TEST(Blend, LargePatchesAreSampled) {
    const BlendFit f = blend_of(canal(.1, std::numbers::pi / 2, 400, 12, 1));
    ASSERT_TRUE(f.ok);
    EXPECT_NEAR(f.radius, .1, 2e-3);
}

TEST(Blend, ToriAndCylindersAreCanals) {
    const Surface s = torus({0, 0, 0}, {0, 0, 1}, 1, .2);
    const BlendFit f = blend_of(grid(s, {0, 2, 30}, {0, 1.5, 6}));
    ASSERT_TRUE(f.ok);
    EXPECT_NEAR(f.radius, .2, 2e-3);
    EXPECT_LT(f.spine_residual, 2e-3);
    const BlendFit g = blend_of(grid(cylinder({0, 0, 0}, {0, 0, 1}, .5), {0, 1.5, 6}, {0, 3, 10}));
    EXPECT_NEAR(g.radius, .5, 1e-9);
    EXPECT_LT(g.spine_residual, 1e-9);
}

TEST(Blend, OtherSurfacesShowIt) {
    const BlendFit ball = blend_of(grid(sphere({0, 0, 0}, 1), {-1, 1, 10}, {-.8, .8, 10}));
    EXPECT_LT(ball.spine_extent, 1e-6);
    const BlendFit flat = blend_of(grid(plane({0, 0, 0}, {0, 0, 1}), {-1, 1, 10}, {-1, 1, 10}));
    EXPECT_TRUE(!flat.ok || flat.section_angle < 1e-6);
    // A cone's radius changes along it: no ball rolls.
    const BlendFit round = blend_of(grid(cone({0, 0, 0}, {0, 0, 1}, .5), {0, 2, 12}, {.3, 2, 12}));
    EXPECT_GT(round.radius_spread, .1);
    const BlendFit tube = blend_of(canal(.1, std::numbers::pi / 2, 40, 5, 1));
    EXPECT_GT(round.spine_residual / round.radius, 5 * tube.spine_residual / tube.radius);
}

TEST(Blend, DegenerateDataAreRefused) {
    EXPECT_FALSE(fit_blend({}).ok);
    const std::vector<Vec3> same(20, Vec3{1, 2, 3}), up(20, Vec3{0, 0, 1});
    EXPECT_FALSE(fit_blend({same, up, {}}).ok);
    EXPECT_FALSE(fit_blend({same, {}, {}}).ok);
    Patch p = canal(.1, 1, 10, 4, 1);
    p.points[3].x = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(blend_of(p).ok);
}

}  // namespace
}  // namespace quadseg::surface
