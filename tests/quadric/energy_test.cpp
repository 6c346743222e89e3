#include "quadric/energy.h"

#include "quadric/region_fit.h"
#include "tests/quadric/shapes.h"

#include <gtest/gtest.h>

namespace quadseg::quadric {
namespace {

using test::Random;

Coefficients random_quadric(Random& random) {
    Coefficients c;
    for (double& v : c) v = random.uniform(-1, 1);
    return c;
}

/// The 6-point degree-4 rule (MATH.md §2) on 4 × 4 subtriangles.
template <class Function>
double integrate(const Vec3& a, const Vec3& b, const Vec3& c, double area, const Function& f) {
    constexpr int s = 4;
    double sum = 0;
    const auto corner = [&](int i, int j) { return a + (b - a) * (double(i) / s) + (c - a) * (double(j) / s); };
    const auto add = [&](const Vec3& p, const Vec3& q, const Vec3& r) {
        const auto orbit = [&](double weight, double x) {
            const double y = (1 - x) / 2;
            sum += weight * (f(p * x + q * y + r * y) + f(p * y + q * x + r * y) + f(p * y + q * y + r * x));
        };
        orbit(0.223381589678011, 0.108103018168070);
        orbit(0.109951743655322, 0.816847572980459);
    };
    for (int i = 0; i < s; ++i) {
        for (int j = 0; i + j < s; ++j) {
            add(corner(i, j), corner(i + 1, j), corner(i, j + 1));
            if (i + j + 1 < s) add(corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1));
        }
    }
    return sum * area / (s * s);
}

TEST(Gradient, AgreesWithFiniteDifferences) {
    Random random(1);
    for (int round = 0; round < 50; ++round) {
        const Coefficients c = random_quadric(random);
        const Vec3 x = random.vector(1), g = gradient(c, x);
        const double h = 1e-4;
        EXPECT_NEAR(g.x, (value(c, x + Vec3{h, 0, 0}) - value(c, x - Vec3{h, 0, 0})) / (2 * h), 1e-10);
        EXPECT_NEAR(g.y, (value(c, x + Vec3{0, h, 0}) - value(c, x - Vec3{0, h, 0})) / (2 * h), 1e-10);
        EXPECT_NEAR(g.z, (value(c, x + Vec3{0, 0, h}) - value(c, x - Vec3{0, 0, h})) / (2 * h), 1e-10);
    }
}

TEST(Frames, ToLocalAndBackKeepTheValues) {
    Random random(2);
    for (int round = 0; round < 50; ++round) {
        const Coefficients c = random_quadric(random);
        const Vec3 origin = random.vector(2), x = random.vector(1);
        const double scale = random.uniform(0.3, 4);
        const Coefficients local = to_local(c, origin, scale);
        EXPECT_NEAR(value(local, (x - origin) * scale), value(c, x), 1e-13);
        const Coefficients back = from_local(local, origin, scale);
        for (std::size_t i = 0; i < 10; ++i) EXPECT_NEAR(back[i], c[i], 1e-13);
    }
}

TEST(TriangleEnergy, EqualsQuadratureOfItsDefinition) {
    Random random(3);
    for (int round = 0; round < 50; ++round) {
        const Coefficients q = random_quadric(random);
        const Vec3 a = random.vector(1), b = random.vector(1), c = random.vector(1), n = random.direction();
        const double area = norm(cross(b - a, c - a)) / 2;
        const double length = norm(gradient(q, (a + b + c) / 3.0));
        const TriangleEnergy e = triangle_energy(q, a, b, c, n, area);
        const double distance = integrate(a, b, c, area, [&](const Vec3& x) {
            const double d = value(q, x) / length;
            return d * d;
        });
        const double normal =
            integrate(a, b, c, area, [&](const Vec3& x) { return squared_norm(gradient(q, x) / length - n); });
        EXPECT_NEAR(e.distance, distance, 1e-12 * (1 + distance));
        EXPECT_NEAR(e.normal, normal, 1e-12 * (1 + normal));
        EXPECT_DOUBLE_EQ(e.hybrid(0.5), e.distance + 0.5 * e.normal);
    }
}

TEST(TriangleEnergy, OfAPlaneIsTheClosedFormOfThePaper) {
    Random random(4);
    for (int round = 0; round < 50; ++round) {
        const Vec3 a = random.vector(1), b = random.vector(1), c = random.vector(1), n = random.direction();
        const double area = norm(cross(b - a, c - a)) / 2, d = random.uniform(-1, 1);
        const Vec3 m = random.direction();
        const TriangleEnergy closed = plane_triangle_energy(m, d, a, b, c, n, area);
        const TriangleEnergy general = triangle_energy(plane(m, d), a, b, c, n, area);
        EXPECT_NEAR(closed.distance, general.distance, 1e-13);
        EXPECT_NEAR(closed.normal, general.normal, 1e-13);
        const double distance = integrate(a, b, c, area, [&](const Vec3& x) { return std::pow(dot(m, x) + d, 2); });
        EXPECT_NEAR(closed.distance, distance, 1e-13);
    }
}

TEST(TriangleEnergy, DoesNotDependOnTheScaleOfF) {
    Random random(5);
    const Coefficients q = random_quadric(random);
    Coefficients larger = q;
    for (double& v : larger) v *= 7;
    const Vec3 a{0, 0, 0}, b{1, 0, 0.2}, c{0, 1, 0.3}, n{0, 0, 1};
    EXPECT_NEAR(triangle_energy(q, a, b, c, n, 0.5).distance, triangle_energy(larger, a, b, c, n, 0.5).distance, 1e-14);
    EXPECT_NEAR(triangle_energy(q, a, b, c, n, 0.5).normal, triangle_energy(larger, a, b, c, n, 0.5).normal, 1e-14);
}

TEST(TriangleEnergy, IsFiniteWhereItHasNoMeaning) {
    const Vec3 a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0};
    EXPECT_EQ(triangle_energy(plane({0, 0, 1}, 0), a, b, b, {}, 0).hybrid(1), 0);
    // No gradient at all: floored, finite.
    EXPECT_TRUE(std::isfinite(triangle_energy(Coefficients{1}, a, b, c, {0, 0, 1}, 0.5).hybrid(1)));
    EXPECT_TRUE(std::isfinite(triangle_energy(Coefficients{}, a, b, c, {0, 0, 1}, 0.5, 0).hybrid(1)));
    // The apex of a cone at the centroid.
    const Coefficients cone{0, 0, 0, 0, 1, 0, 0, 1, 0, -1};
    const TriangleEnergy e = triangle_energy(cone, {1, 0, 0}, {-1, 1, 0}, {0, -1, 0}, {0, 0, 1}, 1.5, 0.05);
    EXPECT_TRUE(std::isfinite(e.hybrid(1)));
}

