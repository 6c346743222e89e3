#include "exact/facets.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace quadseg::exact {
namespace {

struct Built {
    mesh::WorkMesh mesh;
    Tolerances tolerances;
    Facets facets;
};

Built build(const std::vector<double>& positions, const std::vector<std::uint32_t>& triangles) {
    const runtime::RunControl control(nullptr);
    Built b;
    b.mesh = mesh::build_work_mesh({positions, triangles, {}}, control);
    b.tolerances = choose_tolerances(b.mesh);
    b.facets = find_facets(b.mesh, b.tolerances, face_heights(b.mesh), control);
    return b;
}

std::size_t sure_count(const Facets& facets) {
    std::size_t n = 0;
    for (const Facet& facet : facets.facet) n += facet.sure ? 1 : 0;
    return n;
}

/// Side walls of a prism of n facets round the z axis, each a quad of two triangles, and with caps fanned from vertex
/// 0.
Built prism(int n, bool caps) {
    std::vector<double> p;
    std::vector<std::uint32_t> t;
    for (int i = 0; i < n; ++i) {
        const double a = 2 * std::numbers::pi * i / n;
        for (const double z : {-0.7, 0.9}) p.insert(p.end(), {1.1 * std::cos(a) + 0.3, 1.1 * std::sin(a) - 0.2, z});
    }
    const auto id = [n](int i, int k) { return static_cast<std::uint32_t>(2 * (i % n) + k); };
    for (int i = 0; i < n; ++i) {
        t.insert(t.end(), {id(i, 0), id(i + 1, 0), id(i + 1, 1), id(i, 0), id(i + 1, 1), id(i, 1)});
    }
    for (int i = 1; caps && i + 1 < n; ++i) {
        t.insert(t.end(), {id(0, 0), id(i + 1, 0), id(i, 0), id(0, 1), id(i, 1), id(i + 1, 1)});
    }
    return build(p, t);
}

TEST(Facets, StripsOfACylinderAreFacetsButNotSurePlanes) {
    const Built b = prism(24, false);
    EXPECT_EQ(b.facets.count(), 24U);
    EXPECT_EQ(sure_count(b.facets), 0U);
}

TEST(Facets, CapsWithVerticesOffTwoLinesAreSurePlanes) {
    const Built b = prism(24, true);
    EXPECT_EQ(b.facets.count(), 26U);
    EXPECT_EQ(sure_count(b.facets), 2U);
}

TEST(Facets, AFacetWithAnInteriorVertexIsASurePlane) {
    const Built b =
        build({0, 0, 0, 1, 0, 0.01, 1, 1, 0.03, 0, 1, 0.02, 0.5, 0.5, 0.015}, {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4});
    EXPECT_EQ(b.facets.count(), 1U);
    EXPECT_EQ(sure_count(b.facets), 1U);
}

TEST(Facets, EveryFaceIsInOneFacetAndTheListsAgree) {
    const Built b = prism(7, true);
    std::size_t listed = 0;
    for (std::size_t i = 0; i < b.facets.count(); ++i) {
        for (std::size_t j = b.facets.begin[i]; j < b.facets.begin[i + 1]; ++j, ++listed) {
            EXPECT_EQ(b.facets.of_face[b.facets.face[j]], static_cast<std::int32_t>(i));
        }
    }
    EXPECT_EQ(listed, b.mesh.face_count());
}

TEST(CoordinatePrecision, RoundNumbersAreExactAndFloatsAreNot) {
    const runtime::RunControl control(nullptr);
    const std::vector<std::uint32_t> t{0, 1, 2, 0, 2, 3};
    const std::vector<double> round{0, 0, 0, 1, 0, 0, 1, 1, 0.5, 0, 1, 0.25};
    EXPECT_LT(coordinate_precision(mesh::build_work_mesh({round, t, {}}, control)), 1e-7);
    std::vector<double> digits, floats;
    for (int i = 0; i < 12; ++i) {
        const double x = std::sin(1.0 + 7 * i) * 3;
        digits.push_back(std::round(x * 1e5) / 1e5);
        floats.push_back(static_cast<double>(static_cast<float>(x)));
    }
    const double text = coordinate_precision(mesh::build_work_mesh({digits, t, {}}, control));
    const double binary = coordinate_precision(mesh::build_work_mesh({floats, t, {}}, control));
    EXPECT_GT(text, 1e-7);
    EXPECT_LT(text, 1e-5);
    EXPECT_GT(binary, 1e-10);
    EXPECT_LT(binary, 1e-7);
}

TEST(CoordinatePrecision, FloatsReadFromATextAreAsRoundAsThat) {
    const runtime::RunControl control(nullptr);
    std::vector<std::uint32_t> t;
    std::vector<double> floats, five, some;
    for (std::uint32_t i = 0; i < 300; ++i) {
        if (i % 3 == 0) t.insert(t.end(), {i, i + 1, i + 2});
        for (std::uint32_t k = 0; k < 3; ++k) {
            const double x = std::sin(1.0 + 7 * i + 2 * k) * 3;
            floats.push_back(static_cast<double>(static_cast<float>(x)));
            five.push_back(static_cast<double>(static_cast<float>(std::round(x * 1e5) / 1e5)));
            // A fifth was computed from the others.
            some.push_back(i % 5 == 0 ? floats.back() : five.back());
        }
    }
    const auto precision = [&](const std::vector<double>& x) {
        const mesh::WorkMesh mesh = mesh::build_work_mesh({x, t, {}}, control);
        return coordinate_precision(mesh) / mesh.frame.scale;
    };
    EXPECT_LT(precision(floats), 1e-7);
    EXPECT_NEAR(precision(five), 0.29e-5, 1e-7);
    EXPECT_NEAR(precision(some), 0.29e-5, 1e-7);
}

}  // namespace
}  // namespace quadseg::exact
