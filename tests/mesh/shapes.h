// Small meshes for the tests, and what every working mesh must fulfil.
#pragma once

#include <quadseg/mesh.h>

#include "math/vec3.h"
#include "mesh/work_mesh.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>
#include <initializer_list>
#include <set>
#include <vector>

namespace quadseg::test {

struct Shape {
    std::vector<double> positions;
    std::vector<std::uint32_t> triangles;
    std::vector<std::uint32_t> polygons;

    MeshView view() const { return {positions, triangles, polygons}; }
    std::uint32_t vertex(double x, double y, double z) {
        for (const double c : {x, y, z}) positions.push_back(c);
        return static_cast<std::uint32_t>(positions.size() / 3 - 1);
    }
    void face(std::uint32_t a, std::uint32_t b, std::uint32_t c) { triangles.insert(triangles.end(), {a, b, c}); }
    void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
        face(a, b, c);
        face(a, c, d);
    }
    std::size_t faces() const { return triangles.size() / 3; }
};

inline Shape tetrahedron() {
    Shape s;
    s.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    s.triangles = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
    return s;
}

inline Shape cube() {
    Shape s;
    for (int i = 0; i < 8; ++i) s.vertex(i & 1, (i >> 1) & 1, (i >> 2) & 1);
    s.quad(0, 2, 3, 1);
    s.quad(4, 5, 7, 6);
    s.quad(0, 1, 5, 4);
    s.quad(2, 6, 7, 3);
    s.quad(0, 4, 6, 2);
    s.quad(1, 3, 7, 5);
    return s;
}

/// nx × ny squares in the plane z = 0, two faces each.
inline Shape grid(std::uint32_t nx, std::uint32_t ny) {
    Shape s;
    for (std::uint32_t j = 0; j <= ny; ++j) {
        for (std::uint32_t i = 0; i <= nx; ++i) s.vertex(i, j, 0);
    }
    for (std::uint32_t j = 0; j < ny; ++j) {
        for (std::uint32_t i = 0; i < nx; ++i) {
            const std::uint32_t a = j * (nx + 1) + i;
            s.quad(a, a + 1, a + nx + 2, a + nx + 1);
        }
    }
    return s;
}

/// Bent over a sphere-like bump, so that no two centroids coincide and normals differ.
inline Shape bumpy_grid(std::uint32_t n) {
    Shape s = grid(n, n);
    for (std::size_t v = 0; v < s.positions.size(); v += 3) {
        s.positions[v + 2] = std::sin(0.37 * s.positions[v]) * std::cos(0.21 * s.positions[v + 1]);
    }
    return s;
}

/// Band of n squares whose last is joined with the first, turned over if `twisted`.
inline Shape band(std::uint32_t n, bool twisted) {
    Shape s;
    for (std::uint32_t i = 0; i < n; ++i) {
        const double t = 2 * M_PI * i / n, half = twisted ? t / 2 : 0;
        for (const double side : {-0.3, 0.3}) {
            const double r = 1 + side * std::cos(half);
            s.vertex(r * std::cos(t), r * std::sin(t), twisted ? side * std::sin(half) : side);
        }
    }
    for (std::uint32_t i = 0; i < n; ++i) {
        std::uint32_t a = 2 * i, b = a + 1, c = 2 * ((i + 1) % n), d = c + 1;
        if (twisted && i + 1 == n) std::swap(c, d);
        s.quad(a, c, d, b);
    }
    return s;
}

/// Every face with vertices of its own.
inline Shape soup(const Shape& s) {
    Shape r;
    for (const std::uint32_t v : s.triangles) {
        r.triangles.push_back(r.vertex(s.positions[3 * v], s.positions[3 * v + 1], s.positions[3 * v + 2]));
    }
    return r;
}

inline Shape joined(const Shape& a, const Shape& b) {
    Shape s = a;
    const auto offset = static_cast<std::uint32_t>(a.positions.size() / 3);
    s.positions.insert(s.positions.end(), b.positions.begin(), b.positions.end());
    for (const std::uint32_t v : b.triangles) s.triangles.push_back(v + offset);
    return s;
}

