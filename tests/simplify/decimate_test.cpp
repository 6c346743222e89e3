#include "simplify/decimate.h"

#include "runtime/parallel.h"
#include "tests/simplify/mesh_distance.h"
#include "tests/simplify/openmesh_reference.h"
#include "tests/simplify/small_meshes.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <map>
#include <numbers>
#include <set>

namespace quadseg::simplify {
namespace {

Decimated decimate_to(const SmallMesh& mesh, std::size_t target) {
    DecimateOptions options;
    options.target_faces = target;
    return decimate(mesh.positions, mesh.faces, options);
}

using Edge = std::pair<std::uint32_t, std::uint32_t>;

std::map<Edge, int> edge_uses(const std::vector<Triangle>& faces) {
    std::map<Edge, int> uses;
    for (const Triangle& f : faces) {
        for (std::size_t k = 0; k < 3; ++k) ++uses[std::minmax(f[k], f[(k + 1) % 3])];
    }
    return uses;
}

/// Vertices in use − edges + faces.
long euler_characteristic(const std::vector<Triangle>& faces) {
    std::set<std::uint32_t> vertices;
    for (const Triangle& f : faces) vertices.insert(f.begin(), f.end());
    return static_cast<long>(vertices.size()) - static_cast<long>(edge_uses(faces).size()) +
           static_cast<long>(faces.size());
}

long count_edges(const std::vector<Triangle>& faces, int uses_wanted) {
    long count = 0;
    for (const auto& [edge, uses] : edge_uses(faces)) count += uses == uses_wanted;
    return count;
}

/// Every consistency that a result owes its input, whatever the input.
void expect_sound(const SmallMesh& mesh, const Decimated& result) {
    ASSERT_EQ(result.face_map.size(), mesh.faces.size());
    for (const std::uint32_t f : result.face_map) ASSERT_LT(f, result.faces.size());
    std::set<std::uint32_t> used;
    std::set<std::array<std::uint32_t, 3>> distinct;
    for (Triangle f : result.faces) {
        for (const std::uint32_t v : f) {
            ASSERT_LT(v, result.positions.size());
            used.insert(v);
        }
        EXPECT_TRUE(f[0] != f[1] && f[1] != f[2] && f[2] != f[0]);
        std::sort(f.begin(), f.end());
        distinct.insert(f);
    }
    EXPECT_EQ(distinct.size(), result.faces.size()) << "duplicate faces";
    EXPECT_EQ(used.size(), result.positions.size()) << "isolated vertices";
    for (const Vec3& p : result.positions) EXPECT_TRUE(std::isfinite(squared_norm(p)));
}

bool has_position(const Decimated& result, const Vec3& p, double tolerance) {
    return std::any_of(result.positions.begin(), result.positions.end(),
                       [&](const Vec3& q) { return norm(q - p) <= tolerance; });
}

double total_area(const std::vector<Vec3>& positions, const std::vector<Triangle>& faces) {
    double area = 0;
    for (const Triangle& f : faces) {
        area += 0.5 * norm(cross(positions[f[1]] - positions[f[0]], positions[f[2]] - positions[f[0]]));
    }
    return area;
}

TEST(Decimate, FlatGridCollapsesToAFewFacesWithoutError) {
    const SmallMesh mesh = flat_grid(40);
    const Decimated result = decimate_to(mesh, 8);
    expect_sound(mesh, result);
    EXPECT_LE(result.faces.size(), 8U);
    EXPECT_GE(result.faces.size(), 2U);
    for (const Vec3& corner : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{1, 1, 0}}) {
        EXPECT_TRUE(has_position(result, corner, 1e-9)) << corner.x << ' ' << corner.y;
    }
    for (const Vec3& p : result.positions) EXPECT_NEAR(p.z, 0, 1e-12);
    EXPECT_NEAR(total_area(result.positions, result.faces), 1, 1e-9);
    EXPECT_LT(result.max_error, 1e-7);
}

TEST(Decimate, CubeKeepsItsEightCorners) {
    const SmallMesh mesh = cube(16);
    const Decimated result = decimate_to(mesh, 12);
    expect_sound(mesh, result);
    EXPECT_EQ(result.faces.size(), 12U);
    for (int corner = 0; corner < 8; ++corner) {
        EXPECT_TRUE(has_position(
            result,
            {static_cast<double>(corner & 1), static_cast<double>(corner >> 1 & 1), static_cast<double>(corner >> 2)},
            1e-7))
            << corner;
    }
    EXPECT_NEAR(total_area(result.positions, result.faces), 6, 1e-6);
    EXPECT_EQ(euler_characteristic(result.faces), 2);
}

TEST(Decimate, FaceMapStaysOnItsSideOfTheCreases) {
    const SmallMesh mesh = cube(16);
    for (const std::size_t target : {12U, 100U, 600U}) {
        const Decimated result = decimate_to(mesh, target);
        for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
            const Triangle &f = mesh.faces[i], &g = result.faces[result.face_map[i]];
            const Vec3 n = normalized(
                cross(mesh.positions[f[1]] - mesh.positions[f[0]], mesh.positions[f[2]] - mesh.positions[f[0]]));
            const Vec3 m = normalized(cross(result.positions[g[1]] - result.positions[g[0]],
                                            result.positions[g[2]] - result.positions[g[0]]));
            ASSERT_GT(dot(n, m), 0.99) << "face " << i << " at target " << target;
        }
    }
}

