// Nested parametrisation of plane ⊂ cylinder ⊂ cone ⊂ torus, and sphere, by a frame at a surface point near the data
// (after Lukács, Marshall, Martin: Faithful least-squares fitting of spheres, cylinders, cones and tori, ECCV 1998).
//
// Curvatures instead of radii: all distances stay finite and exact to rounding as a radius grows to infinity, and the
// normal equations stay well-conditioned in the scale of the data however far the axis is.
#pragma once

#include <quadseg/segmentation.h>

#include "math/vec3.h"

#include <cmath>

namespace quadseg::surface {

/// Point p of the surface, normal n there, direction g tangent to the generator (cylinder, cone) or to the circle of
/// the section through the axis (torus), b = n × g.
struct ShapeFrame {
    SurfaceType type = SurfaceType::plane;
    Vec3 p, n, g, b;
    double curvature = 0;        ///< 1 / distance from p to the axis along −n; sphere: 1/radius
    double tilt = 0;             ///< axis = cos(tilt) g − sin(tilt) n; cylinder: 0; cone: the half angle
    double minor_curvature = 0;  ///< torus: 1/minor radius; cone, cylinder: 0
};

/// Parameters of a step: shift along n, rotations about g and b, then by type: sphere: curvature; cylinder: rotation
/// about n, curvature; cone: and tilt; torus: and minor curvature.
template <SurfaceType type>
inline constexpr int parameters_of = type == SurfaceType::plane      ? 3
                                     : type == SurfaceType::sphere   ? 4
                                     : type == SurfaceType::cylinder ? 5
                                     : type == SurfaceType::cone     ? 6
                                                                     : 7;

/// The larger one, the second if the first is no number: what processors do at once, unlike std::fmax.
[[gnu::always_inline]] inline double at_least(double value, double least) noexcept {
    return value > least ? value : least;
}

/// Distance of the point with frame coordinates (un, ug, ub) to the shape, signed along n, and its derivatives.
template <SurfaceType type>
struct ShapeDistance {
    double k, c, s, m;  // curvature, cos and sin of the tilt, minor curvature

    explicit ShapeDistance(const ShapeFrame& f)
        : k(f.curvature), c(std::cos(f.tilt)), s(std::sin(f.tilt)), m(f.minor_curvature) {}

    [[gnu::always_inline]] double distance(double un, double ug, double ub) const noexcept {
        if constexpr (type == SurfaceType::plane) {
            return un;
        } else if constexpr (type == SurfaceType::sphere) {
            const double a = k * (un * un + ug * ug + ub * ub) + 2 * un;
            return a / (1 + std::sqrt(at_least(1 + k * a, 0.0)));
        } else {
            const double y = c * un + s * ug, z = c * ug - s * un;  // along the radius through p and along the axis
            const double a = k * (y * y + ub * ub) + 2 * c * y, turn = k * y + c;
            const double rho = std::sqrt(turn * turn + k * k * ub * ub);  // k · distance from the axis
            const double across = a / (rho + c);                          // distance from the axis minus that of p
            const double flat = c * across - s * z;
            if constexpr (type == SurfaceType::torus) {
                const double q = m * (across * across + z * z) + 2 * flat;
                return q / (1 + std::sqrt(at_least(1 + m * q, 0.0)));
            } else {
                return flat;
            }
        }
    }

    /// Writes parameters_of<type> derivatives to column(i), i = 0 ….
    template <class Column>
    [[gnu::always_inline]] double derivatives(double un, double ug, double ub, Column&& column) const noexcept {
        if constexpr (type == SurfaceType::plane) {
            column(0) = -1;
            column(1) = -ub;
            column(2) = ug;
            return un;
        } else if constexpr (type == SurfaceType::sphere) {
            const double uu = un * un + ug * ug + ub * ub, a = k * uu + 2 * un;
            const double root = std::sqrt(at_least(1 + k * a, 1e-30)), inverse = 1 / root, d = a / (1 + root);
            const double gn = (k * un + 1) * inverse, gg = k * ug * inverse, gb = k * ub * inverse;
            column(0) = -gn;
            column(1) = un * gb - ub * gn;
            column(2) = ug * gn - un * gg;
            column(3) = (uu - d * d) * 0.5 * inverse;
            return d;
        } else {
            const double y = c * un + s * ug, z = c * ug - s * un, mm = y * y + ub * ub;
            const double a = k * mm + 2 * c * y, turn = k * y + c;
            const double rho = std::sqrt(at_least(turn * turn + k * k * ub * ub, 1e-30));
            const double inverse = 1 / rho, below = 1 / (rho + c), across = a * below;
            const double across_y = turn * inverse, across_b = k * ub * inverse;
            const double across_k = (mm - across * (k * mm + c * y) * inverse) * below;
            const double across_c = (2 * y - across * (turn * inverse + 1)) * below;
            const double across_tilt = across_y * z - s * across_c;
            const double flat = c * across - s * z;
            double d, d_across, d_z, d_tilt;
            [[maybe_unused]] double d_minor = 0;
            if constexpr (type == SurfaceType::torus) {
                const double far = across * across + z * z, q = m * far + 2 * flat;
                const double root = std::sqrt(at_least(1 + m * q, 1e-30)), by = 1 / root;
                d = q / (1 + root);
                d_across = (m * across + c) * by;
                d_z = (m * z - s) * by;
                d_tilt = (-s * across - c * z) * by;
                d_minor = (far - d * d) * 0.5 * by;
            } else {
                d = flat;
                d_across = c;
                d_z = -s;
                d_tilt = -s * across - c * z;
            }
            const double gn = d_across * across_y * c - d_z * s, gg = d_across * across_y * s + d_z * c;
            const double gb = d_across * across_b;
            column(0) = -gn;
            column(1) = un * gb - ub * gn;
            column(2) = ug * gn - un * gg;
            column(3) = ub * gg - ug * gb;
            column(4) = d_across * across_k;
            if constexpr (type != SurfaceType::cylinder) column(5) = d_tilt + d_across * across_tilt - d_z * y;
            if constexpr (type == SurfaceType::torus) column(6) = d_minor;
            return d;
        }
    }
};

/// The frame after a step.
ShapeFrame stepped(const ShapeFrame& f, const double* step) noexcept;

/// Frame of a typed surface at its point nearest to `near`. `type`: that of the surface or one that contains it
/// (cylinder as cone, all as torus). False where the surface has no such frame (zero or negative sizes, a point on an
/// axis or apex).
bool frame_of(const Surface& s, const Vec3& near, SurfaceType type, ShapeFrame& frame) noexcept;

/// The surface of a frame, `outward` set as if n were the mesh normal at p. False where it has left its type: radius or
/// apex beyond `largest`, no real point, a cone that is a plane.
bool surface_of(const ShapeFrame& f, double largest, Surface& s) noexcept;

}  // namespace quadseg::surface
