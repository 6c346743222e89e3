#include "flow/divided.h"

#include <quadseg/segmentation.h>

#include "datasets/generate.h"
#include "exact/exact.h"
#include "tests/partition/box.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <map>
#include <set>

namespace quadseg {
namespace {

const runtime::RunControl free_run(nullptr);

/// Every triangle into four; labels follow. The new faces stand behind all others.
Mesh subdivided(const Mesh& mesh, std::vector<std::int32_t>& truth) {
    Mesh fine;
    fine.positions = mesh.positions;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const auto [at, fresh] =
            middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(fine.positions.size() / 3));
        for (std::size_t k = 0; fresh && k < 3; ++k)
            fine.positions.push_back((mesh.positions[std::size_t{3} * a + k] + mesh.positions[std::size_t{3} * b + k]) /
                                     2);
        return at->second;
    };
    std::vector<std::int32_t> labels;
    for (std::size_t f = 0; f < truth.size(); ++f) {
        const std::uint32_t a = mesh.triangles[3 * f], b = mesh.triangles[3 * f + 1], c = mesh.triangles[3 * f + 2];
        const std::uint32_t x = middle(a, b), y = middle(b, c), z = middle(c, a);
        fine.triangles.insert(fine.triangles.end(), {a, x, z, x, b, y, z, y, c, x, y, z});
        labels.insert(labels.end(), 4, truth[f]);
    }
    truth = std::move(labels);
    return fine;
}

TEST(Divided, ASubdividedPartHasItsSurfaces) {
    const datasets::Generated part = datasets::generate("shaft", 3000);
    std::vector<std::int32_t> truth = part.truth;
    const Mesh fine = subdivided(part.mesh, truth);
    const Segmentation plain = segment(part.mesh.view()), found = segment(fine.view());
    ASSERT_EQ(found.regions.size(), plain.regions.size());
    std::set<std::pair<std::int32_t, std::int32_t>> pairs;
    for (std::size_t f = 0; f < truth.size(); ++f) pairs.insert({found.labels[f], plain.labels[f / 4]});
    EXPECT_EQ(pairs.size(), plain.regions.size());
    for (const auto& [a, b] : pairs) {
        const Surface &s = found.regions[static_cast<std::size_t>(a)].surface,
                      &t = plain.regions[static_cast<std::size_t>(b)].surface;
        EXPECT_EQ(s.type, t.type);
        if (s.type == SurfaceType::cylinder) {
            EXPECT_NEAR(s.radius, t.radius, 1e-9 * t.radius);
        }
    }
}

TEST(Divided, VerticesOnFacetsAreNoEvidence) {
    // Both rims of a cylinder of one row get a vertex in the middle of every third edge, as a repaired T-junction does.
    constexpr std::uint32_t sides = 48;
    test::Shape s;
    std::vector<std::uint32_t> bottom, top;
    const auto add = [&](double x, double y) {
        bottom.push_back(s.vertex(x, y, 0));
        top.push_back(s.vertex(x, y, 0.4));
    };
    const auto corner = [](std::uint32_t i) {
        const double t = 2 * std::acos(-1.0) * i / sides;
        return Vec3{std::cos(t), std::sin(t), 0};
    };
    for (std::uint32_t i = 0; i < sides; ++i) {
        const Vec3 a = corner(i), b = corner(i + 1);
        add(a.x, a.y);
        if (i % 3 == 0) add(0.7 * a.x + 0.3 * b.x, 0.7 * a.y + 0.3 * b.y);
    }
    const std::uint32_t low = s.vertex(0, 0, 0), high = s.vertex(0, 0, 0.4);
    for (std::size_t i = 0; i < bottom.size(); ++i) {
        const std::size_t j = (i + 1) % bottom.size();
        s.quad(bottom[i], bottom[j], top[j], top[i]);
        s.face(bottom[j], bottom[i], low);
        s.face(top[i], top[j], high);
    }
    const Segmentation result = segment(s.view());
    ASSERT_EQ(result.regions.size(), 3U);
    const auto wall = std::find_if(result.regions.begin(), result.regions.end(),
                                   [](const Region& r) { return r.surface.type == SurfaceType::cylinder; });
    ASSERT_NE(wall, result.regions.end());
    EXPECT_NEAR(wall->surface.radius, 1, 1e-12);
    EXPECT_EQ(wall->faces, 2 * bottom.size());

    const mesh::WorkMesh mesh = test::work_mesh(s);
    const exact::ExactSurfaces direct = exact::find_exact_surfaces(mesh, free_run);
    const Options options;
    const auto divided = flow::find_divided({mesh, nullptr, options, free_run}, direct);
    ASSERT_TRUE(divided.has_value());
    EXPECT_EQ(std::count(divided->on_facets.begin(), divided->on_facets.end(), 1), 2 * sides / 3);
}

TEST(Divided, WhatIsNotDividedStays) {
    for (const char* name : {"plate", "shaft", "flange", "fillets", "quadrics"}) {
        const mesh::WorkMesh mesh = mesh::build_work_mesh(datasets::generate(name, 6000).mesh.view(), free_run);
        const exact::ExactSurfaces found = exact::find_exact_surfaces(mesh, free_run);
        const Options options;
        EXPECT_FALSE(flow::find_divided({mesh, nullptr, options, free_run}, found)) << name;
    }
}

TEST(Divided, StopsOnDemand) {
    const datasets::Generated part = datasets::generate("shaft", 3000);
    std::vector<std::int32_t> truth = part.truth;
    const mesh::WorkMesh mesh = mesh::build_work_mesh(subdivided(part.mesh, truth).view(), free_run);
    const exact::ExactSurfaces found = exact::find_exact_surfaces(mesh, free_run);
    Context context;
    context.cancel();
    const runtime::RunControl stopped(&context);
    const Options options;
    EXPECT_THROW(flow::find_divided({mesh, nullptr, options, stopped}, found), runtime::Stopped);
}

}  // namespace
}  // namespace quadseg