TEST(Decimate, CylinderKeepsRadiusRimsAndTopology) {
    const SmallMesh mesh = open_cylinder(64, 40, 3);
    const Decimated result = decimate_to(mesh, 150);
    expect_sound(mesh, result);
    EXPECT_LE(result.faces.size(), 150U);
    EXPECT_GE(result.faces.size(), 149U);
    EXPECT_EQ(euler_characteristic(result.faces), 0);
    EXPECT_EQ(count_edges(result.faces, 3), 0);
    for (const Vec3& p : result.positions) {
        EXPECT_NEAR(std::hypot(p.x, p.y), 1, 0.03);
        EXPECT_GE(p.z, -1e-6);
        EXPECT_LE(p.z, 3 + 1e-6);
    }
    const MeshDistance d = symmetric_distance(mesh.positions, mesh.faces, result.positions, result.faces, 5000);
    EXPECT_LT(d.rms, 0.02);
}

TEST(Decimate, BorderOfAWavySheetStaysInPlace) {
    const SmallMesh mesh = height_field(40, [](double x, double y) { return 0.1 * std::sin(7 * x) * std::cos(5 * y); });
    const Decimated result = decimate_to(mesh, 300);
    expect_sound(mesh, result);
    EXPECT_EQ(euler_characteristic(result.faces), 1);
    for (const auto& [edge, uses] : edge_uses(result.faces)) {
        if (uses != 1) continue;
        const Vec3 middle = (result.positions[edge.first] + result.positions[edge.second]) * 0.5;
        const double inside = std::min({middle.x, middle.y, 1 - middle.x, 1 - middle.y});
        EXPECT_NEAR(inside, 0, 0.005);
    }
}

TEST(Decimate, TargetAtOrAboveTheInputIsTheIdentity) {
    const SmallMesh mesh = torus(12, 8, 0.3);
    for (const std::size_t target : {mesh.faces.size(), mesh.faces.size() + 5}) {
        const Decimated result = decimate_to(mesh, target);
        EXPECT_EQ(result.faces, mesh.faces);
        ASSERT_EQ(result.positions.size(), mesh.positions.size());
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) EXPECT_EQ(result.positions[i], mesh.positions[i]);
        for (std::size_t i = 0; i < mesh.faces.size(); ++i) EXPECT_EQ(result.face_map[i], i);
        EXPECT_EQ(result.max_error, 0);
    }
}

