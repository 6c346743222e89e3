#include "mesh/group_sums.h"

#include <gtest/gtest.h>
#include <random>
#include <vector>

namespace quadseg::mesh {
namespace {

TEST(AddByGroup, AddsInTheOrderOfTheFaces) {
    std::mt19937_64 random(3);
    std::vector<std::int32_t> group(1000);
    std::vector<double> values(group.size());
    for (std::size_t i = 0; i < group.size(); ++i) {
        group[i] = i > 0 && random() % 4 != 0 ? group[i - 1] : static_cast<std::int32_t>(random() % 6) - 1;
        values[i] = std::uniform_real_distribution<>(0, 1)(random);
    }
    std::vector<double> sums(5, 0.5), expected = sums;
    for (std::size_t i = 0; i < group.size(); ++i) {
        if (group[i] >= 0) expected[static_cast<std::size_t>(group[i])] += values[i];
    }
    add_by_group(group, values, sums);
    EXPECT_EQ(sums, expected);  // to the last bit
    add_by_group({}, {}, sums);
    EXPECT_EQ(sums, expected);
}

}  // namespace
}  // namespace quadseg::mesh
