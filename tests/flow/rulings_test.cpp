#include "flow/rulings.h"

#include "mesh/connected.h"
#include "tests/mesh/wall.h"
#include "tests/partition/box.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace quadseg::test {
namespace {

struct Cut {
    std::size_t ruled = 0, parts = 0;
};

Cut cut_at_rulings(const Shape& shape) {
    const runtime::RunControl control(nullptr);
    const mesh::WorkMesh mesh = work_mesh(shape);
    const std::vector<std::uint8_t> all(mesh.face_count(), 1);
    const flow::Rulings rulings = flow::find_rulings(mesh, mesh::FeatureEdges(mesh.face_count(), 0), all, control);
    std::vector<std::int32_t> part;
    Cut cut;
    cut.ruled = static_cast<std::size_t>(std::count(rulings.ruled.begin(), rulings.ruled.end(), 1));
    cut.parts = mesh::connected_faces(
        mesh, [](std::size_t) { return true; },
        [&](std::size_t f, std::size_t k, std::size_t) { return (rulings.borders[f] >> k & 1) == 0; }, [] {}, part);
    return cut;
}

TEST(Rulings, RowsThatAgreeOnlyAtABorderShowIt) {
    const Shape smooth = wall(0, 11, 9);
    const Cut cut = cut_at_rulings(smooth);
    EXPECT_EQ(cut.ruled, smooth.faces());
    EXPECT_EQ(cut.parts, 2U);
}

TEST(Rulings, EvenRowsAreCutAtKinks) {
    EXPECT_EQ(cut_at_rulings(wall(0.2, 12, 12)).parts, 2U);
    EXPECT_EQ(cut_at_rulings(wall(0, 12, 12)).parts, 1U);
    EXPECT_EQ(cut_at_rulings(wall(0, 12, 12)).ruled, 0U);  // it may have borders without a kink
}

TEST(Rulings, RowsThatWereMovedSayNothing) {
    Shape moved = wall(0, 12, 24);  // a row at every vertex of the lower rim, and facets that tilt
    EXPECT_EQ(cut_at_rulings(moved).ruled, moved.faces());
    for (std::size_t i = 0; i < moved.positions.size(); i += 3)
        moved.positions[i] += 3e-5 * std::sin(static_cast<double>(i));  // along the profile
    const Cut cut = cut_at_rulings(moved);
    EXPECT_EQ(cut.ruled, 0U);
    EXPECT_EQ(cut.parts, 1U);
}

TEST(Rulings, OtherSurfacesHaveNone) {
    for (const Shape& shape : {bumpy_grid(20), box(3)}) {
        const Cut cut = cut_at_rulings(shape);
        EXPECT_EQ(cut.ruled, 0U);
        EXPECT_EQ(cut.parts, 1U);
    }
}

}  // namespace
}  // namespace quadseg::test
