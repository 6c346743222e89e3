// What segment() reports about its regions: types, parameters, coefficients, distances, regularities.
#include "flow/finish.h"

#include <quadseg/segmentation.h>

#include "datasets/generate.h"
#include "flow/polygons.h"
#include "math/vec3.h"
#include "quadric/monomials.h"
#include "runtime/parallel.h"
#include "surface/surface.h"
#include "tests/flow/loop_support.h"
#include "tests/partition/box.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <map>

namespace quadseg {
namespace {

const double pi = std::acos(-1.0);

/// A prism over the polygon (x, y) …, closed by two fans; vertices of `sides` lie on true surfaces.
test::Shape prism(const std::vector<std::pair<double, double>>& outline, double height) {
    test::Shape s;
    const auto n = static_cast<std::uint32_t>(outline.size());
    for (const double z : {0.0, height}) {
        for (const auto& [x, y] : outline) s.vertex(x, y, z);
    }
    for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t k = (i + 1) % n;
        s.quad(i, k, n + k, n + i);
    }
    for (std::uint32_t i = 1; i + 1 < n; ++i) {
        s.face(0, i + 1, i);
        s.face(n, n + i, n + i + 1);
    }
    return s;
}

const Region* largest_of(const Segmentation& result, SurfaceType type) {
    const Region* best = nullptr;
    for (const Region& r : result.regions) {
        if (r.surface.type == type && (best == nullptr || r.area > best->area)) best = &r;
    }
    return best;
}

double distance_to_axis(const Surface& s, const Vec3& p) {
    const Vec3 u = p - to_vec3(s.point), a = to_vec3(s.axis);
    return norm(u - dot(u, a) * a);
}

TEST(Finish, ACylinderOfSixteenFacetsHasItsTrueRadiusAndAxis) {
    std::vector<std::pair<double, double>> circle;
    circle.reserve(16);
    for (int i = 0; i < 16; ++i) circle.emplace_back(3 + 2 * std::cos(pi * i / 8), 1 + 2 * std::sin(pi * i / 8));
    const Segmentation result = segment(prism(circle, 5).view());
    EXPECT_EQ(result.regions.size(), 3U);
    const Region* r = largest_of(result, SurfaceType::cylinder);
    ASSERT_NE(r, nullptr);
    EXPECT_NEAR(r->surface.radius, 2, 1e-6);
    EXPECT_NEAR(std::abs(r->surface.axis[2]), 1, 1e-12);
    EXPECT_LT(distance_to_axis(r->surface, {3, 1, 0}), 1e-6);
    EXPECT_TRUE(r->surface.outward);
    EXPECT_LT(r->max, 1e-9);
}

TEST(Finish, AQuarterCylinderOfFourFacetsHasItsTrueRadiusAndAxis) {
    // A block with one rounded edge of radius 2 about (3, 3).
    std::vector<std::pair<double, double>> outline{{0, 0}, {5, 0}, {5, 3}};
    for (int i = 1; i < 4; ++i) outline.emplace_back(3 + 2 * std::cos(pi * i / 8), 3 + 2 * std::sin(pi * i / 8));
    outline.emplace_back(3, 5);
    outline.emplace_back(0, 5);
    const Segmentation result = segment(prism(outline, 4).view());
    const Region* r = largest_of(result, SurfaceType::cylinder);
    ASSERT_NE(r, nullptr);
    EXPECT_EQ(r->faces, 8U);
    EXPECT_NEAR(r->surface.radius, 2, 1e-6);
    EXPECT_LT(distance_to_axis(r->surface, {3, 3, 0}), 1e-6);
    EXPECT_LT(distance_to_axis(r->surface, {3, 3, 4}), 1e-6);
}

/// ∫ over the region by corners and centroid, from the input's own arrays.
struct Measured {
    double gradient = 0, against = 0, area = 0, max = 0;
    std::size_t faces = 0;
};

std::vector<Measured> measure(const MeshView& mesh, const Segmentation& result) {
    std::vector<Measured> measured(result.regions.size());
    const auto point = [&](std::size_t f, std::size_t k) {
        const double* p = &mesh.positions[3 * std::size_t{mesh.triangles[3 * f + k]}];
        return Vec3{p[0], p[1], p[2]};
    };
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        Measured& m = measured[static_cast<std::size_t>(result.labels[f])];
        const Surface& s = result.regions[static_cast<std::size_t>(result.labels[f])].surface;
        const Vec3 a = point(f, 0), b = point(f, 1), c = point(f, 2), n = cross(b - a, c - a) / 2.0;
        const Vec3 g = quadric::gradient(s.coefficients, (a + b + c) / 3.0);
        m.area += norm(n);
        m.gradient += norm(n) * norm(g);
        if (!(dot(n, g) > 0)) m.against += norm(n);
        for (const Vec3& p : {a, b, c}) m.max = std::max(m.max, std::abs(surface::signed_distance(s, p)));
        ++m.faces;
    }
    return measured;
}

