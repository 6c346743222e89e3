// Foot points on random quadrics of all kinds against brute force.
#include "surface/quadric_projector.h"

#include "quadric_samples.h"
#include "surface/surface.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace quadseg::surface {
namespace {

using namespace samples;

constexpr double none = std::numeric_limits<double>::infinity();

/// Nearest intersection of the line through p.
double along(const quadric::Coefficients& c, const Vec3& p, const Vec3& v) {
    const double f = quadric::value(c, p), b = dot(quadric::gradient(c, p), v);
    const double a =
        c[4] * v.x * v.x + c[5] * v.x * v.y + c[6] * v.x * v.z + c[7] * v.y * v.y + c[8] * v.y * v.z + c[9] * v.z * v.z;
    const double root = b * b - 4 * a * f;
    if (root < 0) return none;
    const double q = -0.5 * (b + std::copysign(std::sqrt(root), b));
    double nearest = none;
    if (a != 0) nearest = std::min(nearest, std::abs(q / a));
    if (q != 0) nearest = std::min(nearest, std::abs(f / q));
    return nearest;
}

/// Least distance over directions: random ones, then a shrinking search around the best.
double brute_force(const quadric::Coefficients& c, const Vec3& p, Random& random) {
    Vec3 best_direction{1, 0, 0};
    double best = none;
    for (int i = 0; i < 60; ++i) {
        const Vec3 v = random.direction();
        const double d = along(c, p, v);
        if (d < best) {
            best = d;
            best_direction = v;
        }
    }
    double radius = 0.5;
    for (int i = 0; i < 120 && best < none; ++i) {
        const Vec3 v = normalized(best_direction + radius * random.direction());
        const double d = along(c, p, v);
        if (d < best) {
            best = d;
            best_direction = v;
        } else {
            radius *= 0.93;
        }
    }
    return best;
}

double size_of_terms(const quadric::Coefficients& c, const Vec3& p) {
    const double f[10] = {1, p.x, p.y, p.z, p.x * p.x, p.x * p.y, p.x * p.z, p.y * p.y, p.y * p.z, p.z * p.z};
    double sum = 0;
    for (int i = 0; i < 10; ++i) sum += std::abs(c[std::size_t(i)] * f[i]);
    return sum;
}

/// A point anywhere, or with some principal coordinates 0: in symmetry planes, on axes, in the centre.
Vec3 query(const PrincipalQuadric& q, Random& random) {
    Vec3 p = q.centre;
    const std::uint64_t symmetric = random.next() % 3 == 0 ? random.next() % 8 : 0;
    for (int i = 0; i < 3; ++i)
        if (!(symmetric >> i & 1)) p += random.uniform(-4, 4) * q.axes[i];
    if (random.next() % 20 == 0) p += 1e3 * random.direction();
    return p;
}

TEST(QuadricProjector, NeverFartherThanBruteForceOnAllKinds) {
    Random random(2012);
    for (int run = 0; run < 17 * 1000; ++run) {
        const Kind kind = Kind(run % kind_count);
        const PrincipalQuadric q = random_quadric(kind, random);
        const quadric::Coefficients c = q.coefficients();
        const Vec3 p = query(q, random);
        const QuadricProjector projector(c);
        const Vec3 foot = projector.foot_point(p);
        const double d = norm(p - foot), size = 1 + norm(p) + norm(q.centre);
        ASSERT_TRUE(std::isfinite(d)) << int(kind);
        switch (kind) {
            case Kind::imaginary_ellipsoid:
            case Kind::imaginary_cylinder:
            case Kind::imaginary_planes:
                EXPECT_FALSE(projector.has_real_points()) << int(kind) << " " << run;
                EXPECT_EQ(foot, p);
                continue;
            case Kind::point:
                EXPECT_LT(norm(foot - q.centre), 1e-7 * size) << run;
                continue;
            case Kind::line: {
                const Vec3 u = p - q.centre;
                EXPECT_LT(norm(foot - (q.centre + dot(u, q.axes[2]) * q.axes[2])), 1e-7 * size) << run;
                continue;
            }
            case Kind::double_plane:
                EXPECT_LT(norm(foot - (p - dot(p - q.centre, q.axes[0]) * q.axes[0])), 1e-7 * size) << run;
                continue;
            default:
                break;
        }
        EXPECT_TRUE(projector.has_real_points()) << int(kind) << " " << run;
        EXPECT_LE(std::abs(quadric::value(c, foot)), 1e-13 * (size_of_terms(c, foot) + size_of_terms(c, p)))
            << int(kind) << " " << run << " d " << d;
        EXPECT_LE(d, brute_force(c, p, random) + 1e-7 * size) << int(kind) << " " << run;
    }
}

TEST(QuadricProjector, DistanceIsAlongTheGradient) {
    Random random(5);
    for (int run = 0; run < 5000; ++run) {
        const Kind kinds[] = {Kind::ellipsoid,           Kind::one_sheet,         Kind::two_sheets,
                              Kind::elliptic_paraboloid, Kind::elliptic_cylinder, Kind::hyperbolic_paraboloid,
                              Kind::hyperbolic_cylinder, Kind::parabolic_cylinder};
        const PrincipalQuadric q = random_quadric(kinds[run % 8], random);
        const quadric::Coefficients c = q.coefficients();
        const Vec3 p = q.centre + Vec3{random.uniform(-4, 4), random.uniform(-4, 4), random.uniform(-4, 4)};
        const Vec3 foot = QuadricProjector(c).foot_point(p);
        const Vec3 g = normalized(quadric::gradient(c, foot));
        EXPECT_LT(norm(cross(p - foot, g)), 1e-9 * (1 + norm(p))) << run;
        Surface s;
        s.type = SurfaceType::quadric;
        s.coefficients = c;
        const double sign = quadric::value(c, p) < 0 ? -1 : 1;
        EXPECT_DOUBLE_EQ(signed_distance(s, p), sign * norm(p - foot));
        EXPECT_LT(norm(normal_at(s, p) - g), 1e-9);
    }
}

// Spheres, cylinders and cones as quadrics: the closed forms.
TEST(QuadricProjector, AgreesWithClosedForms) {
    Random random(6);
    for (int run = 0; run < 3000; ++run) {
        const Vec3 o = random.direction(), a = random.direction();
        const Surface s = run % 4 == 0   ? sphere(o, random.uniform(.1, 2))
                          : run % 4 == 1 ? cylinder(o, a, random.uniform(.1, 2))
                          : run % 4 == 2 ? plane(o, a)
                                         : cone(o, a, random.uniform(.1, 1.4));
        const Vec3 p{random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)};
        const double d = norm(p - QuadricProjector(to_coefficients(s)).foot_point(p));
        double expected = norm(p - foot_point(s, p));
        if (s.type == SurfaceType::cone) {  // the quadric has both nappes
            const Surface other = cone(o, -a, s.half_angle);
            expected = std::min(expected, norm(p - foot_point(other, p)));
        }
        EXPECT_NEAR(d, expected, 2e-13) << run;
    }
}

