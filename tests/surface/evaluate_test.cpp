// Signed distance, normal and foot point of typed surfaces against samplings of their parametric forms.
#include "surface/evaluate.h"

#include "surface/surface.h"
#include "surface_samples.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace quadseg::surface {
namespace {

using namespace samples;

std::vector<Surface> typical_surfaces() {
    const Vec3 a = normalized({.3, -.5, .8}), o{.2, -.1, .4};
    return {plane(o, a),           sphere(o, .7),        cylinder(o, a, .4),  cone(o, a, .5),
            cone(o, a, 1.3),       torus(o, a, .8, .25), torus(o, a, .3, .5), torus(o, a, -.3, .5),
            torus(o, a, 1e-9, .5), torus(o, a, .25, .2)};
}

// Every point of the surface is at distance 0, its foot point is itself, points offset by h along the normal are at h.
TEST(Evaluate, PointsOnAndOffTheSurface) {
    for (Surface s : typical_surfaces()) {
        for (bool outward : {true, false}) {
            if (s.type != SurfaceType::plane) s.outward = outward;
            const SurfaceEvaluator e(s);
            Random random(7);
            for (int i = 0; i < 200; ++i) {
                const Vec3 p = random_point_on(s, random);
                EXPECT_NEAR(e.distance(p), 0, 1e-14) << int(s.type);
                const Vec3 n = e.normal(p);
                EXPECT_NEAR(norm(n), 1, 1e-14);
                EXPECT_NEAR(e.distance(p + 1e-3 * n), 1e-3, 1e-12) << int(s.type) << s.radius;
                EXPECT_NEAR(e.distance(p - 1e-4 * n), -1e-4, 1e-12);
                EXPECT_LT(norm(foot_point(s, p) - p), 1e-14);
                EXPECT_DOUBLE_EQ(signed_distance(s, p + 1e-2 * n), e.distance(p + 1e-2 * n));
            }
        }
    }
}

// No sampled point of the surface is nearer than the foot point, and distances are those to the foot point.
TEST(Evaluate, FootPointIsNearest) {
    for (const Surface& s : typical_surfaces()) {
        const SurfaceEvaluator e(s);
        Random random(11);
        std::vector<Vec3> cloud;
        for (int i = 0; i < 4000; ++i) cloud.push_back(random_point_on(s, random));
        for (int i = 0; i < 300; ++i) {
            const Vec3 p{random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)};
            const Vec3 foot = foot_point(s, p);
            const double d = norm(p - foot);
            EXPECT_NEAR(signed_distance(s, foot), 0, 1e-14) << int(s.type);
            EXPECT_NEAR(std::abs(e.distance(p)), d, 1e-13) << int(s.type) << " " << s.radius;
            for (const Vec3& q : cloud) EXPECT_GE(norm(p - q), d - 1e-12);
            // The gradient of the distance is the normal (away from the medial axis, where it jumps).
            if (d > 1e-3 && s.type != SurfaceType::cone && !(s.minor_radius > s.radius)) {
                const Vec3 n = e.normal(p);
                EXPECT_NEAR(norm((p - foot) - e.distance(p) * n), 0, 1e-12);
            }
        }
    }
}

TEST(Evaluate, ConeIsOneNappe) {
    const Surface s = cone({0, 0, 0}, {0, 0, 1}, std::numbers::pi / 4);
    EXPECT_NEAR(signed_distance(s, {0, 0, -2}), 2, 1e-15);
    EXPECT_NEAR(signed_distance(s, {0, 1, -1}), std::sqrt(2.0), 1e-15);
    EXPECT_NEAR(signed_distance(s, {0, 1, 1}), 0, 1e-15);
    EXPECT_EQ(foot_point(s, {0, 0, -2}), (Vec3{0, 0, 0}));
}

TEST(Evaluate, FixedChoicesWhereTheFootPointIsNotUnique) {
    for (const Surface& s : typical_surfaces()) {
        const Vec3 centre = to_vec3(s.point);
        EXPECT_EQ(foot_point(s, centre), foot_point(s, centre));
        EXPECT_NEAR(signed_distance(s, foot_point(s, centre)), 0, 1e-14);
        EXPECT_NEAR(norm(normal_at(s, centre)), 1, 1e-14);
    }
}

TEST(Evaluate, CoefficientsVanishOnTheSurfaceAndAreOriented) {
    for (Surface s : typical_surfaces()) {
        if (s.type > SurfaceType::cone) continue;
        for (bool outward : {true, false}) {
            if (s.type != SurfaceType::plane) s.outward = outward;
            const quadric::Coefficients c = to_coefficients(s);
            Random random(5);
            for (int i = 0; i < 100; ++i) {
                const Vec3 p = random_point_on(s, random), g = quadric::gradient(c, p);
                EXPECT_NEAR(quadric::value(c, p), 0, 1e-14) << int(s.type);
                const double size = s.type == SurfaceType::cone ? norm(p - to_vec3(s.point)) : 1;
                EXPECT_LT(norm(g - size * normal_at(s, p)), 1e-13) << int(s.type);
            }
        }
    }
}

TEST(Evaluate, TransformationsCommuteWithDistance) {
    const Vec3 centre{.3, 2, -.7};
    const double scale = 2.5;
    for (Surface s : typical_surfaces()) {
        s.coefficients = to_coefficients(s);
        const Surface t = transformed(s, centre, scale), back = transformed_back(t, centre, scale);
        Random random(3);
        for (int i = 0; i < 50; ++i) {
            const Vec3 p{random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)};
            EXPECT_NEAR(signed_distance(t, (p - centre) * scale), scale * signed_distance(s, p), 1e-12);
            EXPECT_NEAR(signed_distance(back, p), signed_distance(s, p), 1e-13);
            if (s.type == SurfaceType::sphere) {
                EXPECT_NEAR(quadric::value(t.coefficients, (p - centre) * scale),
                            scale * quadric::value(s.coefficients, p), 1e-12);
            }
        }
    }
}

}  // namespace
}  // namespace quadseg::surface