TEST(Decimate, StopsWhereNothingIsValid) {
    const SmallMesh single = tetrahedron();
    EXPECT_EQ(decimate_to(single, 1).faces.size(), 4U);
    // A torus needs 14 faces, a sphere 4, whatever is asked.
    const SmallMesh ring = torus(20, 10, 0.4);
    const Decimated result = decimate_to(ring, 1);
    expect_sound(ring, result);
    EXPECT_EQ(euler_characteristic(result.faces), 0);
    EXPECT_GE(result.faces.size(), 14U);
    EXPECT_LE(result.faces.size(), 60U);
}

TEST(Decimate, EmptyInputGivesEmptyResult) {
    const Decimated result = decimate({}, {}, {});
    EXPECT_TRUE(result.faces.empty());
    EXPECT_TRUE(result.face_map.empty());
}

TEST(Decimate, DegenerateFacesFindAPlace) {
    SmallMesh mesh = cube(6);
    const std::size_t regular = mesh.faces.size();
    mesh.faces.push_back({3, 3, 4});                                // repeated vertex
    mesh.faces.push_back({7, 7, 7});                                // three times
    mesh.positions.push_back({5, 5, 5});                            // isolated
    mesh.faces.insert(mesh.faces.begin() + 10, Triangle{0, 0, 1});  // in the middle
    const Decimated result = decimate_to(mesh, regular / 4);
    expect_sound(mesh, result);
    EXPECT_LE(result.faces.size(), regular / 4);

    // Nothing but degenerate faces: nothing to collapse.
    SmallMesh dead;
    dead.positions = {{0, 0, 0}, {1, 0, 0}};
    dead.faces = {{0, 0, 1}, {0, 1, 1}};
    EXPECT_EQ(decimate_to(dead, 1).faces, dead.faces);
}

TEST(Decimate, FacesWithoutAreaAndEqualPointsDoNoHarm) {
    SmallMesh mesh = flat_grid(12);
    for (Vec3& p : mesh.positions) p.x = p.x < 0.5 ? 0 : p.x;  // half of the faces have no area
    const Decimated result = decimate_to(mesh, 40);
    expect_sound(mesh, result);
    SmallMesh point = flat_grid(6);
    for (Vec3& p : point.positions) p = {1, 2, 3};
    expect_sound(point, decimate_to(point, 10));
    SmallMesh wrong = flat_grid(6);
    wrong.positions[20].x = std::nan("");
    const Decimated survived = decimate_to(wrong, 10);
    EXPECT_EQ(survived.face_map.size(), wrong.faces.size());
}

TEST(Decimate, NonManifoldEdgesStay) {
    // Three wavy sheets that meet in the line x = 0.
    SmallMesh mesh;
    const std::uint32_t n = 16;
    const auto line = [&](std::uint32_t j) { return j; };
    for (std::uint32_t j = 0; j <= n; ++j) mesh.positions.push_back({0, static_cast<double>(j) / n, 0});
    for (int sheet = 0; sheet < 3; ++sheet) {
        const double angle = 2 * std::numbers::pi * sheet / 3;
        const auto offset = static_cast<std::uint32_t>(mesh.positions.size());
        for (std::uint32_t i = 1; i <= n; ++i) {
            for (std::uint32_t j = 0; j <= n; ++j) {
                const double r = static_cast<double>(i) / n;
                mesh.positions.push_back({r * std::cos(angle), static_cast<double>(j) / n, r * std::sin(angle)});
            }
        }
        const auto at = [&](std::uint32_t i, std::uint32_t j) {
            return i == 0 ? line(j) : offset + (i - 1) * (n + 1) + j;
        };
        for (std::uint32_t i = 0; i < n; ++i) {
            for (std::uint32_t j = 0; j < n; ++j) {
                mesh.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
                mesh.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
            }
        }
    }
    ASSERT_EQ(count_edges(mesh.faces, 3), n);
    const Decimated result = decimate_to(mesh, 120);
    expect_sound(mesh, result);
    EXPECT_EQ(count_edges(result.faces, 3), n);
    for (std::uint32_t j = 0; j <= n; ++j) EXPECT_TRUE(has_position(result, mesh.positions[line(j)], 0));
    EXPECT_LT(result.faces.size(), mesh.faces.size() / 3);
    EXPECT_EQ(euler_characteristic(result.faces), euler_characteristic(mesh.faces));
}

