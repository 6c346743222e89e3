// What free-form faces show by chance is given back, what somebody meant is kept.
#include "exact/release.h"

#include "mesh/work_mesh.h"
#include "tests/partition/box.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>

namespace quadseg::exact {
namespace {

constexpr std::uint32_t cells = 24;
constexpr double noise = 1e-15;

/// z = height(x, y) over [−1, 1]², two triangles a cell, row by row along x.
template <class Height>
test::Shape sheet(const Height& height) {
    test::Shape s;
    const auto at = [](std::uint32_t i) { return 2.0 * i / cells - 1; };
    for (std::uint32_t j = 0; j <= cells; ++j) {
        for (std::uint32_t i = 0; i <= cells; ++i) s.vertex(at(i), at(j), height(at(i), at(j)));
    }
    for (std::uint32_t j = 0; j < cells; ++j) {
        for (std::uint32_t i = 0; i < cells; ++i) {
            const std::uint32_t v = j * (cells + 1) + i;
            s.quad(v, v + 1, v + cells + 2, v + cells + 1);
        }
    }
    return s;
}

double wavy(double x, double y) {
    return 0.1 * std::sin(2 * x) * std::cos(1.5 * y);
}

/// How many of the faces `chosen` (by their number in the input) stay in a region of that type; all others are free.
template <class Height, class Chosen>
std::size_t kept(const Height& height, SurfaceType type, const Chosen& chosen) {
    const test::Shape shape = sheet(height);
    const runtime::RunControl control(nullptr);
    const mesh::WorkMesh mesh = mesh::build_work_mesh(shape.view(), control);
    const Scene scene = build_scene(mesh, control);
    Explained state;
    Surface surface;
    surface.type = type;
    state.add(surface);
    for (std::size_t f = 0; f < mesh.face_count(); ++f) state.region.push_back(chosen(mesh.input_face[f]) ? 0 : -1);
    release_crumbs(scene, noise, state);
    std::size_t count = 0;
    for (const std::int32_t r : state.region) count += r >= 0 ? 1 : 0;
    return count;
}

/// Faces of a square of cells in the middle.
auto square(std::uint32_t size) {
    return [size](std::uint32_t face) {
        const std::uint32_t i = face / 2 % cells, j = face / 2 / cells;
        return i >= cells / 2 && i < cells / 2 + size && j >= cells / 2 && j < cells / 2 + size;
    };
}

TEST(ReleaseCrumbs, ATriangleAmidFreeFacesIsNoPlane) {
    EXPECT_EQ(kept(wavy, SurfaceType::plane, [](std::uint32_t face) { return face == cells * cells; }), 0U);
}

TEST(ReleaseCrumbs, AFlatPlaceOfAFreeFormFaceIsNoPlane) {
    EXPECT_EQ(kept(wavy, SurfaceType::plane, square(3)), 0U);
}

TEST(ReleaseCrumbs, AnExactPlaneThatGoesOnSmoothlyStays) {
    const auto flat_then_rising = [](double x, double) { return x > 0 ? 0.1 * x * x : 0; };
    const auto flat = [](std::uint32_t face) { return face / 2 % cells < cells / 2; };
    EXPECT_EQ(kept(flat_then_rising, SurfaceType::plane, flat), std::size_t{cells} * cells);
    // Smooth on all sides, and few.
    const auto flat_square = [](double x, double y) {
        const auto outside = [](double t) { return std::max({0.0, -t, t - 0.25}); };
        return 0.1 * (outside(x) * outside(x) + outside(y) * outside(y));
    };
    EXPECT_EQ(kept(flat_square, SurfaceType::plane, square(3)), 18U);
}

TEST(ReleaseCrumbs, ATorusOfFewFacetsAmidFreeFacesIsNone) {
    EXPECT_EQ(kept(wavy, SurfaceType::torus, square(3)), 0U);
    EXPECT_EQ(kept(wavy, SurfaceType::torus, square(8)), 128U);
}

TEST(ReleaseCrumbs, AcrossSharpEdgesNothingGoesOn) {
    // A block of one cell that stands out of the sheet by its own width.
    const auto block = [](double x, double y) {
        return wavy(x, y) + (std::abs(x - 0.125) < 0.13 && std::abs(y - 0.125) < 0.13 ? 0.4 : 0);
    };
    EXPECT_EQ(kept(block, SurfaceType::plane, square(3)), 18U);
}

}  // namespace
}  // namespace quadseg::exact
