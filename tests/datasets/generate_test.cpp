// Every generated solid must be what it claims: closed, outward, exactly on its true surfaces.
#include "datasets/generate.h"

#include <quadseg/error.h>

#include "math/vec3.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <map>
#include <numeric>
#include <set>
#include <unordered_map>

namespace quadseg::datasets {
namespace {

Vec3 vertex(const Generated& g, std::uint32_t v) {
    return {g.mesh.positions[3 * std::size_t{v}], g.mesh.positions[3 * std::size_t{v} + 1],
            g.mesh.positions[3 * std::size_t{v} + 2]};
}

double value(const Quadric& c, const Vec3& p) {
    return c[0] + c[1] * p.x + c[2] * p.y + c[3] * p.z + c[4] * p.x * p.x + c[5] * p.x * p.y + c[6] * p.x * p.z +
           c[7] * p.y * p.y + c[8] * p.y * p.z + c[9] * p.z * p.z;
}

Vec3 gradient(const Quadric& c, const Vec3& p) {
    return {c[1] + 2 * c[4] * p.x + c[5] * p.y + c[6] * p.z, c[2] + c[5] * p.x + 2 * c[7] * p.y + c[8] * p.z,
            c[3] + c[6] * p.x + c[8] * p.y + 2 * c[9] * p.z};
}

/// Offset from the torus along its outer normal, and that normal.
std::pair<double, Vec3> torus_offset(const Surface& s, const Vec3& p) {
    const Vec3 axis = to_vec3(s.axis);
    const Vec3 d = p - to_vec3(s.point);
    const Vec3 flat = d - axis * dot(d, axis);
    const Vec3 from_spine = d - normalized(flat) * s.radius;
    const Vec3 normal = normalized(from_spine);
    return {norm(from_spine) - s.minor_radius, s.outward ? normal : -normal};
}

/// Distance (first order) of a point from a true surface, and the outer normal there.
std::pair<double, Vec3> offset(const Surface& s, const Vec3& p) {
    if (s.type == SurfaceType::torus) return torus_offset(s, p);
    const Vec3 g = gradient(s.coefficients, p);
    const double f = value(s.coefficients, p);
    // At the apex of a cone the gradient vanishes, and what is left of the value is the rounding of squares.
    const bool rounding = std::abs(f) < 1e-15 * (1 + squared_norm(p));
    return {rounding ? 0 : f / std::max(norm(g), 1e-300), normalized(g)};
}

using Edge = std::pair<std::uint32_t, std::uint32_t>;

class Solid : public testing::TestWithParam<std::tuple<std::string, std::size_t>> {
  protected:
    Generated generated = generate(std::get<0>(GetParam()), std::get<1>(GetParam()), 0, 7);
};

TEST_P(Solid, HasAboutTheWantedNumberOfFaces) {
    const auto wanted = static_cast<double>(std::get<1>(GetParam()));
    EXPECT_NEAR(static_cast<double>(generated.truth.size()) / wanted, 1, 0.1);
    EXPECT_EQ(generated.mesh.triangles.size(), 3 * generated.truth.size());
}

TEST_P(Solid, IsClosedAndManifold) {
    std::vector<Edge> edges;
    const auto& t = generated.mesh.triangles;
    for (std::size_t f = 0; f < t.size(); f += 3) {
        for (std::size_t k = 0; k < 3; ++k) edges.emplace_back(t[f + k], t[f + (k + 1) % 3]);
    }
    std::sort(edges.begin(), edges.end());
    ASSERT_TRUE(std::adjacent_find(edges.begin(), edges.end()) == edges.end()) << "an edge is used twice one way";
    for (const auto& [a, b] : edges) ASSERT_TRUE(std::binary_search(edges.begin(), edges.end(), Edge{b, a}));
    std::vector<char> used(generated.mesh.positions.size() / 3);
    for (const auto v : t) used[v] = 1;
    EXPECT_EQ(std::count(used.begin(), used.end(), 1), static_cast<std::ptrdiff_t>(used.size()));
}

TEST_P(Solid, LiesOnItsTrueSurfacesAndFacesOutwards) {
    const auto& t = generated.mesh.triangles;
    double volume = 0;
    std::vector<std::pair<double, double>> disagreement(generated.surfaces.size());  // area of bad normals, area
    for (std::size_t f = 0; f < generated.truth.size(); ++f) {
        const auto id = static_cast<std::size_t>(generated.truth[f]);
        const Surface& s = generated.surfaces[id].surface;
        const Vec3 a = vertex(generated, t[3 * f]);
        const Vec3 b = vertex(generated, t[3 * f + 1]);
        const Vec3 c = vertex(generated, t[3 * f + 2]);
        for (const Vec3& p : {a, b, c}) {
            ASSERT_NEAR(offset(s, p).first, 0, 1e-9 * generated.diagonal) << to_string(s.type) << " face " << f;
        }
        const Vec3 normal = cross(b - a, c - a);
        ASSERT_GT(norm(normal), 1e-12);
        const Vec3 middle = (a + b + c) / 3;
        ASSERT_GT(dot(normalized(normal), offset(s, middle).second), 0.3)
            << to_string(s.type) << " face " << f << " at " << middle.x << ' ' << middle.y << ' ' << middle.z;
        volume += dot(a, cross(b, c)) / 6;
    }
    EXPECT_GT(volume, 0);
}

TEST_P(Solid, TrueSurfacesAreConnectedAndMaximal) {
    const auto& t = generated.mesh.triangles;
    std::vector<std::size_t> parent(generated.truth.size());
    std::iota(parent.begin(), parent.end(), std::size_t{0});
    const auto find = [&](std::size_t x) {
        while (parent[x] != x) x = parent[x] = parent[parent[x]];
        return x;
    };
    std::map<Edge, std::size_t> first;
    for (std::size_t f = 0; f < generated.truth.size(); ++f) {
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [a, b] = std::minmax({t[3 * f + k], t[3 * f + (k + 1) % 3]});
            const auto [it, fresh] = first.try_emplace(Edge{a, b}, f);
            if (fresh) continue;
            const auto one = static_cast<std::size_t>(generated.truth[f]);
            const auto two = static_cast<std::size_t>(generated.truth[it->second]);
            if (one == two) {
                parent[find(f)] = find(it->second);
            } else {
                EXPECT_NE(generated.surfaces[one].analytic, generated.surfaces[two].analytic)
                    << "two true surfaces on one analytic surface touch: " << one << ' ' << two;
            }
        }
    }
    std::set<std::size_t> roots;
    for (std::size_t f = 0; f < parent.size(); ++f) roots.insert(find(f));
    EXPECT_EQ(roots.size(), generated.surfaces.size());
    std::size_t triangles = 0;
    for (const auto& s : generated.surfaces) {
        EXPECT_GT(s.triangles, 0U);
        triangles += s.triangles;
    }
    EXPECT_EQ(triangles, generated.truth.size());
}

TEST_P(Solid, IsTheSameAgain) {
    const Generated again = generate(std::get<0>(GetParam()), std::get<1>(GetParam()), 0, 7);
    EXPECT_EQ(again.mesh.positions, generated.mesh.positions);
    EXPECT_EQ(again.mesh.triangles, generated.mesh.triangles);
    EXPECT_EQ(again.truth, generated.truth);
    const Generated other = generate(std::get<0>(GetParam()), std::get<1>(GetParam()), 0, 8);
    EXPECT_NE(other.mesh.positions, generated.mesh.positions);
}

INSTANTIATE_TEST_SUITE_P(
    All, Solid, testing::Combine(testing::ValuesIn(generator_names()), testing::Values<std::size_t>(1000, 3000, 20000)),
    [](const auto& solid) { return std::get<0>(solid.param) + "_" + std::to_string(std::get<1>(solid.param)); });

TEST(Generate, ShuffleKeepsTheSolidAndItsTruth) {
    const Generated plain = generate(Recipe{"plate", 2000, 0, 3, false});
    const Generated shuffled = generate(Recipe{"plate", 2000, 0, 3, true});
    const auto signature = [](const Generated& g) {
        std::vector<std::array<double, 4>> all;
        for (std::size_t f = 0; f < g.truth.size(); ++f) {
            const Vec3 sum = vertex(g, g.mesh.triangles[3 * f]) + vertex(g, g.mesh.triangles[3 * f + 1]) +
                             vertex(g, g.mesh.triangles[3 * f + 2]);
            all.push_back({sum.x, sum.y, sum.z, static_cast<double>(g.truth[f])});
        }
        std::sort(all.begin(), all.end());
        return all;
    };
    EXPECT_NE(plain.truth, shuffled.truth);
    EXPECT_EQ(signature(plain), signature(shuffled));
}

TEST(Generate, NoiseHasTheWantedDeviation) {
    const Generated exact = generate("plate", 20000, 0, 5);
    const Generated noisy = generate("plate", 20000, 0.002, 5);
    ASSERT_EQ(exact.mesh.triangles, noisy.mesh.triangles);
    double sum = 0;
    double squares = 0;
    const std::size_t count = exact.mesh.positions.size() / 3;
    for (std::uint32_t v = 0; v < count; ++v) {
        const double d = norm(vertex(noisy, v) - vertex(exact, v)) / exact.diagonal;
        sum += d;
        squares += d * d;
    }
    EXPECT_NEAR(std::sqrt(squares / static_cast<double>(count)), 0.002, 0.0001);
    EXPECT_NEAR(sum / static_cast<double>(count), 0.002 * std::sqrt(2 / 3.14159265), 0.0001);
}

/// Domes wider than their spheres were not: seeds 637 and 649 of a service's thousand meshes.
TEST(Generate, AnySeedGivesFiniteCoordinates) {
    for (const std::string& name : generator_names()) {
        for (const std::uint64_t seed : {637U, 649U, 3U, 4U, 5U, 6U, 7U, 8U, 9U, 10U}) {
            const Generated part = generate({name, 1000, 0, seed, false});
            const auto& x = part.mesh.positions;
            EXPECT_TRUE(std::all_of(x.begin(), x.end(), [](double v) { return std::isfinite(v); })) << name << seed;
        }
    }
}

TEST(Generate, RefusesWhatMakesNoSense) {
    const auto code = [](const Recipe& recipe) {
        try {
            static_cast<void>(generate(recipe));
        } catch (const Error& error) {
            return error.code();
        }
        return ErrorCode::internal;
    };
    EXPECT_EQ(code({"teapot", 1000}), ErrorCode::invalid_argument);
    EXPECT_EQ(code({"plate", 10}), ErrorCode::invalid_argument);
    EXPECT_EQ(code({"plate", 1000, -1}), ErrorCode::invalid_argument);
    EXPECT_EQ(code({"plate", 1000, std::nan("")}), ErrorCode::invalid_argument);
}

TEST(Generate, QuadricsHaveOneOfEachType) {
    const Generated g = generate("quadrics", 5000);
    std::set<SurfaceType> types;
    for (const auto& s : g.surfaces) types.insert(s.surface.type);
    for (const auto type :
         {SurfaceType::plane, SurfaceType::sphere, SurfaceType::cylinder, SurfaceType::cone, SurfaceType::torus,
          SurfaceType::ellipsoid, SurfaceType::elliptic_cylinder, SurfaceType::elliptic_cone,
          SurfaceType::elliptic_paraboloid, SurfaceType::hyperbolic_paraboloid, SurfaceType::hyperboloid_one_sheet,
          SurfaceType::hyperboloid_two_sheets, SurfaceType::parabolic_cylinder}) {
        EXPECT_TRUE(types.contains(type)) << to_string(type);
    }
}

TEST(Generate, WritesGroundTruth) {
    const Recipe recipe{"plate", 1500, 0, 1, false};
    const Generated g = generate(recipe);
    const std::string json = ground_truth_json(g, recipe);
    for (const char* key : {"\"surface_group\"", "\"brep_face\"", "\"groups\"", "\"half_angle_deg\"",
                            "\"major_radius\"", "\"bbox_diagonal\"", "\"group_adjacency\""}) {
        EXPECT_NE(json.find(key), std::string::npos) << key;
    }
    EXPECT_EQ(json.find("nan"), std::string::npos);
}

}  // namespace
}  // namespace quadseg::datasets