TEST(Decimate, VertexOfTwoFansStays) {
    // Two cubes that share one corner: vertex (1, 1, 1) of the first is (0, 0, 0) of the second.
    const SmallMesh one = cube(6);
    SmallMesh mesh = together(one, one, {1, 1, 1});
    const auto find = [&](const Vec3& p, std::size_t from) {
        for (std::size_t i = from; i < mesh.positions.size(); ++i) {
            if (norm(mesh.positions[i] - p) < 1e-12) return static_cast<std::uint32_t>(i);
        }
        return 0xffffffffU;
    };
    const std::uint32_t shared = find({1, 1, 1}, 0), copy = find({1, 1, 1}, one.positions.size());
    for (Triangle& f : mesh.faces) std::replace(f.begin(), f.end(), copy, shared);
    const Decimated result = decimate_to(mesh, 60);
    expect_sound(mesh, result);
    EXPECT_TRUE(has_position(result, {1, 1, 1}, 0));
    EXPECT_EQ(euler_characteristic(result.faces), 3);  // two spheres in a point
}

TEST(Decimate, ComponentsStayApartAndNoneVanishes) {
    SmallMesh mesh = together(torus(30, 16, 0.3), cube(5), {3, 0, 0});
    mesh = together(mesh, tetrahedron(), {-3, 0, 0});
    mesh = together(mesh, flat_grid(5), {0, 5, 0});
    mesh = together(mesh, SmallMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, {0, -5, 0});
    const Decimated result = decimate_to(mesh, 150);
    expect_sound(mesh, result);
    EXPECT_LE(result.faces.size(), 150U);
    EXPECT_EQ(euler_characteristic(result.faces), 0 + 2 + 2 + 1 + 1);
}

TEST(Decimate, FanOfManyFacesIsNoTrap) {
    SmallMesh mesh;  // a cone of 20,000 faces around one vertex
    const std::uint32_t n = 20000;
    mesh.positions.push_back({0, 0, 1});
    for (std::uint32_t i = 0; i < n; ++i) {
        const double angle = 2 * std::numbers::pi * i / n;
        mesh.positions.push_back({std::cos(angle), std::sin(angle), 0});
    }
    for (std::uint32_t i = 0; i < n; ++i) mesh.faces.push_back({0, i + 1, (i + 1) % n + 1});
    const Decimated result = decimate_to(mesh, 200);
    expect_sound(mesh, result);
    EXPECT_LE(result.faces.size(), 200U);
    EXPECT_TRUE(has_position(result, {0, 0, 1}, 1e-9));
}

TEST(Decimate, FaceMapIsNear) {
    const SmallMesh mesh = torus(120, 60, 0.4);
    const Decimated result = decimate_to(mesh, 800);
    expect_sound(mesh, result);
    double worst = 0;
    for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
        const Triangle &f = mesh.faces[i], &g = result.faces[result.face_map[i]];
        const Vec3 p = (mesh.positions[f[0]] + mesh.positions[f[1]] + mesh.positions[f[2]]) / 3.0;
        worst = std::max(worst, squared_distance_to_triangle(p, result.positions[g[0]], result.positions[g[1]],
                                                             result.positions[g[2]]));
    }
    EXPECT_LT(std::sqrt(worst), 0.03);  // a result face is .2 long, the surface .01 away
    std::set<std::uint32_t> images(result.face_map.begin(), result.face_map.end());
    EXPECT_GT(images.size(), result.faces.size() * 95 / 100);
}

