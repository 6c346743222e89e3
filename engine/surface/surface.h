// Typed surfaces: distance, normal, foot point; conversion to and from quadric coefficients. Unit-frame or input
// coordinates alike: nothing here knows a frame.
#pragma once

#include <quadseg/segmentation.h>

#include "math/vec3.h"
#include "quadric/monomials.h"
#include "surface/quadric_projector.h"

namespace quadseg::surface {

/// Conventions beyond segmentation.h. Cone: the one nappe from the apex along the axis. Torus: the circle of radius
/// `minor_radius` around (major radius, 0) in the half plane (ρ ≥ 0, z), turned about the axis; a negative major radius
/// gives the lemon (the inner part of a spindle torus), minor > major > 0 the apple. Plane: `outward` has no meaning,
/// the axis is the outward normal. General quadrics, blend and freeform: ∇f of the coefficients is the outward
/// direction.

/// Signed distance of p to the surface: positive on the side the mesh normal points to (Surface::outward). Exact for
/// every type: closed forms for plane … torus, |p − foot_point| with the sign of f otherwise.
double signed_distance(const Surface& s, const Vec3& p);
/// Unit normal at the surface point nearest to p, on the side the mesh normal points to.
Vec3 normal_at(const Surface& s, const Vec3& p);
/// Nearest point of the surface. Where it is not unique (axis, centre) a fixed choice is made.
Vec3 foot_point(const Surface& s, const Vec3& p);

/// Coefficients of a typed surface (plane, sphere, cylinder, cone exactly; torus and others: those already in s),
/// oriented by `outward`, with |∇f| = 1 on the surface; cone: |∇f| = distance to the apex (callers that know the region
/// scale its mean to 1).
quadric::Coefficients to_coefficients(const Surface& s);

/// Type from the eigenvalues of the quadratic form (section 4.4.2), with parameters (centre, axes, semi-axes).
/// Tolerance is relative to the largest eigenvalue over the extent `radius` around `near`. Never returns torus, blend,
/// freeform; pairs of planes, points, lines and imaginary quadrics are `quadric`.
///
/// Rows of `axes`, right-handed: the last (also `axis`) is the axis of a cone, hyperboloid (two sheets: through both)
/// or paraboloid (into its opening) and the generator of a cylinder; hyperbolic cylinder: the first meets the surface;
/// parabolic cylinder: the second points into the opening. `semi_axes` in their order, lengths; elliptic cone: of the
/// section at distance semi_axes[2] from the apex; paraboloids and parabolic cylinder: p in u² = p w, 0 for the
/// rest. `point`: centre, apex or vertex; cylinders: the axis (vertex) point nearest to `near`.
Surface classify(const quadric::Coefficients& c, const Vec3& near, double radius, double tolerance = 1e-3);

/// The same surface after x' = (x − centre)·scale, or its reverse: for the way between unit frame and input.
Surface transformed(const Surface& s, const Vec3& centre, double scale);
Surface transformed_back(const Surface& s, const Vec3& centre, double scale);

}  // namespace quadseg::surface
