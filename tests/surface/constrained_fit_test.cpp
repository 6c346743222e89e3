// Model choice on vertices of tessellations: the type, and no chord bias in the parameters.
#include "surface/constrained_fit.h"

#include "quadric_samples.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace quadseg::surface {
namespace {

using namespace samples;
constexpr double pi = std::numbers::pi;
const Vec3 tilted = normalized({.3, -.5, .8});
const Vec3 place{.2, -.1, .4};

/// Normals of vertices as a tessellation has them: the mean of the adjacent facets of a strip.
Patch facets(const Surface& s, double from, double to, int count, bool closed, double height) {
    Patch patch;
    const int vertices = closed ? count : count + 1;
    const double step = (to - from) / count;
    const Vec3 a = normalized(to_vec3(s.axis));
    for (int i = 0; i < vertices; ++i) {
        const double u = from + i * step;
        for (double v : {0.0, height}) {
            const Vec3 p = point_on(s, u, v);
            patch.points.push_back(p);
            const double middle = closed || (i > 0 && i < count) ? u : i == 0 ? u + step / 2 : u - step / 2;
            const Vec3 n = point_on(s, middle, v) - to_vec3(s.point);
            patch.normals.push_back(normalized(n - dot(n, a) * a));
        }
    }
    return patch;
}

TEST(ConstrainedFit, CylinderOf16FacetsAndQuarterCylinderOf4) {
    const Surface truth = cylinder(place, tilted, 1);
    // What area integrals give: 1.3 % too small; an ellipse of 1.90/1.33 (MATH.md §3).
    Surface small = truth;
    small.radius = .987;
    const quadric::Coefficients biased = to_coefficients(small);
    quadric::Coefficients ellipse = to_coefficients(cylinder(place + Vec3{.3, .3, 0}, tilted, 1.6));
    for (double height : {.02, .5, 2.0, 20.0}) {
        for (const auto& [patch, start] :
             {std::pair{facets(truth, -pi, pi, 16, true, height), biased},
              std::pair{facets(truth, 0, pi / 2, 4, false, height), ellipse},
              std::pair{facets(truth, 0, pi / 2, 4, false, height), quadric::Coefficients{}},
              std::pair{facets(truth, -pi, pi, 8, true, height), biased}}) {
            const SurfaceFit f = choose_surface_fit({patch.points, patch.normals, {}}, start);
            ASSERT_TRUE(f.ok);
            ASSERT_EQ(int(f.surface.type), int(SurfaceType::cylinder)) << height;
            EXPECT_LT(parameter_error(f.surface, truth, 1), 1e-9) << height;
            EXPECT_TRUE(f.surface.outward);
            EXPECT_NEAR(quadric::value(f.surface.coefficients, point_on(truth, .3, .1)), 0, 1e-9);
        }
    }
}

TEST(ConstrainedFit, CommonTypesFromGrids) {
    const std::vector<std::pair<Surface, std::array<Range, 2>>> cases = {
        {plane(place, tilted), {Range{-1, 1, 4}, Range{-1, 1, 5}}},
        {sphere(place, .7), {Range{-1, 1, 6}, Range{-.5, .8, 6}}},
        {cylinder(place, tilted, .4), {Range{0, 2, 6}, Range{0, 1, 4}}},
        {cone(place, tilted, .5), {Range{0, 3, 8}, Range{.5, 1.5, 4}}},
        {cone(place, tilted, .5), {Range{-pi, 2.8, 16}, Range{1, 1.2, 2}}},
        {torus(place, tilted, .8, .25), {Range{0, 3, 8}, Range{-1, 1, 5}}},
    };
    for (const auto& [truth, ranges] : cases) {
        const Patch patch = grid(truth, ranges[0], ranges[1], .05);
        const SurfaceFit f = choose_surface_fit({patch.points, patch.normals, {}}, {});
        ASSERT_EQ(int(f.surface.type), int(truth.type));
        EXPECT_LT(parameter_error(f.surface, truth, 1), 1e-9) << int(truth.type);
    }
}

/// Vertices of a quadric around one of its points, at most `size` away.
Patch patch_of(const quadric::Coefficients& c, const Vec3& middle, double size, int count, double bend,
               Random& random) {
    const QuadricProjector projector(c);
    Patch patch;
    for (int i = 0; i < 50 * count && int(patch.points.size()) < count; ++i) {
        const Vec3 direction = random.direction();
        const Vec3 p = projector.foot_point(middle + size * random.uniform(0, 1) * direction);
        const Vec3 n = normalized(quadric::gradient(c, p));
        if (norm(p - middle) > 1.5 * size || dot(n, normalized(quadric::gradient(c, middle))) < 0) continue;
        patch.points.push_back(p);
        patch.normals.push_back(normalized(n + bend * random.direction()));
    }
    return patch;
}

TEST(ConstrainedFit, GeneralTypesComeBack) {
    struct Named {
        SurfaceType type;
        quadric::Coefficients c;
        Vec3 middle;
    };
    const std::vector<Named> cases = {
        {SurfaceType::elliptic_cylinder, {-1, 0, 0, 0, 1, 0, 0, 1 / 4., 0, 0}, {1, 0, 0}},
        {SurfaceType::hyperbolic_cylinder, {-1, 0, 0, 0, 1, 0, 0, -1 / 4., 0, 0}, {1, 0, 0}},
        {SurfaceType::parabolic_cylinder, {0, 0, -1, 0, 1, 0, 0, 0, 0, 0}, {0, 0, 0}},
        {SurfaceType::elliptic_cone, {0, 0, 0, 0, 1, 0, 0, 1 / 3., 0, -1}, {1, 0, 1}},
        {SurfaceType::elliptic_paraboloid, {0, 0, 0, -1, 1, 0, 0, 1 / 2., 0, 0}, {.3, 0, .1}},
        {SurfaceType::hyperbolic_paraboloid, {0, 0, 0, -1, 1, 0, 0, -1 / 2., 0, 0}, {0, 0, 0}},
        {SurfaceType::ellipsoid, {-1, 0, 0, 0, 1, 0, 0, 1 / 2., 0, 1 / 3.}, {1, 0, 0}},
        {SurfaceType::hyperboloid_one_sheet, {-1, 0, 0, 0, 1, 0, 0, 1 / 2., 0, -1 / 3.}, {1, 0, 0}},
        {SurfaceType::hyperboloid_two_sheets, {1, 0, 0, 0, 1, 0, 0, 1 / 2., 0, -1 / 3.}, {0, 0, 1.7}},
    };
    Random random(8);
    const Vec3 axes[3] = {normalized({1, 2, -1}), normalized(cross({1, 2, -1}, {0, 1, 3})),
                          cross(normalized({1, 2, -1}), normalized(cross({1, 2, -1}, {0, 1, 3})))};
    for (const Named& n : cases) {
        const Patch local = patch_of(n.c, n.middle, .6, 80, .05, random);
        ASSERT_EQ(local.points.size(), 80u) << int(n.type);
        Patch patch;  // elsewhere
        for (std::size_t i = 0; i < local.points.size(); ++i) {
            const Vec3 &u = local.points[i], &m = local.normals[i];
            patch.points.push_back(place + u.x * axes[0] + u.y * axes[1] + u.z * axes[2]);
            patch.normals.push_back(m.x * axes[0] + m.y * axes[1] + m.z * axes[2]);
        }
        const PointSet set{patch.points, patch.normals, {}};
        const SurfaceFit f = choose_surface_fit(set, {});
        ASSERT_EQ(int(f.surface.type), int(n.type));
        EXPECT_LT(f.max, 1e-9) << int(n.type);
        const Surface truth = classify(n.c, n.middle, 1, 1e-6);
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_NEAR(f.surface.semi_axes[i] / std::max(f.surface.semi_axes[2], 1e-300) *
                            (n.type == SurfaceType::elliptic_cone ? 1 : std::max(f.surface.semi_axes[2], 1e-300)),
                        truth.semi_axes[i] / std::max(truth.semi_axes[2], 1e-300) *
                            (n.type == SurfaceType::elliptic_cone ? 1 : std::max(truth.semi_axes[2], 1e-300)),
                        1e-6)
                << int(n.type);
        // Oriented and scaled.
        double steep = 0;
        for (std::size_t i = 0; i < patch.points.size(); ++i) {
            const Vec3 g = quadric::gradient(f.surface.coefficients, patch.points[i]);
            EXPECT_GT(dot(g, patch.normals[i]), 0);
            steep += norm(g) / 80;
        }
        EXPECT_NEAR(steep, 1, 1e-12);
    }
}

TEST(ConstrainedFit, NoiseDoesNotBuyParameters) {
    const std::vector<std::pair<Surface, std::array<Range, 2>>> cases = {
        {plane(place, tilted), {Range{-1, 1, 10}, Range{-1, 1, 12}}},
        {sphere(place, .7), {Range{-1, 1, 12}, Range{-.5, .8, 12}}},
        {cylinder(place, tilted, .4), {Range{0, 2, 12}, Range{0, 1, 12}}},
        {cone(place, tilted, .5), {Range{0, 3, 16}, Range{.5, 1.5, 12}}},
    };
    for (const auto& [truth, ranges] : cases) {
        Patch patch = grid(truth, ranges[0], ranges[1], .05);
        add_noise(patch, 1e-4);
        ChoiceOptions options;
        options.noise_floor = 1e-4;
        options.fit.robust = false;
        const SurfaceFit f = choose_surface_fit({patch.points, patch.normals, {}}, {}, options);
        EXPECT_EQ(int(f.surface.type), int(truth.type));
        EXPECT_LT(f.rms, 1.5e-4);
    }
}

TEST(ConstrainedFit, FitTypeForcesTheType) {
    const Patch patch = grid(torus(place, tilted, .8, .25), {0, 3, 8}, {-1, 1, 5}, .05);
    const PointSet set{patch.points, patch.normals, {}};
    for (SurfaceType type : {SurfaceType::sphere, SurfaceType::cylinder, SurfaceType::torus, SurfaceType::quadric}) {
        const SurfaceFit f = fit_type(type, set, {});
        ASSERT_TRUE(f.ok) << int(type);
        EXPECT_TRUE(type == SurfaceType::quadric || f.surface.type == type);
    }
    EXPECT_FALSE(fit_type(SurfaceType::blend, set, {}).ok);
}

TEST(ConstrainedFit, DegenerateDataNeverCrash) {
    Random random(3);
    for (int run = 0; run < 60; ++run) {
        Patch patch;
        const int n = int(random.next() % 20);
        for (int i = 0; i < n; ++i) {
            patch.points.push_back(run % 3 ? random.direction() : Vec3{double(i), 0, 0});
            patch.normals.push_back(random.direction());
        }
        if (n > 3 && run % 7 == 0) patch.points[1].x = std::nan("");
        const SurfaceFit f = choose_surface_fit({patch.points, patch.normals, {}}, {});
        EXPECT_TRUE(!f.ok || std::isfinite(f.rms));
        choose_surface_fit({patch.points, {}, {}}, {});
    }
}

}  // namespace
}  // namespace quadseg::surface
