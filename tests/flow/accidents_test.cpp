#include "flow/accidents.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace quadseg::flow {
namespace {

TEST(Accidents, SmallSurfacesGoLargeOnesStay) {
    partition::Labels labels(300, -1);
    std::fill_n(labels.begin(), 100, 2);
    std::fill_n(labels.begin() + 100, 63, 0);
    std::fill_n(labels.begin() + 200, 64, 5);
    partition::Labels expected = labels;
    std::fill_n(expected.begin() + 100, 63, -1);
    release_accidents(labels);
    EXPECT_EQ(labels, expected);
}

TEST(Accidents, NothingMayBeLabelled) {
    partition::Labels none(10, -1), empty;
    release_accidents(none);
    release_accidents(empty);
    EXPECT_EQ(none, partition::Labels(10, -1));
    EXPECT_TRUE(empty.empty());
}

}  // namespace
}  // namespace quadseg::flow
