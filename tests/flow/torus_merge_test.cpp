// A bent pipe, as scanned, has a straight piece, a bend and a straight piece.
#include "flow/torus_merge.h"

#include <quadseg/segmentation.h>

#include "datasets/pcg.h"
#include "runtime/parallel.h"
#include "tests/mesh/shapes.h"
#include "tests/pipeline/result_checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>
#include <map>
#include <numbers>
#include <vector>

namespace quadseg {
namespace {

constexpr double pipe_radius = 1.5, bend_radius = 10, straight = 8;
constexpr std::uint32_t around = 40, rings_straight = 36, rings_bend = 68;

struct Pipe {
    test::Shape shape;
    std::vector<int> truth;  ///< of a face: 0 and 2 straight, 1 bent
};

/// Open at both ends; the bend takes a quarter turn. `noise` along the normals.
Pipe pipe(double noise) {
    Pipe result;
    datasets::Pcg random(7);
    const auto ring = [&](double angle, double along, double shift) {
        const double c = std::cos(angle), s = std::sin(angle);
        for (std::uint32_t i = 0; i < around; ++i) {
            const double t = 2 * std::numbers::pi * (i + shift) / around;
            const double r = pipe_radius + noise * random.gaussian(), out = bend_radius + r * std::cos(t);
            result.shape.vertex(out * c - along * s, out * s + along * c, r * std::sin(t));
        }
    };
    const double quarter = std::numbers::pi / 2;
    std::vector<int> part;
    const auto add = [&](int which, double angle, double along) {
        ring(angle, along, part.size() % 2 == 0 ? 0.0 : 0.5);
        part.push_back(which);
    };
    for (std::uint32_t j = 0; j < rings_straight; ++j) add(0, 0, straight * (1.0 * j / rings_straight - 1));
    for (std::uint32_t j = 0; j < rings_bend; ++j) add(1, quarter * j / rings_bend, 0);
    for (std::uint32_t j = 0; j <= rings_straight; ++j) add(2, quarter, straight * j / rings_straight);
    for (std::uint32_t j = 0; j + 1 < part.size(); ++j) {
        for (std::uint32_t i = 0; i < around; ++i) {
            const std::uint32_t a = j * around + i, b = j * around + (i + 1) % around;
            if (j % 2 == 0) {
                result.shape.face(a, b, a + around);
                result.shape.face(b, b + around, a + around);
            } else {
                result.shape.face(a, b, b + around);
                result.shape.face(a, b + around, a + around);
            }
            result.truth.insert(result.truth.end(), 2, part[j]);
        }
    }
    return result;
}

TEST(TorusMerge, ABentPipeHasOneBend) {
    for (const double noise : {0.02, 0.06}) {  // edges are .23 long
        const Pipe p = pipe(noise);
        const MeshView mesh = p.shape.view();
        const Segmentation s = segment(mesh);
        EXPECT_EQ(test::broken_rule(mesh, s), "");
        EXPECT_GT(s.noise, 0);
        std::map<std::int32_t, std::size_t> bent;
        std::size_t all = 0;
        for (std::size_t f = 0; f < p.truth.size(); ++f) {
            if (p.truth[f] != 1) continue;
            ++bent[s.labels[f]];
            ++all;
        }
        const auto most = std::max_element(bent.begin(), bent.end(),
                                           [](const auto& a, const auto& b) { return a.second < b.second; });
        EXPECT_GT(static_cast<double>(most->second), 0.85 * static_cast<double>(all)) << noise;
        const Surface& torus = s.regions[static_cast<std::size_t>(most->first)].surface;
        EXPECT_EQ(torus.type, SurfaceType::torus) << noise;
        EXPECT_NEAR(torus.radius, bend_radius, 0.02 * bend_radius) << noise;
        EXPECT_NEAR(torus.minor_radius, pipe_radius, 0.03 * pipe_radius) << noise;
        EXPECT_LE(s.regions.size(), 5U) << noise;
    }
}

TEST(TorusMerge, TheSameOnOneThreadAndOnThree) {
    const Pipe p = pipe(0.04);
    const auto labels = [&](int threads) {
        std::vector<std::int32_t> result;
        runtime::in_arena(threads, [&] { result = segment(p.shape.view()).labels; });
        return result;
    };
    EXPECT_EQ(labels(1), labels(3));
}

}  // namespace
}  // namespace quadseg
