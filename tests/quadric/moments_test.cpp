#include "quadric/moments.h"

#include "quadric/moment_accumulator.h"
#include "quadric/moment_buffers.h"
#include "tests/quadric/shapes.h"

#include <gtest/gtest.h>

namespace quadseg::quadric {
namespace {

using test::Random;

long double power(long double x, int n) {
    long double r = 1;
    for (int i = 0; i < n; ++i) r *= x;
    return r;
}

/// ∫ x^i y^j z^k by an iterated Gauss rule of 4 × 4 points in a collapsed square: exact to degree 6, unrelated to the
/// engine's formulas.
long double brute_force(const Vec3& a, const Vec3& b, const Vec3& c, const std::array<int, 3>& e, long double area) {
    const long double inner = std::sqrt(3.0L / 7 - 2.0L / 7 * std::sqrt(6.0L / 5)),
                      outer = std::sqrt(3.0L / 7 + 2.0L / 7 * std::sqrt(6.0L / 5));
    const long double nodes[4] = {-outer, -inner, inner, outer};
    const long double large = (18 + std::sqrt(30.0L)) / 36, small = (18 - std::sqrt(30.0L)) / 36;
    const long double weights[4] = {small, large, large, small};
    long double sum = 0;
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
            const long double s = (1 + nodes[i]) / 2, t = (1 + nodes[j]) / 2 * (1 - s);
            const long double x = a.x + s * (b.x - a.x) + t * (c.x - a.x), y = a.y + s * (b.y - a.y) + t * (c.y - a.y),
                              z = a.z + s * (b.z - a.z) + t * (c.z - a.z);
            sum += weights[i] * weights[j] / 4 * (1 - s) * power(x, e[0]) * power(y, e[1]) * power(z, e[2]);
        }
    }
    return 2 * area * sum;
}

void expect_near(const Moments& a, const Moments& b, double tolerance) {
    for (std::size_t i = 0; i < 35; ++i) EXPECT_NEAR(a.area[i], b.area[i], tolerance) << "moment " << i;
    for (std::size_t i = 0; i < 12; ++i) EXPECT_NEAR(a.normal[i], b.normal[i], tolerance) << "normal " << i;
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(a.normal2[i], b.normal2[i], tolerance) << "normal2 " << i;
    EXPECT_NEAR(a.total_area, b.total_area, tolerance);
    EXPECT_NEAR(a.normal_area, b.normal_area, tolerance);
}

TEST(Moments, ExponentsAreInTheOrderOfCoefficientsFirst) {
    const std::array<std::array<int, 3>, 10> first = {
        {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {2, 0, 0}, {1, 1, 0}, {1, 0, 1}, {0, 2, 0}, {0, 1, 1}, {0, 0, 2}}};
    for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(moment_exponents[i], first[i]);
    for (std::size_t i = 11; i < 35; ++i) {
        const auto degree = [](const std::array<int, 3>& e) { return e[0] + e[1] + e[2]; };
        const auto &a = moment_exponents[i - 1], &b = moment_exponents[i];
        if (degree(a) == degree(b)) {
            EXPECT_GT(a, b) << i;
        } else {
            EXPECT_EQ(degree(a) + 1, degree(b)) << i;
        }
    }
}

