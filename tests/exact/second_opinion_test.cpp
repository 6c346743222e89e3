// A loose surface gives way to those on which its vertices lie, and to nothing else.
#include "exact/second_opinion.h"

#include "exact/grow.h"
#include "mesh/work_mesh.h"
#include "runtime/run_control.h"
#include "tests/mesh/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>
#include <numbers>
#include <numeric>
#include <vector>

namespace quadseg::exact {
namespace {

constexpr double radius = 1.5, arc_radius = 21.5, length = 6.7, arc_step = 0.02;
constexpr std::uint32_t facets = 15, arc_columns = 3;

/// A fillet along a straight edge, then along an arc that it is tangent to: a quarter cylinder of one column of facets
/// and a torus of three. Faces of the cylinder first. `roughness`: of the arc's radius, relative.
test::Shape fillet(double roughness) {
    test::Shape s;
    std::vector<std::vector<std::uint32_t>> columns;
    const auto column = [&](double x, double y, double angle, double rough) {
        columns.emplace_back();
        for (std::uint32_t i = 0; i <= facets; ++i) {
            const double v = std::numbers::pi / 2 * i / facets;
            const double r = radius * (1 + rough * std::sin(100.0 * (v + angle)));
            const double inward = -r * std::cos(v);
            columns.back().push_back(
                s.vertex(x + inward * std::cos(angle), y + inward * std::sin(angle), r * std::sin(v)));
        }
    };
    column(arc_radius, -length, 0, 0);
    for (std::uint32_t j = 0; j <= arc_columns; ++j) {
        const double t = arc_step * j;
        column(arc_radius * std::cos(t), arc_radius * std::sin(t), t, j > 0 ? roughness : 0);
    }
    for (std::size_t c = 0; c + 1 < columns.size(); ++c) {
        for (std::uint32_t i = 0; i < facets; ++i) {
            s.quad(columns[c][i], columns[c + 1][i], columns[c + 1][i + 1], columns[c][i + 1]);
        }
    }
    return s;
}

struct FilletScene {
    explicit FilletScene(double roughness) : shape(fillet(roughness)) {}

    test::Shape shape;
    runtime::RunControl control{nullptr};
    mesh::WorkMesh mesh = mesh::build_work_mesh(shape.view(), control);
    Scene scene = build_scene(mesh, control);

    bool is_straight(std::uint32_t f) const { return mesh.input_face[f] < 2 * facets; }

    /// The torus of the arc or the cylinder before it.
    Candidate candidate(bool straight) const {
        Candidate c;
        c.surface.type = straight ? SurfaceType::cylinder : SurfaceType::torus;
        const Vec3 on_axis = mesh.frame.to_unit(straight ? Vec3{arc_radius, 0, 0} : Vec3{0, 0, 0});
        c.surface.point = to_array(on_axis);
        c.surface.axis = straight ? std::array<double, 3>{0, 1, 0} : std::array<double, 3>{0, 0, 1};
        c.surface.radius = (straight ? radius : arc_radius) * mesh.frame.scale;
        c.surface.minor_radius = straight ? 0 : radius * mesh.frame.scale;
        for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
            if (is_straight(f) == straight) c.faces.push_back(f);
        }
        Marks marks;
        measure_candidate(scene, c, marks);
        return c;
    }
};

constexpr double loose = 1.2e-8;  // in the unit frame: nearer than the tolerance, farther than any rounding

/// A torus that passes near all of the fillet.
Candidate accident(const FilletScene& f) {
    Candidate c = f.candidate(false);
    c.faces.resize(f.mesh.face_count());
    std::iota(c.faces.begin(), c.faces.end(), 0U);
    c.area = f.mesh.total_area;
    c.median = loose;
    return c;
}

/// Exact, and so large that the mesh is known to be exact.
Candidate far_away(const FilletScene& f) {
    Candidate c;
    c.surface.type = SurfaceType::plane;
    c.area = 10 * f.mesh.total_area;
    return c;
}

TEST(SecondOpinion, ALooseSurfaceGivesWayToTheExactOnesBeneathIt) {
    const FilletScene f(0);
    std::vector<Candidate> candidates{far_away(f), accident(f)};
    replace_loose(f.scene, candidates);
    const auto found = [&](SurfaceType type) {
        return std::find_if(candidates.begin(), candidates.end(),
                            [&](const Candidate& c) { return c.surface.type == type; });
    };
    ASSERT_NE(found(SurfaceType::cylinder), candidates.end());
    ASSERT_NE(found(SurfaceType::torus), candidates.end());
    EXPECT_NEAR(found(SurfaceType::cylinder)->surface.radius, radius * f.mesh.frame.scale, 1e-9);
    EXPECT_TRUE(std::all_of(candidates.begin(), candidates.end(),
                            [&](const Candidate& c) { return c.faces.size() < f.mesh.face_count(); }));
}

TEST(SecondOpinion, WhereExactOnesAreFoundBeneathAPartOnlyItStays) {
    const FilletScene f(1e-7);  // the arc's vertices lie on nothing
    std::vector<Candidate> candidates{far_away(f), accident(f)};
    replace_loose(f.scene, candidates);
    ASSERT_EQ(candidates.size(), 2U);
    EXPECT_EQ(candidates[1].faces.size(), f.mesh.face_count());
}

}  // namespace
}  // namespace quadseg::exact
