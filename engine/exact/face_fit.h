// How faces lie to a surface: the test of growing, selection and every other step that gives faces to surfaces.
#pragma once

#include "exact/candidate.h"
#include "surface/evaluate.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>

namespace quadseg::exact {

/// No tessellator lets a facet turn further: the coarsest cylinders have 8 facets (45°), their diagonals turn a little
/// more.
inline constexpr double largest_facet_turn = 75 * std::numbers::pi / 180;

/// Facets of a ruled surface that turn so much further than the others of it, and by so much, are flats whose edges lie
/// on it.
inline constexpr double flat_to_facet = 2.5, least_flat_turn = 15 * std::numbers::pi / 180;

/// A facet of several triangles (fans of single ones close the ends of rows) that turns further than facets of a ruled
/// surface with that typical step do.
inline bool is_flat_cut(const Scene& scene, std::size_t f, const FaceFit& fit, SurfaceType type, double typical_step) {
    const bool ruled = type == SurfaceType::cylinder || type == SurfaceType::cone;
    return ruled && fit.step > std::max(flat_to_facet * typical_step, least_flat_turn) &&
           scene.facets.size(static_cast<std::size_t>(scene.facets.of_face[f])) > 1;
}

class FaceFitter {
  public:
    FaceFitter(const Scene& scene, const Surface& surface, double largest_turn = largest_facet_turn)
        : scene_(scene),
          evaluate_(surface),
          trim_(scene.tolerances.trim),
          largest_turn_(largest_turn),
          point_(to_vec3(surface.point)),
          plane_normal_(normalized(3.0 * to_vec3(surface.axis))),
          squared_least_turn_(largest_turn > 2 * least_allowed ? least_allowed * least_allowed : -1) {}

    double distance(std::size_t f) const {
        return evaluate_.visit([&](const auto& e) { return distance(e, f); });
    }

    FaceFit operator()(std::size_t f) const {
        return evaluate_.visit([&](const auto& e) {
            FaceFit fit;
            fit.distance = distance(e, f);
            normal_part(f, normals_at(e, f), fit);
            return fit;
        });
    }

    /// operator()(f).within(tolerance), at once when the distance or a normal that is allowed everywhere decides.
    bool accepts(std::size_t f, double tolerance) const {
        return evaluate_.visit([&](const auto& e) {
            FaceFit fit;
            fit.distance = distance(e, f);
            if (!(fit.distance <= tolerance)) return false;
            const Normals normals = normals_at(e, f);
            if (normals.squared_step <= squared_least_turn_ &&
                squared_norm(normals.mean - scene_.mesh.normals[f]) <= least_allowed * least_allowed) {
                return true;
            }
            normal_part(f, normals, fit);
            return fit.angle <= fit.allowed;
        });
    }

    /// Whether the middle of a face is farther off than a surface that turns as little across it can be: a flat that a
    /// torus is tangent to lies on it with all vertices and normals, and spans its hole.
    bool spans_a_hole(std::size_t f, const FaceFit& fit) const {
        const double off = std::abs(evaluate_.distance(scene_.mesh.centroid(f)));
        const double height = std::max(static_cast<double>(scene_.heights[f]), 1e-300);
        const double longest = 2 * scene_.mesh.areas[f] / height;
        return off > trim_ + fit.distance + longest * (fit.step + fit.angle);
    }

    double vertex_distance(std::uint32_t v) const { return std::abs(evaluate_.distance(scene_.mesh.positions[v])); }

  private:
    /// Of the surface at the vertices of a face.
    struct Normals {
        Vec3 mean;
        double squared_step = 0;  ///< largest squared difference of two
    };

    /// Chord of the angle that a face of any size is allowed: a little less than 3 degrees.
    static constexpr double least_allowed = 0.052;

    static double angle_of_chord(double chord) { return 2 * std::asin(std::min(1.0, chord / 2)); }

    double distance(const auto& evaluator, std::size_t f) const {
        double d = 0;
        for (int k = 0; k < 3; ++k) d = std::max(d, std::abs(evaluator.distance(scene_.mesh.corner(f, k))));
        return d;
    }

    template <class Evaluator>
    Normals normals_at(const Evaluator& evaluator, std::size_t f) const {
        if constexpr (std::is_same_v<Evaluator, surface::PlaneEvaluator>) return {plane_normal_, 0};
        Vec3 a = evaluator.normal(scene_.mesh.corner(f, 0));
        Vec3 b = evaluator.normal(scene_.mesh.corner(f, 1));
        Vec3 c = evaluator.normal(scene_.mesh.corner(f, 2));
        if constexpr (std::is_same_v<Evaluator, surface::ConeEvaluator>) {
            // The apex has no normal: a facet that ends there turns by what its other side turns.
            const double near =
                1e-3 * 2 * scene_.mesh.areas[f] / std::max(static_cast<double>(scene_.heights[f]), 1e-300);
            if (norm(scene_.mesh.corner(f, 0) - point_) <= near) a = normalized(b + c);
            if (norm(scene_.mesh.corner(f, 1) - point_) <= near) b = normalized(c + a);
            if (norm(scene_.mesh.corner(f, 2) - point_) <= near) c = normalized(a + b);
        }
        return {normalized(a + b + c), std::max({squared_norm(a - b), squared_norm(b - c), squared_norm(c - a)})};
    }

    void normal_part(std::size_t f, const Normals& normals, FaceFit& fit) const {
        fit.step = angle_of_chord(std::sqrt(normals.squared_step));
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
        fit.angle = angle_of_chord(norm(normals.mean - scene_.mesh.normals[f]));
    }

    const Scene& scene_;
    surface::SurfaceEvaluator evaluate_;
    double trim_, largest_turn_;
    Vec3 point_, plane_normal_;
    double squared_least_turn_;
};

}  // namespace quadseg::exact