/// Small generator with the same numbers everywhere.
struct Random {
    std::uint64_t state;
    std::uint64_t next() {
        state += 0x9e3779b97f4a7c15ULL;
        std::uint64_t z = state;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
        return z ^ (z >> 31);
    }
    std::size_t below(std::size_t n) { return static_cast<std::size_t>(next() % n); }
};

inline std::vector<std::uint32_t> random_permutation(std::size_t n, std::uint64_t seed) {
    std::vector<std::uint32_t> p(n);
    for (std::size_t i = 0; i < n; ++i) p[i] = static_cast<std::uint32_t>(i);
    Random random{seed};
    for (std::size_t i = n; i > 1; --i) std::swap(p[i - 1], p[random.below(i)]);
    return p;
}

inline mesh::WorkMesh build(const Shape& s) {
    return mesh::build_work_mesh(s.view(), runtime::RunControl(nullptr));
}

/// What holds for the working mesh of any input.
inline void expect_consistent(const MeshView& input, const mesh::WorkMesh& m) {
    const std::size_t n = m.face_count();
    ASSERT_EQ(m.neighbors.size(), n);
    ASSERT_EQ(m.normals.size(), n);
    ASSERT_EQ(m.areas.size(), n);
    ASSERT_EQ(m.components.size(), n);
    ASSERT_EQ(m.input_face.size(), n);
    ASSERT_EQ(m.input_vertex.size(), m.vertex_count());
    ASSERT_EQ(m.label_source.size(), input.face_count());
    std::size_t links = 0;
    std::int32_t seen_components = 0;
    double area = 0;
    for (std::size_t f = 0; f < n; ++f) {
        std::multiset<std::uint32_t> work, original;
        for (std::size_t k = 0; k < 3; ++k) {
            ASSERT_LT(m.faces[f][k], m.vertex_count());
            work.insert(m.input_vertex[m.faces[f][k]]);
            original.insert(input.triangles[3 * m.input_face[f] + k]);
            const std::int32_t g = m.neighbors[f][k];
            if (g == mesh::no_face) continue;
            ++links;
            ASSERT_GE(g, 0);
            ASSERT_LT(static_cast<std::size_t>(g), n);
            ASSERT_NE(static_cast<std::size_t>(g), f);
            EXPECT_EQ(m.components[f], m.components[static_cast<std::size_t>(g)]);
            // The edge comes back, in the other direction, at the same positions.
            const Vec3 a = m.positions[m.faces[f][k]], b = m.positions[m.faces[f][(k + 1) % 3]];
            bool returns = false;
            for (std::size_t j = 0; j < 3; ++j) {
                const auto h = static_cast<std::size_t>(g);
                returns = returns || (m.neighbors[h][j] == static_cast<std::int32_t>(f) &&
                                      m.positions[m.faces[h][j]] == b && m.positions[m.faces[h][(j + 1) % 3]] == a);
            }
            EXPECT_TRUE(returns) << "face " << f << " edge " << k;
        }
        EXPECT_EQ(work, original);
        EXPECT_EQ(m.label_source[m.input_face[f]], static_cast<std::int32_t>(f));
        ASSERT_LE(m.components[f], seen_components) << "components are numbered by first face";
        if (m.components[f] == seen_components) ++seen_components;
        EXPECT_TRUE(std::isfinite(m.areas[f]) && m.areas[f] >= 0);
        EXPECT_NEAR(norm(m.normals[f]), m.areas[f] > 0 ? 1.0 : 0.0, 1e-12);
        area += m.areas[f];
    }
    EXPECT_NEAR(area, m.total_area, 1e-9 * area);
    EXPECT_EQ(static_cast<std::size_t>(seen_components), m.component_count);
    EXPECT_EQ(m.component_count, m.report.components);
    EXPECT_EQ(links % 2, 0U);
    for (const std::int32_t source : m.label_source) EXPECT_LT(source, static_cast<std::int32_t>(n));
    for (const Vec3& p : m.positions) {
        for (int k = 0; k < 3; ++k) EXPECT_LE(std::abs(p[k]), 0.5 + 1e-12);
    }
}

}  // namespace quadseg::test
