// Types and parameters from coefficients.
#include "quadric_samples.h"
#include "surface/surface.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace quadseg::surface {
namespace {

using namespace samples;

SurfaceType expected_type(Kind kind) {
    switch (kind) {
        case Kind::ellipsoid:
            return SurfaceType::ellipsoid;
        case Kind::one_sheet:
            return SurfaceType::hyperboloid_one_sheet;
        case Kind::two_sheets:
            return SurfaceType::hyperboloid_two_sheets;
        case Kind::cone:
            return SurfaceType::elliptic_cone;
        case Kind::elliptic_paraboloid:
            return SurfaceType::elliptic_paraboloid;
        case Kind::hyperbolic_paraboloid:
            return SurfaceType::hyperbolic_paraboloid;
        case Kind::elliptic_cylinder:
            return SurfaceType::elliptic_cylinder;
        case Kind::hyperbolic_cylinder:
            return SurfaceType::hyperbolic_cylinder;
        case Kind::parabolic_cylinder:
            return SurfaceType::parabolic_cylinder;
        default:
            return SurfaceType::quadric;
    }
}

Vec3 row(const Surface& s, int i) {
    const std::size_t k = 3 * std::size_t(i);
    return {s.axes[k], s.axes[k + 1], s.axes[k + 2]};
}

/// f of the reported parameters, up to scale: 0 where the quadric is 0.
double from_parameters(const Surface& s, const Vec3& p) {
    const Vec3 q = p - to_vec3(s.point);
    const double u = dot(q, row(s, 0)), v = dot(q, row(s, 1)), w = dot(q, row(s, 2));
    const double a = s.semi_axes[0], b = s.semi_axes[1], c = s.semi_axes[2];
    switch (s.type) {
        case SurfaceType::ellipsoid:
            return u * u / (a * a) + v * v / (b * b) + w * w / (c * c) - 1;
        case SurfaceType::hyperboloid_one_sheet:
            return u * u / (a * a) + v * v / (b * b) - w * w / (c * c) - 1;
        case SurfaceType::hyperboloid_two_sheets:
            return u * u / (a * a) + v * v / (b * b) - w * w / (c * c) + 1;
        case SurfaceType::elliptic_cone:
            return u * u / (a * a) + v * v / (b * b) - w * w / (c * c);
        case SurfaceType::elliptic_paraboloid:
            return u * u / a + v * v / b - w;
        case SurfaceType::hyperbolic_paraboloid:
            return u * u / a - v * v / b - w;
        case SurfaceType::elliptic_cylinder:
            return u * u / (a * a) + v * v / (b * b) - 1;
        case SurfaceType::hyperbolic_cylinder:
            return u * u / (a * a) - v * v / (b * b) - 1;
        case SurfaceType::parabolic_cylinder:
            return u * u / a - v;
        default:
            return 1e300;
    }
}

TEST(Classify, AllKindsAndTheirParameters) {
    Random random(42);
    for (int run = 0; run < kind_count * 200; ++run) {
        const Kind kind = Kind(run % kind_count);
        PrincipalQuadric q = random_quadric(kind, random);
        for (int i = 0; i < 3; ++i) q.square[i] *= 1 + .3 * i;  // no two alike
        const quadric::Coefficients c = q.coefficients();
        const Vec3 near = q.centre + .5 * random.direction();
        const Surface s = classify(c, near, 1, 1e-6);
        ASSERT_EQ(int(s.type), int(expected_type(kind))) << run;
        if (s.type == SurfaceType::quadric) continue;
        EXPECT_NEAR(dot(cross(row(s, 0), row(s, 1)), row(s, 2)), 1, 1e-12);
        EXPECT_EQ(s.coefficients, c);
        const QuadricProjector projector(c);
        for (int i = 0; i < 20; ++i) {
            const Vec3 p = projector.foot_point(q.centre + 2 * random.direction());
            EXPECT_NEAR(from_parameters(s, p), 0, 1e-7) << int(kind) << " " << run;
        }
    }
}

TEST(Classify, SurfacesOfCommonTypes) {
    Random random(43);
    for (int run = 0; run < 400; ++run) {
        const Vec3 o = random.direction(), a = random.direction();
        Surface s = run % 4 == 0   ? sphere(o, random.uniform(.1, 2))
                    : run % 4 == 1 ? cylinder(o, a, random.uniform(.1, 2))
                    : run % 4 == 2 ? plane(o, a)
                                   : cone(o, a, random.uniform(.2, 1.3));
        if (s.type != SurfaceType::plane) s.outward = run % 8 < 4;
        Random on(static_cast<std::uint64_t>(run));
        const Vec3 near = random_point_on(s, on);
        for (double scale : {1.0, -3.0, 1e-9, 1e9}) {
            quadric::Coefficients c = to_coefficients(s);
            for (double& v : c) v *= scale;
            const Surface found = classify(c, near, .3);
            ASSERT_EQ(int(found.type), int(s.type)) << run;
            if (s.type == SurfaceType::plane) {
                EXPECT_LT(norm(to_vec3(found.axis) - std::copysign(1, scale) * to_vec3(s.axis)), 1e-12);
                continue;
            }
            EXPECT_EQ(found.outward, s.outward == (scale > 0)) << run;
            EXPECT_LT(parameter_error(found, s, 1), 1e-7) << run;
        }
    }
}

TEST(Classify, ToleranceIsRelativeToTheRegion) {
    // A large sphere is a plane for a small region, and a slightly elliptic cylinder is a cylinder at a loose
    // tolerance.
    const quadric::Coefficients ball = to_coefficients(sphere({0, 0, -1000}, 1000));
    EXPECT_EQ(int(classify(ball, {0, 0, 0}, .1).type), int(SurfaceType::plane));
    EXPECT_EQ(int(classify(ball, {0, 0, 0}, 100).type), int(SurfaceType::sphere));
    const quadric::Coefficients tube{-1, 0, 0, 0, 1, 0, 0, 1.0005, 0, 0};
    EXPECT_EQ(int(classify(tube, {1, 0, 0}, 1, 1e-3).type), int(SurfaceType::cylinder));
    EXPECT_EQ(int(classify(tube, {1, 0, 0}, 1, 1e-5).type), int(SurfaceType::elliptic_cylinder));
}

TEST(Classify, NonsenseIsAQuadric) {
    const double nan = std::nan("");
    for (const quadric::Coefficients& c :
         {quadric::Coefficients{}, quadric::Coefficients{nan}, quadric::Coefficients{1, 0, 0, 0, 1, 0, 0, 1, 0, 1}})
        EXPECT_EQ(int(classify(c, {0, 0, 0}, 1).type), int(SurfaceType::quadric));
    EXPECT_EQ(int(classify(to_coefficients(sphere({0, 0, 0}, 1)), {0, 0, 0}, 0).type), int(SurfaceType::quadric));
}

}  // namespace
}  // namespace quadseg::surface
