// Typed surfaces in a frame, with their quadric coefficients.
#pragma once

#include <quadseg/segmentation.h>

#include "math/vec3.h"

namespace quadseg::datasets {

/// A right-handed orthonormal frame.
struct Frame {
    Vec3 origin;
    Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};

    Vec3 at(double a, double b, double c) const { return origin + x * a + y * b + z * c; }
    Vec3 at(const Vec3& p) const { return at(p.x, p.y, p.z); }
    /// Seen from below: x, −y, −z around the same origin.
    Frame flipped() const { return {origin, x, -y, -z}; }
    Frame moved(const Vec3& local) const { return {at(local), x, y, z}; }
};

/// Local diagonal quadric Σ d_i x_i² + Σ b_i x_i + c = 0.
struct DiagonalQuadric {
    Vec3 d;
    Vec3 b;
    double c = 0;
};
/// Its coefficients in world coordinates.
Quadric to_world(const DiagonalQuadric& quadric, const Frame& frame);

// `outward`: the outer normal points away from axis or centre. All lie in the frame: axis z, centre the origin.
Surface plane(const Frame& frame);  ///< normal z
Surface sphere(const Frame& frame, double radius, bool outward);
Surface cylinder(const Frame& frame, double radius, bool outward);
/// Apex at the origin, opening along +z.
Surface cone(const Frame& frame, double half_angle, bool outward);
Surface torus(const Frame& frame, double major_radius, double minor_radius, bool outward);
/// Any other quadric of the given type, axes the frame's; oriented so that its gradient is the outer normal at `outer`
/// (local point on the surface with the outer normal `outer_normal`).
Surface general(SurfaceType type, const Frame& frame, const DiagonalQuadric& quadric, const Vec3& semi_axes,
                const Vec3& outer, const Vec3& outer_normal);

/// Equal type and parameters, up to rounding.
bool same_surface(const Surface& a, const Surface& b);

}  // namespace quadseg::datasets
