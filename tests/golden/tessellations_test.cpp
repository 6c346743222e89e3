// What the tessellators of CAD systems make of simple faces, and what has been taken for something else: long faces
// from rim to rim, flats without a vertex inside, trim curves that are off their surfaces.
#include <quadseg/segmentation.h>

#include "tests/mesh/shapes.h"
#include "tests/pipeline/result_checks.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>
#include <numbers>
#include <numeric>
#include <vector>

namespace quadseg::test {
namespace {

using Ring = std::vector<std::uint32_t>;

/// count vertices at radius(t), height(t), t a full turn.
template <class Radius, class Height>
Ring ring(Shape& s, std::uint32_t count, const Radius& radius, const Height& height) {
    Ring vertices;
    for (std::uint32_t i = 0; i < count; ++i) {
        const double t = 2 * std::numbers::pi * i / count;
        vertices.push_back(s.vertex(radius(t) * std::cos(t), radius(t) * std::sin(t), height(t)));
    }
    return vertices;
}

Ring circle(Shape& s, std::uint32_t count, double radius, double height) {
    return ring(
        s, count, [&](double) { return radius; }, [&](double) { return height; });
}

void band(Shape& s, const Ring& lower, const Ring& upper) {
    for (std::size_t i = 0; i < lower.size(); ++i) {
        const std::size_t j = (i + 1) % lower.size();
        s.quad(lower[i], lower[j], upper[j], upper[i]);
    }
}

/// A flat, without a vertex inside.
void lid(Shape& s, const Ring& rim) {
    for (std::size_t i = 1; i + 1 < rim.size(); ++i) s.face(rim[0], rim[i], rim[i + 1]);
}
void floor(Shape& s, Ring rim) {
    std::reverse(rim.begin(), rim.end());
    lid(s, rim);
}

Segmentation sound(const Shape& shape) {
    const MeshView mesh = shape.view();
    Segmentation s = segment(mesh);
    EXPECT_EQ(broken_rule(mesh, s), "");
    return s;
}

std::size_t count(const Segmentation& s, SurfaceType type) {
    return static_cast<std::size_t>(
        std::count_if(s.regions.begin(), s.regions.end(), [&](const Region& r) { return r.surface.type == type; }));
}

/// A bar of so many sides, its end turned down to .6 of its radius at `slope` of the difference.
Segmentation pointed_bar(std::uint32_t sides, double slope) {
    Shape s;
    const Ring foot = circle(s, sides, 1, 0), shoulder = circle(s, sides, 1, 5);
    const Ring point = circle(s, sides, 0.6, 5 + 0.4 * slope);
    band(s, foot, shoulder);
    band(s, shoulder, point);
    lid(s, point);
    floor(s, foot);
    return sound(s);
}

TEST(Tessellations, ThePointOfAHexagonalBarIsNoCone) {
    const Segmentation found = pointed_bar(6, std::cos(std::numbers::pi / 6));  // slopes of 45 degrees
    EXPECT_EQ(found.regions.size(), 14U);
    EXPECT_EQ(count(found, SurfaceType::plane), 14U);
}

TEST(Tessellations, ThePointOfARoundBarOfTwelveFacetsIsACone) {
    const Segmentation found = pointed_bar(12, 1);
    EXPECT_EQ(found.regions.size(), 4U);
    EXPECT_EQ(count(found, SurfaceType::cone), 1U);
    EXPECT_EQ(count(found, SurfaceType::cylinder), 1U);
}

TEST(Tessellations, AFlatThatATorusIsTangentToIsNoPartOfIt) {
    constexpr std::uint32_t sectors = 60, rows = 10;
    Shape s;
    const auto at = [&](std::uint32_t j) {
        const double a = std::numbers::pi / 2 * j / rows;
        return circle(s, sectors, 2 + std::cos(a), std::sin(a));
    };
    Ring lower = at(0);
    floor(s, lower);
    for (std::uint32_t j = 1; j <= rows; ++j) {
        const Ring upper = at(j);
        band(s, lower, upper);
        lower = upper;
    }
    lid(s, lower);
    const Segmentation found = sound(s);
    EXPECT_EQ(found.regions.size(), 3U);
    EXPECT_EQ(count(found, SurfaceType::plane), 2U);
    EXPECT_EQ(count(found, SurfaceType::torus), 1U);
}

TEST(Tessellations, AFlatThatAFreeFormFilletIsTangentToIsAPlane) {
    constexpr std::uint32_t sectors = 96, rows = 16;
    Shape s;
    const auto at = [&](std::uint32_t j) {
        const double d = 1.0 * j / rows;
        return ring(
            s, sectors, [&](double t) { return 2 + d * (1 + 0.1 * std::sin(2 * t)); },
            [&](double t) { return -d * d * (1.5 + 0.5 * std::cos(3 * t)); });
    };
    std::vector<Ring> rings;
    for (std::uint32_t j = 0; j <= rows; ++j) rings.push_back(at(j));
    lid(s, rings.front());
    const std::size_t flat = s.faces();
    for (std::uint32_t j = 0; j < rows; ++j) band(s, rings[j + 1], rings[j]);
    const Segmentation found = sound(s);
    const Region& plane = found.regions[static_cast<std::size_t>(found.labels[0])];
    EXPECT_EQ(plane.surface.type, SurfaceType::plane);
    EXPECT_EQ(plane.faces, flat);
    for (std::size_t f = 0; f < flat; ++f) EXPECT_EQ(found.labels[f], found.labels[0]) << "face " << f;
}

TEST(Tessellations, AFlatWhoseEdgesLieOnAShaftIsNoFacetOfIt) {
    Shape s;
    const auto at = [&](double height) {
        Ring rim;
        for (int degrees = 0; degrees < 360; degrees += 5) {
            if (degrees > 0 && degrees < 30) continue;  // the flat
            const double t = degrees * std::numbers::pi / 180;
            rim.push_back(s.vertex(std::cos(t), std::sin(t), height));
        }
        return rim;
    };
    const Ring foot = at(0), top = at(3);
    band(s, foot, top);
    lid(s, top);
    floor(s, foot);
    const Segmentation found = sound(s);
    EXPECT_EQ(found.regions.size(), 4U);
    EXPECT_EQ(count(found, SurfaceType::plane), 3U);
    EXPECT_EQ(count(found, SurfaceType::cylinder), 1U);
    EXPECT_NE(found.labels[0], found.labels[2]);
}

TEST(Tessellations, ACylinderGoesOnToATrimCurveThatIsOff) {
    constexpr std::uint32_t sectors = 60;
    constexpr double off = 4e-4;  // of the radius: 1e-4 of the diagonal
    Shape s;
    const Ring foot = circle(s, sectors, 1, 0), middle = circle(s, sectors, 1, 2);
    const Ring trim = ring(
        s, sectors, [&](double t) { return 1 + off * std::sin(7.3 * t); },
        [](double t) { return 2.3 + 0.2 * std::cos(2 * t); });
    floor(s, foot);
    band(s, foot, middle);
    band(s, middle, trim);
    const Segmentation found = sound(s);
    const std::int32_t wall = found.labels[sectors];
    EXPECT_EQ(found.regions[static_cast<std::size_t>(wall)].surface.type, SurfaceType::cylinder);
    const auto on_wall = std::count(found.labels.begin(), found.labels.end(), wall);
    EXPECT_GE(on_wall, 4 * sectors - 6);
}

}  // namespace
}  // namespace quadseg::test
