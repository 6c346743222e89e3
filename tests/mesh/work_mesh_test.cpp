#include "mesh/work_mesh.h"

#include <quadseg/error.h>

#include "runtime/parallel.h"
#include "tests/mesh/shapes.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <gtest/gtest.h>
#include <limits>
#include <numeric>
#include <tbb/global_control.h>

namespace quadseg::test {
namespace {

using mesh::WorkMesh;

std::size_t open_edges(const WorkMesh& m) {
    std::size_t count = 0;
    for (const auto& n : m.neighbors) count += static_cast<std::size_t>(std::count(n.begin(), n.end(), mesh::no_face));
    return count;
}

ErrorCode code_of(const Shape& s, std::string* text = nullptr) {
    try {
        build(s);
    } catch (const Error& e) {
        if (text) *text = e.what();
        return e.code();
    }
    ADD_FAILURE() << "no error";
    return ErrorCode::internal;
}

TEST(WorkMesh, Tetrahedron) {
    const Shape s = tetrahedron();
    const WorkMesh m = build(s);
    expect_consistent(s.view(), m);
    EXPECT_EQ(m.face_count(), 4U);
    EXPECT_EQ(m.component_count, 1U);
    EXPECT_EQ(open_edges(m), 0U);
    EXPECT_EQ(m.report.border_edges, 0U);
    EXPECT_EQ(m.report.flipped_faces, 0U);
    EXPECT_EQ(m.report.non_manifold_vertices, 0U);
    EXPECT_DOUBLE_EQ(m.report.diagonal, std::sqrt(3.0));
    EXPECT_NEAR(m.report.area, 1.5 + std::sqrt(3.0) / 2, 1e-15);
    for (std::size_t f = 0; f < 4; ++f) EXPECT_GT(dot(m.normals[f], m.centroid(f) - Vec3{-0.25, -0.25, -0.25}), 0);
}

TEST(WorkMesh, CubeHasUnitFrameAndSixAreas) {
    Shape s = cube();
    for (double& x : s.positions) x = 5 + 3 * x;
    const WorkMesh m = build(s);
    expect_consistent(s.view(), m);
    EXPECT_NEAR(m.total_area, 6, 1e-14);
    EXPECT_NEAR(m.report.area, 54, 1e-12);
    EXPECT_NEAR(m.frame.diagonal, std::sqrt(3.0), 1e-15);
    for (std::size_t v = 0; v < m.vertex_count(); ++v) {
        const double* p = &s.positions[3 * m.input_vertex[v]];
        EXPECT_NEAR(norm(m.frame.to_input(m.positions[v]) - Vec3{p[0], p[1], p[2]}), 0, 1e-14);
    }
}

TEST(WorkMesh, OpenGridCountsItsBorder) {
    const Shape s = grid(7, 4);
    const WorkMesh m = build(s);
    expect_consistent(s.view(), m);
    EXPECT_EQ(m.report.border_edges, 22U);
    EXPECT_EQ(open_edges(m), 22U);
    EXPECT_EQ(m.report.stitched_edges, 0U);
    EXPECT_EQ(m.report.non_manifold_vertices, 0U);
}

TEST(WorkMesh, VerticesAreNumberedByFirstUse) {
    const WorkMesh m = build(bumpy_grid(20));
    std::uint32_t next = 0;
    for (const auto& t : m.faces) {
        for (const std::uint32_t v : t) {
            ASSERT_LE(v, next);
            if (v == next) ++next;
        }
    }
    EXPECT_EQ(next, m.vertex_count());
}

TEST(WorkMesh, TurnedFacesAgreeAgain) {
    Shape s = cube();
    std::swap(s.triangles[1], s.triangles[2]);
    std::swap(s.triangles[16], s.triangles[17]);
    const WorkMesh m = build(s);
    expect_consistent(s.view(), m);
    EXPECT_EQ(m.report.flipped_faces, 2U);
    EXPECT_EQ(m.report.unorientable_edges, 0U);
    for (std::size_t f = 0; f < m.face_count(); ++f) EXPECT_GT(dot(m.normals[f], m.centroid(f)), 0);
}

TEST(WorkMesh, InsideOutSolidIsLeftAlone) {
    Shape s = cube();
    for (std::size_t f = 0; f < s.faces(); ++f) std::swap(s.triangles[3 * f], s.triangles[3 * f + 1]);
    const WorkMesh m = build(s);
    EXPECT_EQ(m.report.flipped_faces, 0U);
    for (std::size_t f = 0; f < m.face_count(); ++f) EXPECT_LT(dot(m.normals[f], m.centroid(f)), 0);
}

TEST(WorkMesh, OnlyTheSmallerPartIsTurnedWhateverTheOrder) {
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
        Shape s = bumpy_grid(10);
        Random random{seed};
        std::set<std::size_t> turned;
        for (int i = 0; i < 40; ++i) {
            const std::size_t f = random.below(s.faces());
            if (turned.insert(f).second) std::swap(s.triangles[3 * f], s.triangles[3 * f + 1]);
        }
        const WorkMesh m = build(s);
        expect_consistent(s.view(), m);
        EXPECT_EQ(m.report.flipped_faces, turned.size());
        for (const Vec3& n : m.normals) EXPECT_GT(n.z, 0);
    }
}

TEST(WorkMesh, MoebiusStripIsCutOnce) {
    const Shape s = band(12, true);
    const WorkMesh m = build(s);
    expect_consistent(s.view(), m);
    EXPECT_GE(m.report.unorientable_edges, 1U);
    EXPECT_LE(m.report.unorientable_edges, 2U);
    EXPECT_EQ(m.component_count, 1U);
    EXPECT_EQ(open_edges(m), m.report.border_edges + 2 * m.report.unorientable_edges);

    const WorkMesh plain = build(band(12, false));
    EXPECT_EQ(plain.report.unorientable_edges, 0U);
    EXPECT_EQ(plain.report.flipped_faces, 0U);
}

TEST(WorkMesh, ThreeFacesAtAnEdgeAreNotNeighbours) {
    Shape s;
    s.positions = {0, 0, 0, 0, 0, 1, 1, 0, 0, -1, 1, 0, -1, -1, 0};
    s.triangles = {0, 1, 2, 0, 1, 3, 1, 0, 4};
    const WorkMesh m = build(s);
    expect_consistent(s.view(), m);
    EXPECT_EQ(m.report.non_manifold_edges, 1U);
    EXPECT_EQ(m.report.border_edges, 6U);
    EXPECT_EQ(m.component_count, 3U);
    EXPECT_EQ(m.report.non_manifold_vertices, 2U);
    EXPECT_EQ(m.report.flipped_faces, 0U);
}

TEST(WorkMesh, TwoSolidsTouchingAtAVertex) {
    Shape s = joined(tetrahedron(), tetrahedron());
    for (std::size_t i = 12; i < 24; ++i) s.positions[i] = -s.positions[i];
    for (std::size_t f = 4; f < 8; ++f) std::swap(s.triangles[3 * f], s.triangles[3 * f + 1]);
    for (std::uint32_t& v : s.triangles) v = v == 4 ? 0 : v;
    const WorkMesh m = build(s);
    expect_consistent(s.view(), m);
    EXPECT_EQ(m.component_count, 2U);
    EXPECT_EQ(m.report.non_manifold_vertices, 1U);
    EXPECT_EQ(m.report.isolated_vertices, 1U);
    EXPECT_EQ(m.report.non_manifold_edges, 0U);
}

TEST(WorkMesh, DuplicatesTakeTheLabelOfTheFirst) {
    Shape s = tetrahedron();
    s.face(1, 0, 2);  // face 0 again, and once more turned over
    s.face(0, 1, 2);
    s.face(3, 2, 0);  // face 3 again
    const WorkMesh m = build(s);
    expect_consistent(s.view(), m);
    EXPECT_EQ(m.face_count(), 4U);
    EXPECT_EQ(m.report.duplicate_faces, 3U);
    EXPECT_EQ(m.report.non_manifold_edges, 0U);
    EXPECT_EQ(m.report.border_edges, 0U);
    EXPECT_EQ(m.label_source[4], m.label_source[0]);
    EXPECT_EQ(m.label_source[5], m.label_source[0]);
    EXPECT_EQ(m.label_source[6], m.label_source[3]);
}

TEST(WorkMesh, RepeatedIndexTakesANeighboursLabel) {
    Shape s = grid(3, 3);
    const std::uint32_t a = s.triangles[0], b = s.triangles[1];  // an edge of face 0 only
    s.face(a, b, a);
    s.face(15, 15, 15);  // a corner of the grid
    const std::uint32_t lone = s.vertex(1, 1, 0);
    s.face(lone, lone, lone);
    const WorkMesh m = build(s);
    expect_consistent(s.view(), m);
    EXPECT_EQ(m.report.degenerate_faces, 3U);
    EXPECT_EQ(m.label_source[18], m.label_source[0]);
    EXPECT_TRUE(m.label_source[19] == m.label_source[16] || m.label_source[19] == m.label_source[17]);
    EXPECT_EQ(m.label_source[20], mesh::no_face);

    std::vector<std::int32_t> labels(m.face_count());
    std::iota(labels.begin(), labels.end(), 0);
    const auto back = mesh::labels_to_input(m, labels);
    EXPECT_EQ(back[20], -1);
    EXPECT_EQ(back[18], back[0]);
    EXPECT_EQ(mesh::labels_from_input(m, back), labels);
}

TEST(WorkMesh, FacesWithoutAreaStayAndConnect) {
    Shape s;  // two triangles joined by a face whose corners are on one line
    s.positions = {0, 0, 0, 2, 0, 0, 1, 0, 0, 1, -1, 0, 0.5, 1, 0};
    s.triangles = {0, 3, 1, 0, 1, 2, 0, 2, 4};
    const WorkMesh m = build(s);
    expect_consistent(s.view(), m);
    EXPECT_EQ(m.face_count(), 3U);
    EXPECT_EQ(m.report.degenerate_faces, 1U);
    EXPECT_EQ(m.component_count, 1U);
    const auto flat = static_cast<std::size_t>(m.label_source[1]);
    EXPECT_EQ(m.normals[flat], Vec3{});
    EXPECT_EQ(m.areas[flat], 0);
}

TEST(WorkMesh, CollinearFaceHasNoNormalWhereverItLies) {
    // Coordinates that the unit frame rounds: the difference must not become a normal.
    Shape s = grid(2, 2);
    for (std::size_t v = 0; v < s.positions.size(); v += 3) s.positions[v] = 0.1 + s.positions[v] * 0.3;
    const auto a = s.vertex(0.7, 0.7, 0.7), b = s.vertex(0.7 + 1.0 / 1024, 0.7, 0.7),
               c = s.vertex(0.7 + 3.0 / 1024, 0.7, 0.7);
    s.face(a, b, c);
    const WorkMesh m = build(s);
    EXPECT_EQ(m.report.degenerate_faces, 1U);
}

TEST(WorkMesh, SliversKeepTheirNormal) {
    Shape s = grid(1, 1);
    const auto a = s.vertex(0, 0, 0.5), b = s.vertex(1, 0, 0.5), c = s.vertex(0.3, 1e-6, 0.5);
    s.face(a, b, c);
    const WorkMesh m = build(s);
    EXPECT_EQ(m.report.degenerate_faces, 0U);
    const auto sliver = static_cast<std::size_t>(m.label_source[2]);
    EXPECT_NEAR(m.normals[sliver].z, 1, 1e-9);
}

TEST(WorkMesh, IsolatedVerticesAreIgnoredEvenIfNotFinite) {
    Shape s = tetrahedron();
    s.vertex(100, 100, 100);
    s.vertex(std::numeric_limits<double>::quiet_NaN(), 0, 0);
    const WorkMesh m = build(s);
    EXPECT_EQ(m.report.isolated_vertices, 2U);
    EXPECT_EQ(m.vertex_count(), 4U);
    EXPECT_DOUBLE_EQ(m.report.diagonal, std::sqrt(3.0));
}

TEST(WorkMesh, SoupIsStitched) {
    for (const Shape& solid : {cube(), band(9, false), bumpy_grid(6)}) {
        const Shape s = soup(solid);
        const WorkMesh welded = build(solid), m = build(s);
        expect_consistent(s.view(), m);
        EXPECT_EQ(m.component_count, 1U);
        EXPECT_EQ(m.report.border_edges, 3 * s.faces());
        EXPECT_EQ(open_edges(m), open_edges(welded));
        EXPECT_EQ(2 * m.report.stitched_edges + open_edges(m), 3 * s.faces());
    }
}

TEST(WorkMesh, StitchingTakesMinusZeroForZero) {
    Shape s;
    s.positions = {0.0, 0, 0, 0, 1, 0, 1, 0, 0, -0.0, 0, -0.0, -1, 0, 0, 0, 1, -0.0};
    s.triangles = {0, 2, 1, 3, 5, 4};
    const WorkMesh m = build(s);
    EXPECT_EQ(m.report.stitched_edges, 1U);
    EXPECT_EQ(m.component_count, 1U);
}

TEST(WorkMesh, StitchingNeverJoinsThreeOrFacesOfOneDirection) {
    Shape three = soup(tetrahedron());
    const Shape one = soup(tetrahedron());
    three.triangles.clear();
    three.positions.clear();
    for (const double angle : {0.0, 2.0, 4.0}) {
        const auto a = three.vertex(0, 0, 0), b = three.vertex(0, 0, 1);
        const auto c = three.vertex(std::cos(angle), std::sin(angle), 0);
        three.face(a, b, c);
    }
    const WorkMesh m = build(three);
    EXPECT_EQ(m.report.stitched_edges, 0U);
    EXPECT_EQ(m.component_count, 3U);

    Shape same;
    same.positions = {0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 0, 0, 0, 1, -1, 0, 0};
    same.triangles = {0, 1, 2, 3, 4, 5};
    EXPECT_EQ(build(same).report.stitched_edges, 0U);
}

TEST(WorkMesh, PolygonsAreNamedByTheirFirstWorkFace) {
    Shape s = grid(4, 4);
    for (std::uint32_t f = 0; f < 32; ++f) s.polygons.push_back(f / 2);
    s.face(0, 0, 5);  // collapsed part of a last polygon of its own
    s.polygons.push_back(99);
    const WorkMesh m = build(s);
    ASSERT_EQ(m.polygon.size(), 32U);
    for (std::uint32_t p = 0; p < 16; ++p) {
        const std::int32_t a = m.label_source[2 * p], b = m.label_source[2 * p + 1];
        EXPECT_EQ(m.polygon[static_cast<std::size_t>(a)], std::min(a, b));
        EXPECT_EQ(m.polygon[static_cast<std::size_t>(b)], std::min(a, b));
    }
    Shape all = grid(4, 4);
    for (std::uint32_t f = 0; f < 32; ++f) all.polygons.push_back(f);
    EXPECT_TRUE(build(all).polygon.empty());
}

TEST(WorkMesh, ErrorsNameThePlace) {
    std::string text;
    Shape s = tetrahedron();
    s.triangles[7] = 4;
    EXPECT_EQ(code_of(s, &text), ErrorCode::invalid_mesh);
    EXPECT_NE(text.find("face 2"), std::string::npos) << text;
    s = tetrahedron();
    s.positions[10] = std::numeric_limits<double>::infinity();
    EXPECT_EQ(code_of(s, &text), ErrorCode::invalid_mesh);
    EXPECT_NE(text.find("vertex 3"), std::string::npos) << text;
    s = tetrahedron();
    s.positions.pop_back();
    EXPECT_EQ(code_of(s), ErrorCode::invalid_argument);
    s = tetrahedron();
    s.triangles.pop_back();
    EXPECT_EQ(code_of(s), ErrorCode::invalid_argument);
    s = tetrahedron();
    s.polygons = {0, 0};
    EXPECT_EQ(code_of(s), ErrorCode::invalid_argument);
}

TEST(WorkMesh, NothingThatHasAnAreaIsAnError) {
    EXPECT_EQ(code_of(Shape{}), ErrorCode::empty_mesh);
    Shape s = tetrahedron();
    s.triangles = {0, 0, 1, 2, 2, 2};
    EXPECT_EQ(code_of(s), ErrorCode::empty_mesh);
    s = tetrahedron();
    for (std::size_t v = 0; v < 4; ++v) s.positions[3 * v + 1] = s.positions[3 * v + 2] = 0;
    EXPECT_EQ(code_of(s), ErrorCode::empty_mesh);
    s = tetrahedron();
    std::fill(s.positions.begin(), s.positions.end(), 7.5);
    EXPECT_EQ(code_of(s), ErrorCode::empty_mesh);
}

TEST(WorkMesh, ExtremeScales) {
    for (const double scale : {1e-300, 1e-150, 1e-30, 1e30, 1e150, 1e300}) {
        Shape s = cube();
        for (double& x : s.positions) x *= scale;
        const WorkMesh m = build(s);
        expect_consistent(s.view(), m);
        EXPECT_NEAR(m.total_area, 6, 1e-12) << scale;
        EXPECT_EQ(m.report.degenerate_faces, 0U) << scale;
    }
    Shape tiny = cube();
    for (double& x : tiny.positions) x *= 1e-310;
    EXPECT_EQ(code_of(tiny), ErrorCode::empty_mesh);
    Shape huge = cube();
    for (double& x : huge.positions) x = (2 * x - 1) * 1.5e308;
    EXPECT_EQ(code_of(huge), ErrorCode::invalid_mesh);
}

TEST(WorkMesh, FarFromTheOrigin) {
    Shape s = bumpy_grid(30);
    for (double& x : s.positions) x = std::ldexp(std::round(std::ldexp(x, 20)), -20);
    const WorkMesh near = build(s);
    for (double& x : s.positions) x += 1 << 26;  // exact
    const WorkMesh far = build(s);
    EXPECT_GT(far.report.offset, 1e6);
    EXPECT_EQ(far.input_face, near.input_face);
    EXPECT_EQ(far.neighbors, near.neighbors);
    for (std::size_t f = 0; f < near.face_count(); ++f) {
        EXPECT_LT(norm(far.normals[f] - near.normals[f]), 1e-15);
        EXPECT_NEAR(far.areas[f], near.areas[f], 1e-15);
    }
}

TEST(WorkMesh, PermutedInputGivesTheSameMesh) {
    const Shape s = joined(bumpy_grid(40), cube());
    const WorkMesh m = build(s);
    const auto fp = random_permutation(s.faces(), 5), vp = random_permutation(s.positions.size() / 3, 6);
    Shape p = s;
    for (std::size_t v = 0; v < vp.size(); ++v) {
        for (std::size_t k = 0; k < 3; ++k) p.positions[3 * vp[v] + k] = s.positions[3 * v + k];
    }
    for (std::size_t f = 0; f < fp.size(); ++f) {
        // Also the corner that a face begins with varies.
        for (std::size_t k = 0; k < 3; ++k) p.triangles[3 * fp[f] + (k + f) % 3] = vp[s.triangles[3 * f + k]];
    }
    const WorkMesh q = build(p);
    EXPECT_EQ(q.faces, m.faces);
    EXPECT_EQ(q.neighbors, m.neighbors);
    EXPECT_EQ(q.components, m.components);
    EXPECT_EQ(std::memcmp(q.positions.data(), m.positions.data(), m.positions.size() * sizeof(Vec3)), 0);
    for (std::size_t f = 0; f < m.face_count(); ++f) ASSERT_EQ(q.input_face[f], fp[m.input_face[f]]);
}

TEST(WorkMesh, FacesOfOneCentroidHaveOneOrder) {
    // A triangle, and the same turned by half a circle about its centroid.
    Shape s;
    for (const auto& [x, y] : {std::pair{0, 0}, {12, 0}, {0, 9}, {8, 6}, {-4, 6}, {8, -3}}) s.vertex(x, y, 0);
    for (std::uint32_t i = 0; i < 3; ++i) {
        for (std::uint32_t j = 0; j < 3; ++j) {
            Shape p = s;
            p.face(i, (i + 1) % 3, (i + 2) % 3);
            p.face(3 + j, 3 + (j + 1) % 3, 3 + (j + 2) % 3);
            const WorkMesh m = build(p);
            EXPECT_EQ(m.input_face, (std::vector<std::uint32_t>{0, 1})) << i << j;
            EXPECT_EQ(m.input_vertex, (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5})) << i << j;
        }
    }
}

