#include "quadric/energy_batch.h"

#include "tests/quadric/shapes.h"

#include <gtest/gtest.h>
#include <limits>
#include <vector>

namespace quadseg::quadric {
namespace {

using test::Random;

constexpr double weight = 0.5;

struct Pair {
    Proxy proxy;
    Vec3 v[3], n;
    double area = 0;
    double energy() const { return triangle_energy(proxy, v[0], v[1], v[2], n, area).hybrid(weight); }
};

Vec3 random_point(Random& random) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
    return {x, y, z};
}

/// Every third proxy is a plane, every seventh triangle has no area.
std::vector<Pair> random_pairs(std::size_t count) {
    Random random(11);
    std::vector<Pair> pairs(count);
    for (std::size_t i = 0; i < count; ++i) {
        Pair& p = pairs[i];
        const Vec3 centre = 5 * random_point(random);
        for (Vec3& v : p.v) v = centre + random_point(random);
        const Vec3 n = cross(p.v[1] - p.v[0], p.v[2] - p.v[0]);
        p.n = normalized(n);
        p.area = i % 7 == 0 ? 0 : norm(n) / 2;
        if (i % 3 == 0) {
            p.proxy = plane_proxy(centre, random_point(random));
        } else {
            p.proxy.origin = centre;
            for (double& c : p.proxy.c) c = random.uniform(-1, 1);
            p.proxy.gradient_floor = 0.05;
        }
    }
    return pairs;
}

std::size_t add(EnergyBatch& batch, const Pair& p) {
    return batch.add(p.proxy, p.v[0], p.v[1], p.v[2], p.n, p.area);
}

TEST(EnergyBatch, HasTheEnergiesOfTheSingleTriangles) {
    const std::vector<Pair> pairs = random_pairs(EnergyBatch::capacity);
    for (const std::size_t count : {std::size_t{1}, std::size_t{8}, std::size_t{13}, EnergyBatch::capacity}) {
        EnergyBatch batch(weight);
        for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(add(batch, pairs[i]), i);
        batch.evaluate();
        for (std::size_t i = 0; i < count; ++i) {
            const double expected = pairs[i].energy();
            EXPECT_NEAR(batch.hybrid(i), expected, 1e-13 * (1 + expected)) << i;
        }
    }
}

TEST(EnergyBatch, APairHasOneValueInEveryLaneAndCompany) {
    const std::vector<Pair> pairs = random_pairs(64);
    EnergyBatch alone(weight), together(weight);
    for (const Pair& p : pairs) (void)add(together, p);
    together.evaluate();
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        alone.clear();
        const std::size_t pair = add(alone, pairs[i]);
        alone.evaluate();
        EXPECT_EQ(alone.hybrid(pair), together.hybrid(i)) << i;
    }
}

TEST(EnergyBatch, LanesLeftOverFromBeforeDoNotMatter) {
    std::vector<Pair> pairs = random_pairs(9);
    Pair broken = pairs[1];
    broken.v[0].x = std::numeric_limits<double>::infinity();
    EnergyBatch batch(weight);
    for (int i = 0; i < 16; ++i) (void)add(batch, broken);
    batch.evaluate();
    batch.clear();
    for (const Pair& p : pairs) (void)add(batch, p);
    batch.evaluate();
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        EXPECT_NEAR(batch.hybrid(i), pairs[i].energy(), 1e-13 * (1 + pairs[i].energy()));
    }
}

}  // namespace
}  // namespace quadseg::quadric