TEST(Decimate, SameBytesAtAnyThreadCount) {
    SmallMesh mesh = torus(200, 80, 0.35);
    for (Vec3& p : mesh.positions) p.z += 0.05 * std::sin(9 * p.x) * std::cos(7 * p.y);
    Decimated reference;
    runtime::in_arena(1, [&] { reference = decimate_to(mesh, 1000); });
    EXPECT_EQ(reference.faces.size(), 1000U);
    for (const int threads : {1, 2, 8}) {
        Decimated result;
        runtime::in_arena(threads, [&] { result = decimate_to(mesh, 1000); });
        EXPECT_EQ(result.faces, reference.faces) << threads;
        EXPECT_EQ(result.face_map, reference.face_map) << threads;
        ASSERT_EQ(result.positions.size(), reference.positions.size());
        EXPECT_EQ(
            std::memcmp(result.positions.data(), reference.positions.data(), reference.positions.size() * sizeof(Vec3)),
            0)
            << threads;
        EXPECT_EQ(result.max_error, reference.max_error);
    }
}

TEST(Decimate, ResultMovesAndScalesWithTheInput) {
    SmallMesh mesh = torus(60, 30, 0.3);
    const Decimated near = decimate_to(mesh, 500);
    for (Vec3& p : mesh.positions) p = p * 1024.0;  // a power of two: exact
    const Decimated far = decimate_to(mesh, 500);
    EXPECT_EQ(near.faces, far.faces);
    EXPECT_NEAR(far.max_error, near.max_error * 1024, 1e-9 * far.max_error);
}

TEST(Decimate, StopsWhenAskedWithAValidMesh) {
    const SmallMesh mesh = torus(150, 80, 0.35);
    for (const int patience : {0, 1, 5, 40, 200}) {
        std::atomic<int> asked{0};
        DecimateOptions options;
        options.target_faces = 100;
        options.should_stop = [&] { return asked.fetch_add(1) >= patience; };
        const Decimated result = decimate(mesh.positions, mesh.faces, options);
        expect_sound(mesh, result);
        EXPECT_GT(result.faces.size(), 100U);
        EXPECT_EQ(euler_characteristic(result.faces), 0);
    }
}

TEST(Decimate, ErrorIsWithinFivePercentOfOpenMesh) {
    SmallMesh wavy = torus(100, 60, 0.35);
    for (Vec3& p : wavy.positions) p.z += 0.05 * std::sin(9 * p.x) * std::cos(7 * p.y);
    struct Case {
        const char* name;
        SmallMesh mesh;
        std::size_t target;
    };
    for (const Case& c : {Case{"wavy torus", wavy, 1000}, Case{"wavy torus, coarser", wavy, 300},
                          Case{"cylinder", open_cylinder(80, 40, 2), 300},
                          Case{"sheet", height_field(60, [](double x, double y) { return x * x * y; }), 300}}) {
        const Decimated ours = decimate_to(c.mesh, c.target);
        const Decimated theirs = decimate_openmesh(c.mesh.positions, c.mesh.faces, c.target);
        const auto error = [&](const Decimated& d) {
            return symmetric_distance(c.mesh.positions, c.mesh.faces, d.positions, d.faces, 20000).rms;
        };
        EXPECT_LE(error(ours), 1.05 * error(theirs)) << c.name;
        EXPECT_NEAR(static_cast<double>(ours.faces.size()), static_cast<double>(theirs.faces.size()), 2) << c.name;
    }
}

TEST(Decimate, FandiskKeepsWithinFivePercentOfOpenMesh) {
    const SmallMesh mesh = read_small_mesh(std::string(QUADSEG_SHARED_DIR) + "/meshes/fandisk.obj");
    if (mesh.faces.empty()) GTEST_SKIP() << "needs the shared meshes";
    const Decimated ours = decimate_to(mesh, 1000);
    expect_sound(mesh, ours);
    EXPECT_EQ(ours.faces.size(), 1000U);
    EXPECT_EQ(euler_characteristic(ours.faces), 2);
    const Decimated theirs = decimate_openmesh(mesh.positions, mesh.faces, 1000);
    // From the input to the result only: theirs has fins, which would make the comparison too easy.
    const auto error = [&](const Decimated& d) {
        return one_sided_distance(mesh.positions, mesh.faces, d.positions, d.faces, 20000).rms;
    };
    EXPECT_LE(error(ours), 1.05 * error(theirs));
}

}  // namespace
}  // namespace quadseg::simplify