TEST(Moments, OfTrianglesAreExact) {
    Random random(1);
    for (int round = 0; round < 100; ++round) {
        const Vec3 a = random.vector(1), b = random.vector(1), c = random.vector(1);
        const Vec3 n = random.direction();
        const double area = norm(cross(b - a, c - a)) / 2, w2 = random.uniform(0.2, 3), w1 = random.uniform(0.2, 3);
        Moments m;
        accumulate(m, a, b, c, n, area, w2, w1);
        for (std::size_t i = 0; i < 35; ++i) {
            const auto exact = static_cast<double>(w2 * brute_force(a, b, c, moment_exponents[i], area));
            EXPECT_NEAR(m.area[i], exact, 1e-15) << "moment " << i;
        }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (std::size_t k = 0; k < 4; ++k) {
                const auto exact = static_cast<double>(brute_force(a, b, c, moment_exponents[k], area));
                EXPECT_NEAR(m.normal[normal_index(axis, k)], w1 * n[static_cast<int>(axis)] * exact, 1e-15);
            }
        }
        EXPECT_NEAR(m.normal2[1], area * n.x * n.y, 1e-15);
        EXPECT_NEAR(m.normal2[3], area * n.y * n.y, 1e-15);
        EXPECT_NEAR(m.total_area, area, 1e-15);
        EXPECT_NEAR(m.normal_area, area, 1e-15);
    }
}

TEST(Moments, AreAdditive) {
    const test::Soup soup = test::saddle_patch(4);
    const Moments whole = soup.moments({});
    Moments sum, last;
    for (std::size_t t = 0; t < soup.size(); ++t) {
        last = {};
        accumulate(last, soup.corners[3 * t], soup.corners[3 * t + 1], soup.corners[3 * t + 2], soup.normals[t],
                   soup.areas[t]);
        sum += last;
    }
    expect_near(sum, whole, 1e-14);
    sum -= last;
    sum += last;
    expect_near(sum, whole, 1e-14);
}

TEST(Moments, ShiftedAreThoseAboutTheOtherOrigin) {
    const test::Soup soup = test::ellipsoid_patch(5, 1, 0.7, 0.5);
    Random random(2);
    for (int round = 0; round < 20; ++round) {
        const Vec3 from = random.vector(1), to = random.vector(1);
        expect_near(shifted(soup.moments(from), to - from), soup.moments(to), 2e-14);
    }
}

TEST(Moments, ScaledAreThoseOfTheScaledTriangles) {
    const test::Soup soup = test::ellipsoid_patch(5, 1, 0.7, 0.5);
    for (const double s : {0.1, 3.0}) {
        const Moments direct = soup.mapped([s](const Vec3& x) { return x * s; }).moments({});
        expect_near(scaled(soup.moments({}), s), direct, 1e-15 * direct.area[0] * 1e2 + 1e-13);
    }
}

TEST(Moments, SpreadIsCentroidAndRadius) {
    // A unit square: ∫|x − centroid|² = 1/6.
    const test::Soup square = test::patch(3, 0, 1, 0, 1, [](double u, double v) { return Vec3{u + 5, v - 2, 7}; });
    const Spread s = spread(square.moments({}));
    EXPECT_NEAR(s.centroid.x, 5.5, 1e-14);
    EXPECT_NEAR(s.centroid.y, -1.5, 1e-14);
    EXPECT_NEAR(s.centroid.z, 7, 1e-14);
    EXPECT_NEAR(s.radius, std::sqrt(1.0 / 6), 1e-13);
    EXPECT_EQ(spread(Moments{}).radius, 0);
}