TEST(WorkMesh, SameAtAnyNumberOfThreads) {
    // Every repair is at work: duplicates, turned faces, soup, collapsed faces, several components.
    Shape s = joined(joined(bumpy_grid(90), soup(band(200, false))), band(33, true));
    Random random{3};
    const std::size_t n = s.faces();
    for (int i = 0; i < 300; ++i) {
        const std::size_t f = random.below(n);
        s.face(s.triangles[3 * f + 1], s.triangles[3 * f + 2], s.triangles[3 * f]);
        std::swap(s.triangles[3 * random.below(n)], s.triangles[3 * random.below(n)]);
        const std::size_t g = random.below(n);
        s.face(s.triangles[3 * g], s.triangles[3 * g], s.triangles[3 * g + 1]);
        const std::size_t h = random.below(n);
        std::swap(s.triangles[3 * h], s.triangles[3 * h + 1]);
    }
    const tbb::global_control more_than_cores(tbb::global_control::max_allowed_parallelism, 8);
    WorkMesh one;
    runtime::in_arena(1, [&] { one = build(s); });
    expect_consistent(s.view(), one);
    EXPECT_GT(one.report.duplicate_faces, 0U);
    EXPECT_GT(one.report.flipped_faces, 0U);
    EXPECT_GT(one.report.stitched_edges, 0U);
    for (const int threads : {2, 3, 8}) {
        WorkMesh many;
        runtime::in_arena(threads, [&] { many = build(s); });
        EXPECT_EQ(many.faces, one.faces);
        EXPECT_EQ(many.neighbors, one.neighbors);
        EXPECT_EQ(many.components, one.components);
        EXPECT_EQ(many.input_face, one.input_face);
        EXPECT_EQ(many.label_source, one.label_source);
        EXPECT_EQ(std::memcmp(many.normals.data(), one.normals.data(), one.normals.size() * sizeof(Vec3)), 0);
        EXPECT_EQ(many.total_area, one.total_area);
        EXPECT_EQ(many.report.unorientable_edges, one.report.unorientable_edges);
    }
}

