#include "flow/faceted.h"

#include <quadseg/segmentation.h>

#include "runtime/parallel.h"
#include "tests/partition/box.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace quadseg {
namespace {

const runtime::RunControl free_run(nullptr);

/// A prism of n sides with a cap on top, as a remesher leaves it: every side cut into columns and rows of triangles
/// whose vertices lie on the side, not on the cylinder around.
test::Shape remeshed_prism(std::uint32_t n, std::uint32_t columns, std::uint32_t rows) {
    test::Shape s;
    const std::uint32_t around = n * columns;
    const auto corner = [&](std::uint32_t i) {
        const double t = 2 * std::numbers::pi * i / n;
        return Vec3{std::cos(t), std::sin(t), 0};
    };
    for (std::uint32_t j = 0; j <= rows; ++j) {
        for (std::uint32_t i = 0; i < around; ++i) {
            const double x = double(i % columns) / columns;
            const Vec3 p = corner(i / columns) * (1 - x) + corner(i / columns + 1) * x;
            // Inner vertices stand irregularly.
            const double shift = j > 0 && j < rows ? 0.3 * std::sin(7. * i + 3. * j) : 0;
            s.vertex(p.x, p.y, 2.0 * (j + shift) / rows);
        }
    }
    for (std::uint32_t j = 0; j < rows; ++j) {
        for (std::uint32_t i = 0; i < around; ++i) {
            const std::uint32_t k = (i + 1) % around;
            s.quad(j * around + i, j * around + k, (j + 1) * around + k, (j + 1) * around + i);
        }
    }
    const std::uint32_t centre = s.vertex(0, 0, 2);
    for (std::uint32_t i = 0; i < around; ++i) s.face(rows * around + i, rows * around + (i + 1) % around, centre);
    return s;
}

std::size_t flagged(const test::Shape& shape, partition::Labels labels, const std::vector<Surface>& surfaces) {
    const mesh::WorkMesh mesh = test::work_mesh(shape);
    const Options options;
    const mesh::FeatureEdges creases = mesh::find_feature_edges(mesh, 30, free_run);
    labels.resize(mesh.face_count(), -1);
    const auto flags = flow::find_faceted({mesh, nullptr, options, free_run}, creases, surfaces, labels);
    for (std::size_t f = 0; f < flags.size(); ++f) {
        if (flags[f] != 0) {
            EXPECT_EQ(labels[f], -1);
        }
    }
    return static_cast<std::size_t>(std::count(flags.begin(), flags.end(), 1));
}

TEST(Faceted, ARemeshedCylinderIsOneRegion) {
    for (const std::uint32_t sides : {24U, 36U, 60U}) {
        const Segmentation result = segment(remeshed_prism(sides, 5, 24).view());
        ASSERT_EQ(result.regions.size(), 2U) << sides;
        const Region& wall = result.regions[result.regions[0].surface.type == SurfaceType::plane ? 1 : 0];
        EXPECT_EQ(wall.surface.type, SurfaceType::cylinder);
        EXPECT_LE(wall.surface.radius, 1);
        EXPECT_GE(wall.surface.radius, std::cos(std::numbers::pi / sides));
        EXPECT_EQ(wall.faces, std::size_t{sides} * 5 * 24 * 2);
        EXPECT_LT(wall.rms, 1 - std::cos(std::numbers::pi / sides));
    }
}

TEST(Standard, AMeshWithoutExactSurfacesIsNamedByWhatExplainsIt) {
    test::Shape dented = test::capped_cylinder(120, 40);
    for (std::size_t v = 0; v + 1 < dented.positions.size() / 3; ++v) {  // not the middle of the lid
        double* p = &dented.positions[3 * v];
        const double t = std::atan2(p[1], p[0]), factor = 1 + 5e-3 * std::sin(5 * t) * std::sin(4 * p[2]);
        p[0] *= factor;
        p[1] *= factor;
        p[2] += 5e-3 * std::sin(5 * p[0]) * std::cos(4 * p[1]);
    }
    const Segmentation result = segment(dented.view());
    double named = 0;
    for (const Region& region : result.regions) {
        if (region.surface.type != SurfaceType::freeform) named += region.area;
    }
    EXPECT_GT(named, 0.9 * result.input.area);
}

TEST(Faceted, SidesThatMeetAtCreasesArePlanes) {
    const Segmentation result = segment(remeshed_prism(6, 12, 12).view());
    ASSERT_EQ(result.regions.size(), 7U);
    for (const Region& region : result.regions) EXPECT_EQ(region.surface.type, SurfaceType::plane);
}

TEST(Faceted, FoldsOfTwoKindsTellFacetsFromASmoothSurface) {
    const test::Shape remeshed = remeshed_prism(30, 5, 20);
    EXPECT_EQ(flagged(remeshed, {}, {}), 30U * 5 * 20 * 2);
    // Bumps of a smooth mesh: folds of all sizes.
    test::Shape bumps;
    constexpr std::uint32_t n = 60;
    for (std::uint32_t j = 0; j <= n; ++j) {
        for (std::uint32_t i = 0; i <= n; ++i) {
            const double x = double(i) / n, y = double(j) / n;
            bumps.vertex(x, y, 0.05 * std::sin(7 * x + 3 * y) * std::cos(5 * y));
        }
    }
    for (std::uint32_t j = 0; j < n; ++j) {
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t a = j * (n + 1) + i;
            bumps.quad(a, a + 1, a + n + 2, a + n + 1);
        }
    }
    EXPECT_EQ(flagged(bumps, {}, {}), 0U);
}

TEST(Faceted, AWidePlaneBesideFacetsStays) {
    // Were no edge a crease, the cap would pass smoothly into facets all around: much wider than they, it is none.
    constexpr std::uint32_t sides = 36, columns = 4, rows = 16;
    test::Shape s = remeshed_prism(sides, columns, rows);
    const mesh::WorkMesh mesh = test::work_mesh(s);
    partition::Labels labels(mesh.face_count(), -1);
    for (std::size_t f = 0; f < labels.size(); ++f) labels[f] = mesh.normals[f].z > 0.9 ? 0 : -1;
    Surface plane;
    plane.type = SurfaceType::plane;
    const Options options;
    const mesh::FeatureEdges no_creases(mesh.face_count(), 0);
    partition::Labels explained = labels;
    const auto flags = flow::find_faceted({mesh, nullptr, options, free_run}, no_creases, {plane}, explained);
    EXPECT_EQ(explained, labels);
    for (std::size_t f = 0; f < flags.size(); ++f) EXPECT_EQ(flags[f] != 0, labels[f] < 0);
}

}  // namespace
}  // namespace quadseg