TEST(MomentEnergy, EqualsTheSumOverTrianglesWhereTheWeightsAreOne) {
    // A plane's gradient has length 1 everywhere: one-point weights and moments agree exactly.
    const test::Soup soup = test::saddle_patch(5);
    const Vec3 n = normalized({0.1, -0.2, 1});
    TriangleEnergy sum;
    for (std::size_t t = 0; t < soup.size(); ++t) {
        const TriangleEnergy e = plane_triangle_energy(n, 0.1, soup.corners[3 * t], soup.corners[3 * t + 1],
                                                       soup.corners[3 * t + 2], soup.normals[t], soup.areas[t]);
        sum.distance += e.distance;
        sum.normal += e.normal;
    }
    const TriangleEnergy whole = moment_energy(plane(n, 0.1), soup.moments({}));
    EXPECT_NEAR(whole.distance, sum.distance, 1e-13);
    EXPECT_NEAR(whole.normal, sum.normal, 1e-13);
}

TEST(MomentEnergy, EqualsQuadratureForQuadrics) {
    Random random(6);
    const test::Soup soup = test::saddle_patch(2);
    const Moments m = soup.moments({});
    for (int round = 0; round < 20; ++round) {
        const Coefficients q = random_quadric(random);
        double distance = 0, normal = 0;
        for (std::size_t t = 0; t < soup.size(); ++t) {
            const Vec3 &a = soup.corners[3 * t], &b = soup.corners[3 * t + 1], &c = soup.corners[3 * t + 2];
            distance += integrate(a, b, c, soup.areas[t], [&](const Vec3& x) { return std::pow(value(q, x), 2); });
            normal += integrate(a, b, c, soup.areas[t],
                                [&](const Vec3& x) { return squared_norm(gradient(q, x) - soup.normals[t]); });
        }
        const TriangleEnergy e = moment_energy(q, m);
        EXPECT_NEAR(e.distance, distance, 1e-12 * (1 + distance));
        EXPECT_NEAR(e.normal, normal, 1e-12 * (1 + normal));
    }
}

}  // namespace
}  // namespace quadseg::quadric