TEST(QuadricProjector, NearlyPlanarQuadricsLoseNothing) {
    for (double curvature : {1e-3, 1e-6, 1e-9, 1e-12, 1e-16, 1e-30}) {
        const quadric::Coefficients c{0, 0, 0, 1, curvature, 0, 0, -2 * curvature, 0, 0};
        const Vec3 foot = QuadricProjector(c).foot_point({.5, .25, 1});
        EXPECT_NEAR(quadric::value(c, foot), 0, 1e-15);
        EXPECT_NEAR(foot.x, .5, 2 * curvature + 1e-15);
    }
}

TEST(QuadricProjector, AnyNumbersAreAnswered) {
    const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
    const Vec3 p{1, 2, 3};
    EXPECT_EQ(QuadricProjector(quadric::Coefficients{}).foot_point(p), p);
    EXPECT_EQ(QuadricProjector({1, 0, 0, 0, 0, 0, 0, 0, 0, 0}).foot_point(p), p);
    EXPECT_EQ(QuadricProjector({nan, 0, 0, 0, 1, 0, 0, 1, 0, 1}).foot_point(p), p);
    EXPECT_EQ(QuadricProjector({inf, 0, 0, 0, 1, 0, 0, 1, 0, 1}).foot_point(p), p);
    const QuadricProjector ball({-1, 0, 0, 0, 1, 0, 0, 1, 0, 1});
    EXPECT_NEAR(norm(ball.foot_point({0, 0, 0})), 1, 1e-15);
    EXPECT_NEAR(norm(ball.foot_point({1e-200, 0, 0})), 1, 1e-15);
    EXPECT_NEAR(norm(ball.foot_point({1e8, 0, 0})), 1, 1e-7);
    EXPECT_TRUE(std::isfinite(norm(ball.foot_point({1e150, 0, 0}))));
    const Vec3 bad{nan, 0, 0};
    EXPECT_TRUE(std::isnan(ball.foot_point(bad).x));
    Random random(8);
    for (int run = 0; run < 20000; ++run) {
        quadric::Coefficients c{};
        for (double& v : c)
            if (random.next() % 2) v = std::exp(random.uniform(-40, 40)) * (random.next() % 2 ? 1 : -1);
        const Vec3 x{random.gauss(), random.gauss(), random.gauss()};
        const Vec3 foot = QuadricProjector(c).foot_point(x);
        EXPECT_TRUE(std::isfinite(squared_norm(foot))) << run;
    }
}

}  // namespace
}  // namespace quadseg::surface
