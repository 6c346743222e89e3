// One question for all direct types: do the points come close to some torus or limit of one?
#include "surface/torus_family.h"

#include "surface_samples.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <string>

namespace quadseg::surface {
namespace {

using namespace samples;
constexpr double pi = std::numbers::pi;
constexpr Closeness goal{1e-8, 1e-5};

bool may_lie(const Patch& patch) {
    FitOptions options;
    options.iterations = 20;
    options.minimum_scale = goal.tolerance / 1000;
    return may_lie_on_torus({patch.points, patch.normals, {}}, {}, goal, options);
}

struct Case {
    std::string name;
    Surface surface;
    Range u, v;
};

/// What the fit of the type itself finds.
bool is_found(SurfaceType type, const Patch& patch) {
    FitOptions options;
    options.iterations = 20;
    options.minimum_scale = goal.tolerance / 1000;
    options.wanted = goal.tolerance;
    const SurfaceFit f = fit(type, {patch.points, patch.normals, {}}, options);
    return f.ok && (f.q90 <= goal.tolerance || (f.median <= goal.tolerance / 2 && f.q97 <= goal.stray));
}

const Vec3 place{.2, -.1, .4}, tilted = normalized({.3, -.5, .8});

std::vector<Case> cases() {
    return {{"plane", plane(place, tilted), {-1, 1, 4}, {-1, 1, 5}},
            {"sphere", sphere(place, .7), {0, 1, 5}, {.2, .8, 4}},
            {"cylinder", cylinder(place, tilted, .4), {0, pi / 2, 6}, {0, 1, 3}},
            {"cone", cone(place, tilted, .5), {0, pi / 2, 6}, {.5, 1, 3}},
            {"torus", torus(place, tilted, 1, .2), {0, .5, 5}, {0, pi / 2, 5}},
            {"lemon", torus(place, tilted, .3, .8), {0, 1, 5}, {-.4, .4, 5}}};
}

/// A smooth graph on none of the types.
Patch freeform(int side) {
    Patch patch;
    for (int i = 0; i < side; ++i) {
        for (int j = 0; j < side; ++j) {
            const double x = 2.0 * i / (side - 1) - 1, y = 2.0 * j / (side - 1) - 1;
            patch.points.push_back({x, y, .2 * x * x - .1 * y * y + .1 * x * x * x + .15 * x * y * y});
            patch.normals.push_back(normalized({-.4 * x - .3 * x * x - .15 * y * y, .2 * y - .3 * x * y, 1}));
        }
    }
    return patch;
}

TEST(TorusFamily, HasAllDirectTypes) {
    for (const Case& c : cases()) EXPECT_TRUE(may_lie(grid(c.surface, c.u, c.v, .02))) << c.name;
}

TEST(TorusFamily, HasPointsOnTrimCurvesWithinTheStray) {
    for (const Case& c : cases()) {
        if (c.surface.type == SurfaceType::plane) continue;  // fitted without being asked for
        Patch patch = grid(c.surface, c.u, c.v, .01);
        Random random(3);
        for (std::size_t i = 0; i < patch.points.size(); i += 6) patch.points[i] += 3e-6 * random.direction();
        EXPECT_TRUE(may_lie(patch) || !is_found(c.surface.type, patch)) << c.name;
    }
}

TEST(TorusFamily, LooksThroughAGrossOutlier) {
    // A patch that runs over onto its neighbour. Not a cone's: its starts are turned too far.
    for (const Case& c : cases()) {
        if (c.surface.type == SurfaceType::cone) continue;
        Patch patch = grid(c.surface, c.u, c.v, .01);
        patch.points.back() += .02 * tilted;
        EXPECT_TRUE(may_lie(patch) || !is_found(c.surface.type, patch)) << c.name;
    }
}

TEST(TorusFamily, DoesNotHaveFreeformPoints) {
    for (const int side : {4, 5, 7}) EXPECT_FALSE(may_lie(freeform(side))) << side;
    Patch noisy = grid(torus(place, tilted, 1, .2), {0, .5, 5}, {0, pi / 2, 5});
    add_noise(noisy, 1e-4);
    EXPECT_FALSE(may_lie(noisy));
}

TEST(TorusFamily, AsksForNormalsBeforeItSaysNo) {
    Patch patch = freeform(5);
    patch.normals.clear();
    EXPECT_TRUE(may_lie(patch));
}

}  // namespace
}  // namespace quadseg::surface