TEST(WorkMesh, FanOfAMillionFacesIsFast) {
    constexpr std::uint32_t n = 1'000'000;
    Shape s;
    for (std::uint32_t i = 0; i < n; ++i) s.vertex(std::cos(2 * M_PI * i / n), std::sin(2 * M_PI * i / n), 0);
    const auto hub = s.vertex(0, 0, 1);
    for (std::uint32_t i = 0; i < n; ++i) s.face(hub, i, (i + 1) % n);
    const auto begin = std::chrono::steady_clock::now();
    const WorkMesh m = build(s);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));  // a quadratic step takes hours
    EXPECT_EQ(m.component_count, 1U);
    EXPECT_EQ(m.report.border_edges, n);
    EXPECT_EQ(m.report.non_manifold_vertices, 0U);
}

TEST(WorkMesh, EdgeOfManyFaces) {
    Shape s;
    const auto a = s.vertex(0, 0, 0), b = s.vertex(0, 0, 1);
    for (int i = 0; i < 20000; ++i) s.face(a, b, s.vertex(std::cos(0.01 * i), std::sin(0.01 * i), 0.1 * i));
    const WorkMesh m = build(s);
    EXPECT_EQ(m.report.non_manifold_edges, 1U);
    EXPECT_EQ(m.component_count, 20000U);
}

TEST(WorkMesh, StopsWhenCancelled) {
    Context context;
    context.cancel();
    const runtime::RunControl control(&context);
    const Shape s = bumpy_grid(100);
    EXPECT_THROW(mesh::build_work_mesh(s.view(), control), runtime::Stopped);
}

TEST(VertexFaces, ListsEveryCornerOnceAscending) {
    const WorkMesh m = build(joined(bumpy_grid(15), cube()));
    const mesh::VertexFaces vf = mesh::vertex_faces(m);
    ASSERT_EQ(vf.begin.size(), m.vertex_count() + 1);
    EXPECT_EQ(vf.begin.back(), 3 * m.face_count());
    for (std::size_t v = 0; v < m.vertex_count(); ++v) {
        for (std::uint32_t i = vf.begin[v]; i < vf.begin[v + 1]; ++i) {
            const auto& t = m.faces[vf.face[i]];
            EXPECT_TRUE(std::find(t.begin(), t.end(), v) != t.end());
            if (i > vf.begin[v]) {
                EXPECT_LT(vf.face[i - 1], vf.face[i]);
            }
        }
    }
}

}  // namespace
}  // namespace quadseg::test