void expect_consistent(const MeshView& mesh, const Segmentation& result) {
    const std::vector<Measured> measured = measure(mesh, result);
    double energy = 0;
    for (const Region& r : result.regions) {
        const Measured& m = measured[static_cast<std::size_t>(r.id)];
        EXPECT_EQ(r.faces, m.faces);
        EXPECT_NEAR(r.area, m.area, 1e-9 * m.area);
        EXPECT_NEAR(r.max * result.input.diagonal, m.max, 1e-9 * result.input.diagonal) << to_string(r.surface.type);
        EXPECT_LE(r.rms, r.max * (1 + 1e-12));
        EXPECT_NEAR(m.gradient, m.area, 1e-3 * m.area) << to_string(r.surface.type);
        if (r.valid) {
            EXPECT_LE(m.against, 0.011 * m.area) << to_string(r.surface.type);
        }
        energy += r.energy;
    }
    EXPECT_NEAR(energy, result.energy.total, 1e-9 * (1 + result.energy.total));
}

TEST(Finish, DistancesAreasAndCoefficientsAreThoseOfTheInput) {
    for (const char* name : {"plate", "shaft", "flange", "quadrics"}) {
        const datasets::Generated part = datasets::generate(name, 8000);
        expect_consistent(part.mesh.view(), segment(part.mesh.view()));
    }
}

TEST(Finish, TheSameForAnEnergyFlowWithoutVerifiedSurfaces) {
    const datasets::Generated part = datasets::generate("flange", 8000);
    Options options;
    options.regions = part.surfaces.size();
    expect_consistent(part.mesh.view(), segment(part.mesh.view(), options));
}

/// finish() on the true partition, whose surfaces it has to find by itself.
struct TruePartition {
    mesh::WorkMesh mesh;
    Options options;
    Segmentation result;
};

TruePartition finish_truth(const datasets::Generated& part, const Options& options = {}) {
    const runtime::RunControl free_run(nullptr);
    TruePartition run{mesh::build_work_mesh(part.mesh.view(), free_run), options, {}};
    flow::FlowResult flow;
    flow.labels = mesh::labels_from_input(run.mesh, part.truth);
    flow.regions = part.surfaces.size();
    run.result = flow::finish({run.mesh, nullptr, run.options, free_run}, std::move(flow));
    return run;
}

TEST(Finish, TypesAndParametersOfTheTruePartitionAreTheTrueOnes) {
    for (const char* name : {"plate", "shaft", "flange", "quadrics", "rounded_octahedron"}) {
        const datasets::Generated part = datasets::generate(name, 20000);
        const TruePartition run = finish_truth(part);
        std::size_t right = 0;
        for (std::size_t r = 0; r < part.surfaces.size(); ++r) {
            const Surface &truth = part.surfaces[r].surface, &found = run.result.regions[r].surface;
            SCOPED_TRACE(std::string(name) + " region " + std::to_string(r) + ": " + to_string(truth.type) + " as " +
                         to_string(found.type));
            EXPECT_LT(run.result.regions[r].max, 1e-6);
            if (truth.type != found.type) continue;
            ++right;
            EXPECT_NEAR(found.radius, truth.radius, 1e-6 * part.diagonal);
            EXPECT_NEAR(found.minor_radius, truth.minor_radius, 1e-6 * part.diagonal);
            EXPECT_NEAR(found.half_angle, truth.half_angle, 1e-6);
            const bool directed = truth.type == SurfaceType::plane || truth.type == SurfaceType::cylinder ||
                                  truth.type == SurfaceType::cone || truth.type == SurfaceType::torus;
            if (directed) {
                EXPECT_LT(norm(cross(to_vec3(truth.axis), to_vec3(found.axis))), 1e-6);
            }
        }
        EXPECT_GE(right * 20, part.surfaces.size() * 19) << name;
    }
}

