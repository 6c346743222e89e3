#include "surface/median.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <vector>

namespace quadseg::surface {
namespace {

double median(const std::vector<double>& values) {
    std::vector<double> scratch(values.size());
    return median_magnitude(values.data(), values.size(), scratch.data());
}

double sorted_median(std::vector<double> values) {
    for (double& v : values) v = std::abs(v);
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

TEST(MedianMagnitude, IsTheMiddleOfTheSortedOnes) {
    std::mt19937_64 random(7);
    for (std::size_t n = 1; n < 3000; n = n < 70 ? n + 1 : n * 5 / 4) {
        std::vector<double> wide(n), equal(n, -2.5), few(n), rising(n), periodic(n);
        for (std::size_t i = 0; i < n; ++i) {
            wide[i] = std::exp(std::normal_distribution<>(0, 9)(random)) * (i % 3 == 0 ? -1 : 1);
            few[i] = static_cast<double>(random() % 3);
            rising[i] = static_cast<double>(i);
            // The sample sees the small values alone.
            periodic[i] = i * 24 % n < 24 ? 1e-9 : 1 + static_cast<double>(i);
        }
        for (const std::vector<double>& values : {wide, equal, few, rising, periodic}) {
            EXPECT_EQ(median(values), sorted_median(values)) << n;
        }
    }
}

TEST(MedianMagnitude, InfinityCountsAndNoNumberMakesItInfinite) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    for (const std::size_t n : {std::size_t{5}, std::size_t{16}, std::size_t{500}}) {
        std::vector<double> values(n, 1.0);
        for (std::size_t i = 0; i < n / 2; ++i) values[i] = -infinity;
        EXPECT_EQ(median(values), sorted_median(values)) << n;
        values[n / 2] = infinity;
        EXPECT_EQ(median(values), infinity) << n;
        values.assign(n, 1.0);
        values[n / 3] = std::numeric_limits<double>::quiet_NaN();
        EXPECT_EQ(median(values), infinity) << n;
    }
    EXPECT_EQ(median({}), 0);
}

}  // namespace
}  // namespace quadseg::surface
