#include "bench/support/statistics.h"

#include <gtest/gtest.h>

namespace quadseg::bench {
namespace {

TEST(Spread, MedianOfOddAndEvenNumbers) {
    EXPECT_EQ(spread({3, 1, 2}).median, 2);
    EXPECT_EQ(spread({4, 1, 2, 3}).median, 2.5);
    EXPECT_EQ(spread({4, 1, 2, 3}).min, 1);
    EXPECT_EQ(spread({4, 1, 2, 3}).max, 4);
    EXPECT_EQ(spread({}).median, 0);
}

TEST(PowerLaw, FindsExponentAndFactor) {
    std::vector<double> x, y;
    for (double v = 10; v < 1e7; v *= 3) {
        x.push_back(v);
        y.push_back(2e-6 * std::pow(v, 1.07));
    }
    const PowerLaw law = power_law(x, y);
    EXPECT_NEAR(law.exponent, 1.07, 1e-12);
    EXPECT_NEAR(law.factor, 2e-6, 1e-15);
}

TEST(PowerLaw, LeavesOutWhatHasNoLogarithm) {
    const std::vector<double> x{0, 1, 2, 4}, y{5, 3, 6, 12};
    EXPECT_NEAR(power_law(x, y).exponent, 1, 1e-12);
}

TEST(PowerLaw, OneSizeTellsNothing) {
    const std::vector<double> x{10, 10, 10}, y{1, 2, 3};
    EXPECT_EQ(power_law(x, y).exponent, 0);
    EXPECT_EQ(power_law({}, {}).exponent, 0);
}

}  // namespace
}  // namespace quadseg::bench
