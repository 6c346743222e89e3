#include "partition/regions.h"

#include <gtest/gtest.h>
#include <vector>

namespace quadseg {
namespace {

using partition::Labels;

TEST(Regions, AreRenumberedByFirstFaceOrInTheirOrder) {
    const Labels before = {5, 2, -1, 5, 7, 2};
    Labels by_face = before, in_order = before;
    std::vector<std::int32_t> renumbered;
    EXPECT_EQ(partition::compact(by_face, renumbered), 3U);
    EXPECT_EQ(by_face, (Labels{0, 1, -1, 0, 2, 1}));
    EXPECT_EQ(renumbered, (std::vector<std::int32_t>{-1, -1, 1, -1, -1, 0, -1, 2}));
    EXPECT_EQ(partition::close_gaps(in_order, renumbered), 3U);
    EXPECT_EQ(in_order, (Labels{1, 0, -1, 1, 2, 0}));
    EXPECT_EQ(renumbered, (std::vector<std::int32_t>{-1, -1, 0, -1, -1, 1, -1, 2}));
}

TEST(Regions, NoneAndUnlabelledFaces) {
    Labels none, unlabelled = {-1, -1};
    EXPECT_EQ(partition::compact(none), 0U);
    EXPECT_EQ(partition::close_gaps(none), 0U);
    EXPECT_EQ(partition::close_gaps(unlabelled), 0U);
    EXPECT_EQ(unlabelled, (Labels{-1, -1}));
}

TEST(Regions, HaveTheirFacesInAscendingOrder) {
    const partition::RegionFaces faces = partition::region_faces({1, 0, 1, -1, 1}, 3);
    EXPECT_EQ(faces.count(), 3U);
    EXPECT_EQ(faces.begin, (std::vector<std::uint32_t>{0, 1, 4, 4}));
    EXPECT_EQ(faces.face, (std::vector<std::uint32_t>{1, 0, 2, 4}));
}

}  // namespace
}  // namespace quadseg