TEST(Finish, ThePaperNamesPlanesSpheresAndCylinders) {
    const test::Shape dome = test::dome_on_plate(40, 12);
    Options options = test::paper_options(2);
    options.feature_angle = 30;
    const Segmentation result = segment(dome.view(), options);
    const Region* sphere = largest_of(result, SurfaceType::sphere);
    ASSERT_NE(sphere, nullptr);
    EXPECT_NE(largest_of(result, SurfaceType::plane), nullptr);
    EXPECT_NEAR(sphere->surface.radius, 1, 1e-6);
    EXPECT_LT(norm(to_vec3(sphere->surface.point)), 1e-6);
    const test::Shape can = test::capped_cylinder(60, 12);
    const Segmentation second = segment(can.view(), options);
    const Region* cylinder = largest_of(second, SurfaceType::cylinder);
    ASSERT_NE(cylinder, nullptr);
    EXPECT_NEAR(cylinder->surface.radius, 1, 1e-6);
}

TEST(Finish, SurfacesOfOnePlaneShareAnId) {
    // Two boxes of one size side by side: 12 planes, of which bottom, top, front and back are common.
    const Segmentation result = segment(test::joined(test::box(4), test::box(4, 3)).view());
    ASSERT_EQ(result.regions.size(), 12U);
    std::map<std::int32_t, int> used;
    for (const Region& r : result.regions) {
        ++used[r.surface_id];
        EXPECT_LE(r.surface_id, r.id);
    }
    EXPECT_EQ(used.size(), 8U);
}

TEST(Finish, RegularitiesAreFoundAndCanBeLeftAlone) {
    const test::Shape box = test::box(5);
    const Segmentation with = segment(box.view());
    const auto count = [&](Regularity::Kind kind) {
        return std::count_if(with.regularities.begin(), with.regularities.end(),
                             [&](const Regularity& g) { return g.kind == kind; });
    };
    EXPECT_EQ(count(Regularity::Kind::parallel), 3);
    EXPECT_EQ(count(Regularity::Kind::perpendicular), 3);
    for (const Regularity& g : with.regularities) EXPECT_TRUE(g.snapped);
    Options options;
    options.regularities = false;
    EXPECT_TRUE(segment(box.view(), options).regularities.empty());
}

TEST(Finish, SnappingNeverMovesASurfaceAwayFromItsVertices) {
    for (const char* name : {"plate", "shaft", "flange"}) {
        const datasets::Generated part = datasets::generate(name, 6000);
        Options options;
        const Segmentation snapped = segment(part.mesh.view(), options);
        options.regularities = false;
        const Segmentation plain = segment(part.mesh.view(), options);
        ASSERT_EQ(snapped.labels, plain.labels);
        EXPECT_FALSE(snapped.regularities.empty());
        for (std::size_t r = 0; r < plain.regions.size(); ++r) {
            EXPECT_LE(snapped.regions[r].rms, 1.3 * plain.regions[r].rms + 2e-9);
        }
    }
}

TEST(Finish, SmoothBumpsAreFreeForm) {
    const test::Shape bumps = test::bumpy_grid(40);
    const Segmentation result = segment(bumps.view());
    std::size_t named = 0;
    for (const Region& r : result.regions) named += r.surface.type == SurfaceType::freeform ? r.faces : 0;
    EXPECT_GT(named, bumps.faces() / 2);
    expect_consistent(bumps.view(), result);
}

