// How faces lie to a surface: the test of growing, selection and every other step that gives faces to surfaces.
#pragma once

#include "exact/candidate.h"
#include "surface/evaluate.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace quadseg::exact {

/// No tessellator lets a facet turn further: the coarsest cylinders have 8 facets (45°), their diagonals turn a little
/// more.
inline constexpr double largest_facet_turn = 75 * std::numbers::pi / 180;

class FaceFitter {
  public:
    FaceFitter(const Scene& scene, const Surface& surface, double largest_turn = largest_facet_turn)
        : scene_(scene),
          evaluate_(surface),
          trim_(scene.tolerances.trim),
          largest_turn_(largest_turn),
          apex_(to_vec3(surface.point)),
          cone_(surface.type == SurfaceType::cone) {}

    double distance(std::size_t f) const {
        double d = 0;
        for (int k = 0; k < 3; ++k) d = std::max(d, std::abs(evaluate_.distance(scene_.mesh.corner(f, k))));
        return d;
    }

    FaceFit operator()(std::size_t f) const {
        FaceFit fit;
        fit.distance = distance(f);
        normal_part(f, fit);
        return fit;
    }

    /// operator()(f).within(tolerance), at once when the distance decides.
    bool accepts(std::size_t f, double tolerance) const {
        FaceFit fit;
        fit.distance = distance(f);
        if (!(fit.distance <= tolerance)) return false;
        normal_part(f, fit);
        return fit.angle <= fit.allowed;
    }

    double vertex_distance(std::uint32_t v) const { return std::abs(evaluate_.distance(scene_.mesh.positions[v])); }

  private:
    static double angle_of_chord(double chord) { return 2 * std::asin(std::min(1.0, chord / 2)); }

    void normal_part(std::size_t f, FaceFit& fit) const {
        Vec3 a = evaluate_.normal(scene_.mesh.corner(f, 0));
        Vec3 b = evaluate_.normal(scene_.mesh.corner(f, 1));
        Vec3 c = evaluate_.normal(scene_.mesh.corner(f, 2));
        if (cone_) {
            // The apex has no normal: a facet that ends there turns by what its other side turns.
            const double near =
                1e-3 * 2 * scene_.mesh.areas[f] / std::max(static_cast<double>(scene_.heights[f]), 1e-300);
            if (norm(scene_.mesh.corner(f, 0) - apex_) <= near) a = normalized(b + c);
            if (norm(scene_.mesh.corner(f, 1) - apex_) <= near) b = normalized(c + a);
            if (norm(scene_.mesh.corner(f, 2) - apex_) <= near) c = normalized(a + b);
        }
        fit.step = angle_of_chord(std::sqrt(std::max({squared_norm(a - b), squared_norm(b - c), squared_norm(c - a)})));
        constexpr double degree = std::numbers::pi / 180;
        // A flat face on a curved surface differs from the surface's normal by what that turns across the face.
        if (fit.step > largest_turn_) {
            fit.angle = std::numeric_limits<double>::infinity();
            return;
        }
        const double height = static_cast<double>(scene_.heights[f]);
        const double tilt = height > 0 ? 3 * trim_ / height : 1e9;
        fit.allowed = std::min(3 * degree + 0.7 * fit.step, 52 * degree) + tilt;
        if (fit.allowed > 132 * degree || !(scene_.mesh.areas[f] > 0)) {
            fit.allowed = std::numeric_limits<double>::infinity();
            return;
        }
        fit.angle = angle_of_chord(norm(normalized(a + b + c) - scene_.mesh.normals[f]));
    }

    const Scene& scene_;
    surface::SurfaceEvaluator evaluate_;
    double trim_, largest_turn_;
    Vec3 apex_;
    bool cone_;
};

}  // namespace quadseg::exact
