#include "exact/exact.h"

#include "datasets/generate.h"
#include "mesh/work_mesh.h"
#include "runtime/parallel.h"
#include "tests/mesh/wall.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <utility>

namespace quadseg::exact {
namespace {

struct Found {
    ExactSurfaces surfaces;
    std::vector<std::int32_t> labels;  ///< input order
    double agreement = 0;              ///< share of labelled faces whose region's majority surface is their own
    std::size_t regions = 0;
};

Found run(const datasets::Generated& part, int threads = 0) {
    Found found;
    const runtime::RunControl control(nullptr);
    runtime::in_arena(threads, [&] {
        const mesh::WorkMesh mesh = mesh::build_work_mesh(part.mesh.view(), control);
        found.surfaces = find_exact_surfaces(mesh, control);
        found.labels = mesh::labels_to_input(mesh, found.surfaces.labels);
    });
    std::map<std::int32_t, std::map<std::int32_t, std::size_t>> overlap;
    for (std::size_t f = 0; f < found.labels.size(); ++f) ++overlap[found.labels[f]][part.truth[f]];
    std::size_t right = 0, labelled = 0;
    std::set<std::int32_t> truths;
    for (const auto& [label, counts] : overlap) {
        if (label < 0) continue;
        ++found.regions;
        for (const auto& [truth, count] : counts) labelled += count;
        std::size_t best = 0;
        std::int32_t surface = -1;
        for (const auto& [truth, count] : counts) {
            if (count > best) {
                best = count;
                surface = truth;
            }
        }
        if (truths.insert(surface).second) right += best;  // a surface found in pieces counts once
    }
    found.agreement = static_cast<double>(right) / static_cast<double>(labelled);
    return found;
}

class ExactParts : public ::testing::TestWithParam<const char*> {};

TEST_P(ExactParts, EveryTrueSurfaceIsFound) {
    const datasets::Generated part = datasets::generate(GetParam(), 12000);
    const Found found = run(part);
    EXPECT_GE(found.agreement, 0.999);
    EXPECT_GE(found.surfaces.covered, 0.999);
    EXPECT_EQ(found.regions, part.surfaces.size());
}

TEST_P(ExactParts, TypesAndRadiiAreTheTrueOnes) {
    const datasets::Generated part = datasets::generate(GetParam(), 12000, 0, 7);
    const runtime::RunControl control(nullptr);
    const mesh::WorkMesh mesh = mesh::build_work_mesh(part.mesh.view(), control);
    const ExactSurfaces found = find_exact_surfaces(mesh, control);
    std::size_t right = 0, faces = 0;
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        if (found.labels[f] < 0) continue;
        const Surface& s = found.surfaces[static_cast<std::size_t>(found.labels[f])];
        const Surface& truth = part.surfaces[static_cast<std::size_t>(part.truth[mesh.input_face[f]])].surface;
        ++faces;
        right += s.type == truth.type && std::abs(s.radius / mesh.frame.scale - truth.radius) <= 1e-6 * part.diagonal;
    }
    EXPECT_GE(right, faces * 99 / 100);
}

TEST_P(ExactParts, TheSameAtAnyThreadCount) {
    const datasets::Generated part = datasets::generate(GetParam(), 4000);
    const Found one = run(part, 1);
    for (const int threads : {2, 3}) EXPECT_EQ(one.labels, run(part, threads).labels);
}

INSTANTIATE_TEST_SUITE_P(Parts, ExactParts, ::testing::Values("plate", "shaft", "flange", "fillets"),
                         [](const auto& name) { return std::string(name.param); });

TEST(ExactSurfaces, FewAccidentsOnASmoothSheetOfRoundedCoordinates) {
    // Within the rounding any small patch of it is a torus; what such a patch ends in tells.
    constexpr std::uint32_t n = 60;
    Mesh sheet;
    for (std::uint32_t j = 0; j <= n; ++j) {
        for (std::uint32_t i = 0; i <= n; ++i) {
            const double x = double(i) / n, y = double(j) / n;
            const double z = 0.08 * std::sin(2.3 * x + 1.7 * y) * std::cos(2.1 * y - 0.7 * x);
            for (const double v : {x, y, z}) sheet.positions.push_back(std::round(v * 1e6) / 1e6);
        }
    }
    for (std::uint32_t j = 0; j < n; ++j) {
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t a = j * (n + 1) + i, b = a + n + 1;
            sheet.triangles.insert(sheet.triangles.end(), {a, a + 1, b + 1, a, b + 1, b});
        }
    }
    const runtime::RunControl control(nullptr);
    const mesh::WorkMesh mesh = mesh::build_work_mesh(sheet.view(), control);
    EXPECT_LT(find_exact_surfaces(mesh, control).covered, 0.05);
}