TEST(Moments, OfFlatTrianglesAreFiniteAndZero) {
    Moments m;
    accumulate(m, {0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {}, 0);
    expect_near(m, Moments{}, 0);
}

TEST(SoupMoments, EqualThoseOfSingleTriangles) {
    for (const int n : {1, 3, 7}) {
        test::Soup soup = test::saddle_patch(n);
        soup.add({0, 0, 0}, {1, 1, 1}, {2, 2, 2});  // no area
        expect_near(soup_moments(soup.view(), {0.3, -0.2, 0.1}), soup.moments({0.3, -0.2, 0.1}), 1e-14);
    }
    expect_near(soup_moments({}, {}), Moments{}, 0);
}

TEST(MomentAccumulator, MayBeAskedInBetween) {
    const test::Soup soup = test::saddle_patch(4);
    MomentAccumulator sum;
    Moments direct;
    for (std::size_t t = 0; t < soup.size(); ++t) {
        const Vec3 &a = soup.corners[3 * t], &b = soup.corners[3 * t + 1], &c = soup.corners[3 * t + 2];
        sum.add(a, b, c, soup.normals[t], soup.areas[t]);
        accumulate(direct, a, b, c, soup.normals[t], soup.areas[t]);
        if (t % 3 == 0) expect_near(sum.moments(), direct, 1e-14);
    }
    expect_near(sum.moments(), direct, 1e-14);
    expect_near(MomentAccumulator().moments(), Moments{}, 0);
}

TEST(SoupMoments, IgnoreCornersOfFacesWithoutArea) {
    test::Soup soup = test::plane_patch(2);
    const Moments before = soup_moments(soup.view(), {});
    soup.add({NAN, 0, 0}, {0, INFINITY, 0}, {0, 0, 0});
    soup.areas.back() = 0;
    expect_near(soup_moments(soup.view(), {}), before, 0);
}

TEST(MomentBuffers, GiveTheWeightedSumsOfAnySubset) {
    test::Soup soup = test::ellipsoid_patch(13, 0.05, 0.03, 0.02);
    soup = soup.mapped([](const Vec3& x) { return x + Vec3{0.4, -0.3, 0.2}; });
    const std::vector<std::uint32_t> begin = {0, 1, 9, 9, 200, static_cast<std::uint32_t>(soup.size())};
    MomentBuffers buffers(begin);
    for (std::size_t b = 0; b + 1 < begin.size(); ++b) {
        const std::size_t first = begin[b], count = begin[b + 1] - first;
        const TriangleSoup all = soup.view();
        buffers.fill(b, {all.corners.subspan(3 * first, 3 * count), all.normals.subspan(first, count),
                         all.areas.subspan(first, count)});
    }
    ASSERT_EQ(buffers.block_count(), 5U);
    EXPECT_GT(buffers.bytes(), soup.size() * 300);

    Random random(3);
    const Vec3 origin{0.42, -0.29, 0.2};
    Moments whole;
    for (std::size_t b = 0; b < buffers.block_count(); ++b) {
        buffers.accumulate(whole, origin, b);
        const std::size_t size = buffers.block_size(b);
        for (int round = 0; round < 10 && size > 0; ++round) {
            const auto first = static_cast<std::size_t>(random.uniform(0, static_cast<double>(size)));
            const auto count = static_cast<std::size_t>(random.uniform(0, static_cast<double>(size - first) + 0.999));
            std::vector<double> w2(count), w1(count);
            Moments direct, streamed;
            for (std::size_t i = 0; i < count; ++i) {
                if (random.uniform(0, 1) < 0.3) continue;  // not in the region
                w1[i] = random.uniform(0.5, 2);
                w2[i] = w1[i] * w1[i];
                const std::size_t t = begin[b] + first + i;
                accumulate(direct, soup.corners[3 * t] - origin, soup.corners[3 * t + 1] - origin,
                           soup.corners[3 * t + 2] - origin, soup.normals[t], soup.areas[t], w2[i], w1[i]);
            }
            buffers.accumulate(streamed, origin, b, first, w2, w1);
            const double area = soup.area();
            for (std::size_t i = 0; i < 35; ++i) {
                const auto& e = moment_exponents[i];
                EXPECT_NEAR(streamed.area[i], direct.area[i], 1e-15 * area * std::pow(0.1, e[0] + e[1] + e[2])) << i;
            }
            for (std::size_t i = 0; i < 12; ++i) EXPECT_NEAR(streamed.normal[i], direct.normal[i], 1e-15 * area);
            for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(streamed.normal2[i], direct.normal2[i], 1e-15 * area);
            EXPECT_NEAR(streamed.total_area, direct.total_area, 1e-15 * area);
            EXPECT_NEAR(streamed.normal_area, direct.normal_area, 1e-15 * area);
        }
    }
    expect_near(whole, soup.moments(origin), 1e-17);
}

}  // namespace
}  // namespace quadseg::quadric
