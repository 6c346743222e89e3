// The default preset finds the surfaces of simple solids: how many, which types, which sizes, in input order.
#include <quadseg/segmentation.h>

#include "tests/golden/shapes.h"
#include "tests/pipeline/result_checks.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace quadseg::test {
namespace {

Segmentation sound(const MeshView& mesh, const Options& options = {}) {
    Segmentation s = segment(mesh, options);
    EXPECT_EQ(broken_rule(mesh, s), "");
    EXPECT_FALSE(s.partial);
    return s;
}

std::size_t count(const Segmentation& s, SurfaceType type) {
    return static_cast<std::size_t>(
        std::count_if(s.regions.begin(), s.regions.end(), [&](const Region& r) { return r.surface.type == type; }));
}

const Surface& only(const Segmentation& s, SurfaceType type) {
    return std::find_if(s.regions.begin(), s.regions.end(), [&](const Region& r) { return r.surface.type == type; })
        ->surface;
}

/// Faces [begin, end) of one flat side have one label.
void expect_one_label(const Segmentation& s, std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) EXPECT_EQ(s.labels[f], s.labels[begin]) << "face " << f;
}

class Boxes : public testing::TestWithParam<std::uint32_t> {};

TEST_P(Boxes, HaveSixPlanesInInputOrder) {
    const std::uint32_t n = GetParam();
    const Shape shape = box(n);
    const Segmentation s = sound(shape.view());
    ASSERT_EQ(s.regions.size(), 6U);
    EXPECT_EQ(count(s, SurfaceType::plane), 6U);
    std::set<std::int32_t> sides;
    for (std::size_t side = 0; side < 6; ++side) {
        expect_one_label(s, side * 2 * n * n, (side + 1) * 2 * n * n);
        sides.insert(s.labels[side * 2 * n * n]);
    }
    EXPECT_EQ(sides.size(), 6U);
    EXPECT_LE(s.max, 1e-12);
}

TEST_P(Boxes, WithoutALidHaveFive) {
    const Shape shape = cup(GetParam());
    const Segmentation s = sound(shape.view());
    EXPECT_EQ(s.regions.size(), 5U);
    EXPECT_EQ(count(s, SurfaceType::plane), 5U);
}

TEST_P(Boxes, AreBoxesToThePaperToo) {
    Options options;
    options.preset = Preset::paper;
    options.regions = 6;
    const Shape shape = box(GetParam());
    const Segmentation s = sound(shape.view(), options);
    EXPECT_EQ(s.regions.size(), 6U);
}

TEST_P(Boxes, TwoApartHaveTwelve) {
    const Shape shape = joined(box(GetParam()), box(GetParam(), 3));
    const Segmentation s = sound(shape.view());
    EXPECT_EQ(s.regions.size(), 12U);
    EXPECT_EQ(count(s, SurfaceType::plane), 12U);
    EXPECT_EQ(s.input.components, 2U);
}

TEST_P(Boxes, ShapedLikeAnLHaveEight) {
    const Shape shape = l_block(GetParam());
    const Segmentation s = sound(shape.view());
    EXPECT_EQ(s.regions.size(), 8U);
    EXPECT_EQ(count(s, SurfaceType::plane), 8U);
}

INSTANTIATE_TEST_SUITE_P(SquaresASide, Boxes, testing::Values(1U, 2U, 4U, 8U, 16U));

struct Facets {
    std::uint32_t sectors, rows;
};

void PrintTo(const Facets& f, std::ostream* out) {
    *out << f.sectors << "x" << f.rows;
}

class Round : public testing::TestWithParam<Facets> {};

TEST_P(Round, CylindersHaveTheirRadius) {
    const Shape shape = can(GetParam().sectors, GetParam().rows, 1.25, 3);
    const Segmentation s = sound(shape.view());
    ASSERT_EQ(s.regions.size(), 3U);
    ASSERT_EQ(count(s, SurfaceType::cylinder), 1U);
    EXPECT_EQ(count(s, SurfaceType::plane), 2U);
    const Surface& c = only(s, SurfaceType::cylinder);
    EXPECT_NEAR(c.radius, 1.25, 1e-9);
    EXPECT_NEAR(std::abs(c.axis[2]), 1, 1e-12);
    EXPECT_TRUE(c.outward);
}

TEST_P(Round, ConesHaveTheirApex) {
    const Shape shape = frustum(GetParam().sectors, GetParam().rows);
    const Segmentation s = sound(shape.view());
    ASSERT_EQ(s.regions.size(), 3U);
    ASSERT_EQ(count(s, SurfaceType::cone), 1U);
    const Surface& c = only(s, SurfaceType::cone);
    EXPECT_NEAR(c.half_angle, std::atan2(1.0, 1.5), 1e-9);
    EXPECT_NEAR(c.point[2], 3, 1e-8);
    EXPECT_NEAR(c.axis[2], -1, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Tessellations, Round,
                         testing::Values(Facets{8, 1}, Facets{8, 3}, Facets{12, 1}, Facets{12, 4}, Facets{16, 1},
                                         Facets{16, 6}, Facets{32, 1}, Facets{32, 8}));

class Balls : public testing::TestWithParam<Facets> {};

TEST_P(Balls, AreOneSphere) {
    const Shape shape = ball(GetParam().sectors, GetParam().rows);
    const Segmentation s = sound(shape.view());
    ASSERT_EQ(s.regions.size(), 1U);
    EXPECT_EQ(s.regions[0].surface.type, SurfaceType::sphere);
    EXPECT_NEAR(s.regions[0].surface.radius, 1, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Tessellations, Balls, testing::Values(Facets{12, 6}, Facets{16, 8}, Facets{32, 16}));

}  // namespace
}  // namespace quadseg::test