TEST(Finish, WhatIsNearlyACylinderIsNamedOne) {
    // Off by more than any verified surface, by less than an engineer cares.
    constexpr std::uint32_t around = 48, rings = 16;
    test::Shape s;
    for (std::uint32_t j = 0; j <= rings; ++j) {
        for (std::uint32_t i = 0; i < around; ++i) {
            const double angle = 2 * pi * i / around, z = 3.0 * j / rings;
            const double radius = 2 + 3e-4 * std::sin(3 * angle) * std::cos(4 * z);
            s.vertex(radius * std::cos(angle), radius * std::sin(angle), z);
        }
    }
    for (std::uint32_t j = 0; j < rings; ++j) {
        for (std::uint32_t i = 0; i < around; ++i) {
            const std::uint32_t a = j * around + i, b = j * around + (i + 1) % around;
            s.quad(a, b, b + around, a + around);
        }
    }
    for (std::uint32_t i = 1; i + 1 < around; ++i) {
        s.face(0, i + 1, i);
        s.face(rings * around, rings * around + i, rings * around + i + 1);
    }
    const Segmentation result = segment(s.view());
    const Region* side = largest_of(result, SurfaceType::cylinder);
    ASSERT_NE(side, nullptr);
    EXPECT_NEAR(side->surface.radius, 2, 3e-4);
    EXPECT_GT(side->area, 0.99 * 2 * pi * 2 * 3);
    EXPECT_GT(side->rms, 1e-5);
}

TEST(Finish, TrianglesOfAPolygonShareTheLabelOfItsLargerPart) {
    test::Shape grid = test::grid(6, 6);
    for (std::uint32_t f = 0; f < grid.faces(); ++f) grid.polygons.push_back(f / 2);
    const mesh::WorkMesh mesh = test::work_mesh(grid);
    flow::FlowResult flow;
    flow.labels.resize(mesh.face_count());
    for (std::size_t f = 0; f < mesh.face_count(); ++f) flow.labels[f] = mesh.input_face[f] < 31 ? 0 : 1;
    flow.regions = 2;
    flow.surfaces.resize(2);
    flow.surfaces[1].radius = 7;  // a mark to follow
    flow::unify_polygons(mesh, flow);
    EXPECT_EQ(flow.regions, 2U);
    std::size_t second = 0;
    const std::vector<std::int32_t> labels = mesh::labels_to_input(mesh, flow.labels);
    for (std::size_t f = 0; f + 1 < labels.size(); f += 2) EXPECT_EQ(labels[f], labels[f + 1]);
    const auto marked = static_cast<std::int32_t>(flow.surfaces[1].radius == 7 ? 1 : 0);
    for (const std::int32_t label : labels) second += label == marked ? 1U : 0U;
    EXPECT_EQ(second, grid.faces() - 32);
}

TEST(Finish, TheSameAtAnyThreadCount) {
    const datasets::Generated part = datasets::generate("plate", 10000);
    Options options;
    options.smooth = options.project = true;
    Context one, four;
    one.set_threads(1);
    four.set_threads(4);
    for (const std::size_t k : {std::size_t{0}, std::size_t{30}}) {
        options.regions = k;
        const Segmentation a = segment(part.mesh.view(), options, &one), b = segment(part.mesh.view(), options, &four);
        EXPECT_EQ(a.labels, b.labels);
        EXPECT_EQ(a.projected, b.projected);
        ASSERT_EQ(a.regions.size(), b.regions.size());
        for (std::size_t r = 0; r < a.regions.size(); ++r) {
            EXPECT_EQ(a.regions[r].surface.coefficients, b.regions[r].surface.coefficients);
            EXPECT_EQ(a.regions[r].rms, b.regions[r].rms);
            EXPECT_EQ(a.regions[r].surface_id, b.regions[r].surface_id);
        }
    }
}

TEST(Finish, SurvivesRegionsOfOneFaceAndFacesWithoutArea) {
    test::Shape flat = test::grid(4, 4);
    for (std::size_t v = 1; v < flat.positions.size(); v += 3) flat.positions[v] = 0;
    flat.positions[1] = 1e-3;
    Options options;
    options.smooth = options.project = true;
    for (const std::size_t k : {0U, 5U, 1000U}) {
        options.regions = k;
        for (const Preset preset : {Preset::standard, Preset::paper}) {
            options.preset = preset;
            const Segmentation result = segment(flat.view(), options);
            for (const Region& r : result.regions) {
                EXPECT_TRUE(std::isfinite(r.rms) && std::isfinite(r.max) && std::isfinite(r.energy));
                for (const double c : r.surface.coefficients) EXPECT_TRUE(std::isfinite(c));
            }
        }
    }
}

}  // namespace
}  // namespace quadseg
