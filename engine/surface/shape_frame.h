// Nested parametrisation of plane ⊂ cylinder ⊂ cone ⊂ torus, and sphere, by a frame at a surface point near the data
// (after Lukács, Marshall, Martin: Faithful least-squares fitting of spheres, cylinders, cones and tori, ECCV 1998).
//
// Curvatures instead of radii: all distances stay finite and exact to rounding as a radius grows to infinity, and the
// normal equations stay well-conditioned in the scale of the data however far the axis is.
#pragma once

#include <quadseg/segmentation.h>

#include "math/vec3.h"
#include "quadric/pack.h"

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

/// Distance of points with frame coordinates (un, ug, ub) to the shape, signed along n, and its derivatives: of several
/// points at once, a point a lane.
template <SurfaceType type>
struct ShapeDistance {
    double k, c, s, m;  // curvature, cos and sin of the tilt, minor curvature

    explicit ShapeDistance(const ShapeFrame& f)
        : k(f.curvature), c(std::cos(f.tilt)), s(std::sin(f.tilt)), m(f.minor_curvature) {}

    template <class Lanes>
    [[gnu::always_inline]] void distance(const Lanes& un, const Lanes& ug, const Lanes& ub, Lanes& out) const noexcept {
        if constexpr (type == SurfaceType::plane) {
            out = un;
        } else if constexpr (type == SurfaceType::sphere) {
            const Lanes a = k * (un * un + ug * ug + ub * ub) + 2 * un;
            out = a / (1 + root_of(1 + k * a, 0));
        } else {
            const Lanes y = c * un + s * ug, z = c * ug - s * un;  // along the radius through p and along the axis
            const Lanes a = k * (y * y + ub * ub) + (2 * c) * y, turn = k * y + c;
            Lanes rho{};  // k · distance from the axis
            quadric::square_root(turn * turn + (k * k) * ub * ub, rho);
            const Lanes across = a / (rho + c);  // distance from the axis minus that of p
            const Lanes flat = c * across - s * z;
            if constexpr (type == SurfaceType::torus) {
                const Lanes q = m * (across * across + z * z) + 2 * flat;
                out = q / (1 + root_of(1 + m * q, 0));
            } else {
                out = flat;
            }
        }
    }

    /// Writes parameters_of<type> derivatives to column[0 …], the distance to out.
    template <class Lanes>
    [[gnu::always_inline]] void derivatives(const Lanes& un, const Lanes& ug, const Lanes& ub, Lanes* column,
                                            Lanes& out) const noexcept {
        if constexpr (type == SurfaceType::plane) {
            column[0] = Lanes{} - 1.0;
            column[1] = Lanes{} - ub;
            column[2] = ug;
            out = un;
        } else if constexpr (type == SurfaceType::sphere) {
            const Lanes uu = un * un + ug * ug + ub * ub, a = k * uu + 2 * un;
            const Lanes root = root_of(1 + k * a, 1e-30), inverse = 1 / root, d = a / (1 + root);
            const Lanes gn = (k * un + 1) * inverse, gg = k * ug * inverse, gb = k * ub * inverse;
            column[0] = Lanes{} - gn;
            column[1] = un * gb - ub * gn;
            column[2] = ug * gn - un * gg;
            column[3] = (uu - d * d) * 0.5 * inverse;
            out = d;
        } else {
            const Lanes y = c * un + s * ug, z = c * ug - s * un, mm = y * y + ub * ub;
            const Lanes a = k * mm + (2 * c) * y, turn = k * y + c;
            const Lanes rho = root_of(turn * turn + (k * k) * ub * ub, 1e-30);
            const Lanes inverse = 1 / rho, below = 1 / (rho + c), across = a * below;
            const Lanes across_y = turn * inverse, across_b = k * ub * inverse;
            const Lanes across_k = (mm - across * (k * mm + c * y) * inverse) * below;
            const Lanes across_c = (2 * y - across * (turn * inverse + 1)) * below;
            const Lanes across_tilt = across_y * z - s * across_c;
            const Lanes flat = c * across - s * z;
            Lanes d, d_across, d_z, d_tilt;
            [[maybe_unused]] Lanes d_minor;
            if constexpr (type == SurfaceType::torus) {
                const Lanes far = across * across + z * z, q = m * far + 2 * flat;
                const Lanes root = root_of(1 + m * q, 1e-30), by = 1 / root;
                d = q / (1 + root);
                d_across = (m * across + c) * by;
                d_z = (m * z - s) * by;
                d_tilt = (-s * across - c * z) * by;
                d_minor = (far - d * d) * 0.5 * by;
            } else {
                d = flat;
                d_across = Lanes{} + c;
                d_z = Lanes{} - s;
                d_tilt = -s * across - c * z;
            }
            const Lanes gn = d_across * across_y * c - d_z * s, gg = d_across * across_y * s + d_z * c;
            const Lanes gb = d_across * across_b;
            column[0] = Lanes{} - gn;
            column[1] = un * gb - ub * gn;
            column[2] = ug * gn - un * gg;
            column[3] = ub * gg - ug * gb;
            column[4] = d_across * across_k;
            if constexpr (type != SurfaceType::cylinder) column[5] = d_tilt + d_across * across_tilt - d_z * y;
            if constexpr (type == SurfaceType::torus) column[6] = d_minor;
            out = d;
        }
    }

  private:
    template <class Lanes>
    [[gnu::always_inline]] static Lanes root_of(const Lanes& value, double least) noexcept {
        Lanes bounded{}, root{};
        quadric::maximum(value, Lanes{} + least, bounded);
        quadric::square_root(bounded, root);
        return root;
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
