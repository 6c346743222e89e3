// Typed surfaces: distance, normal, foot point; conversion to and from quadric coefficients. Unit-frame or input
// coordinates alike: nothing here knows a frame.
#pragma once

#include <quadseg/segmentation.h>

#include "math/vec3.h"
#include "quadric/monomials.h"

namespace quadseg::surface {

/// Signed distance of p to the surface: positive on the side the mesh normal points to (Surface::outward). Exact for
/// every type: closed forms for plane … torus, |p − foot_point| with the sign of f otherwise.
double signed_distance(const Surface& s, const Vec3& p);
/// Unit normal at the surface point nearest to p, on the side the mesh normal points to.
Vec3 normal_at(const Surface& s, const Vec3& p);
/// Nearest point of the surface. Where it is not unique (axis, centre) a fixed choice is made.
Vec3 foot_point(const Surface& s, const Vec3& p);

/// Nearest point of a general quadric f = 0 by the bracketed root of MATH.md §4; all types, degenerate ones included.
/// Returns p itself where the quadric has no real point.
class QuadricProjector {
  public:
    explicit QuadricProjector(const quadric::Coefficients& c);
    Vec3 foot_point(const Vec3& p) const;
    bool has_real_points() const noexcept;

  private:
    Vec3 axes_[3], centre_;
    double d_[3]{}, b_[3]{}, c0_ = 0, scale_ = 1;
    bool planar_ = false, empty_ = false;
};

/// Coefficients of a typed surface (plane, sphere, cylinder, cone exactly; torus: those already in s), oriented by
/// `outward`, with |∇f| = 1 on the surface where that is possible (mean elsewhere).
quadric::Coefficients to_coefficients(const Surface& s);

/// Type from the eigenvalues of the quadratic form (section 4.4.2), with parameters (centre, axes, semi-axes).
/// Tolerance is relative to the largest eigenvalue over the extent `radius` around `near`. Never returns torus, blend,
/// freeform.
Surface classify(const quadric::Coefficients& c, const Vec3& near, double radius, double tolerance = 1e-3);

/// The same surface after x' = (x − centre)·scale, or its reverse: for the way between unit frame and input.
Surface transformed(const Surface& s, const Vec3& centre, double scale);
Surface transformed_back(const Surface& s, const Vec3& centre, double scale);

}  // namespace quadseg::surface