TEST(ExactSurfaces, StopsWhenCancelled) {
    const datasets::Generated part = datasets::generate("plate", 4000);
    const runtime::RunControl running(nullptr);
    const mesh::WorkMesh mesh = mesh::build_work_mesh(part.mesh.view(), running);
    Context context;
    context.cancel();
    const runtime::RunControl stopped(&context);
    EXPECT_THROW(find_exact_surfaces(mesh, stopped), runtime::Stopped);
}

/// Two rims lie on a torus wherever four rows do.
TEST(ExactSurfaces, ExtrudedProfilesAreNoTori) {
    const runtime::RunControl control(nullptr);
    const test::Shape wall = test::wall(0, 12, 12);
    const mesh::WorkMesh mesh = mesh::build_work_mesh(wall.view(), control);
    const ExactSurfaces found = find_exact_surfaces(mesh, control);
    for (const std::int32_t label : found.labels) {
        if (label < 0) continue;
        const SurfaceType type = found.surfaces[static_cast<std::size_t>(label)].type;
        EXPECT_TRUE(type == SurfaceType::plane || type == SurfaceType::cylinder) << to_string(type);
    }
}

/// A disc with a cylindrical rim between two chamfers: its four circles lie on a torus.
TEST(ExactSurfaces, UnevenBandsAreNoTorus) {
    constexpr std::uint32_t sectors = 48;
    test::Shape s;
    for (const auto& [r, z] : {std::pair{0.9, -0.5}, {1.0, -0.35}, {1.0, 0.35}, {0.9, 0.5}}) {
        for (std::uint32_t i = 0; i < sectors; ++i) {
            const double t = 2 * std::numbers::pi * i / sectors;
            s.vertex(r * std::cos(t), r * std::sin(t), z);
        }
    }
    const std::uint32_t below = s.vertex(0, 0, -0.5), above = s.vertex(0, 0, 0.5);
    for (std::uint32_t i = 0; i < sectors; ++i) {
        const std::uint32_t k = (i + 1) % sectors;
        s.face(below, k, i);
        s.face(above, 3 * sectors + i, 3 * sectors + k);
        for (std::uint32_t j = 0; j < 3; ++j) {
            s.quad(j * sectors + i, j * sectors + k, (j + 1) * sectors + k, (j + 1) * sectors + i);
        }
    }
    const runtime::RunControl control(nullptr);
    const mesh::WorkMesh mesh = mesh::build_work_mesh(s.view(), control);
    const ExactSurfaces found = find_exact_surfaces(mesh, control);
    std::map<SurfaceType, std::set<std::int32_t>> regions;
    for (const std::int32_t label : found.labels) {
        ASSERT_GE(label, 0);
        regions[found.surfaces[static_cast<std::size_t>(label)].type].insert(label);
    }
    EXPECT_EQ(regions[SurfaceType::plane].size(), 2U);
    EXPECT_EQ(regions[SurfaceType::cylinder].size(), 1U);
    EXPECT_EQ(regions[SurfaceType::cone].size(), 2U);
}

/// A twisted strip on which every search fails goes on smoothly as a cylinder of one row.
TEST(ExactSurfaces, NarrowCylinderBesideFreeFormIsFound) {
    constexpr std::uint32_t twisted = 40, round = 10;
    constexpr double height = 0.12, radius = 1 / 0.6;
    test::Shape s;
    for (std::uint32_t i = 0; i < twisted; ++i) {
        const double x = std::pow(double(i) / twisted, 1.3) - 1, y = 0.3 * x * x - 0.25 * x * x * x;
        s.vertex(x, y, 0);
        s.vertex(x - 0.03 * std::sin(9 * x) * x, y + 0.05 * x * x * std::sin(11 * x), height);
    }
    for (std::uint32_t i = 0; i <= round; ++i) {
        const double a = 50 * std::numbers::pi / 180 * i / round;
        for (const double z : {0.0, height}) s.vertex(radius * std::sin(a), radius - radius * std::cos(a), z);
    }
    for (std::uint32_t i = 0; i < twisted + round; ++i) s.quad(2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1);
    const runtime::RunControl control(nullptr);
    const mesh::WorkMesh mesh = mesh::build_work_mesh(s.view(), control);
    const ExactSurfaces found = find_exact_surfaces(mesh, control);
    const std::vector<std::int32_t> labels = mesh::labels_to_input(mesh, found.labels);
    for (std::size_t f = std::size_t{2} * twisted; f < labels.size(); ++f) {
        ASSERT_GE(labels[f], 0) << f;
        EXPECT_EQ(labels[f], labels.back());
    }
    EXPECT_EQ(found.surfaces[static_cast<std::size_t>(labels.back())].type, SurfaceType::cylinder);
}

}  // namespace
}  // namespace quadseg::exact
