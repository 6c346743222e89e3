// Exact foot points on general quadrics.
#pragma once

#include "math/vec3.h"
#include "quadric/monomials.h"

namespace quadseg::surface {

/// Nearest point of a general quadric f = 0 by the bracketed root of MATH.md §4; all types, degenerate ones included.
/// Returns p itself where the quadric has no real point.
///
/// With f = c0 + Σ u_i (½ d_i u_i + b_i) in the principal frame and w = ∇f(p), the foot point is p − t w_i / (1 + t
/// d_i) where f(p) = Σ w_i² t (2 + t d_i) / (2 (1 + t d_i)²): only f and ∇f at p enter, so no centre is needed and
/// nothing cancels for nearly planar quadrics. The root is sought in ν, in which the equation is linear for spheres and
/// planes.
class QuadricProjector {
  public:
    QuadricProjector() = default;  ///< the empty quadric: every point is its own foot point
    explicit QuadricProjector(const quadric::Coefficients& c);

    Vec3 foot_point(const Vec3& p) const noexcept;
    bool has_real_points() const noexcept { return !empty_; }
    double value(const Vec3& p) const noexcept;
    Vec3 gradient(const Vec3& p) const noexcept;

  private:
    /// The half line of t on which f has to fall from F > 0 to 0 (side 0), or −f from −F > 0 (side 1).
    struct Side {
        bool pole = false;    ///< t ends at a pole of an eigenvalue of the other sign, at infinity otherwise
        bool bottom = false;  ///< infinite side whose extremum is 0 but for rounding: a point, a line or a double plane
        int k = 0;            ///< the eigenvalue of the pole, or the largest
        double scale = 0;     ///< pole: −1/d_k; infinite: 1/d_k
        double d[3]{};        ///< eigenvalues with the side's sign
        double r[3]{};        ///< d_i / d_k
        double inverse_d[3]{};  ///< 1/d_i, 0 for d_i = 0
    };
    Vec3 displacement(const Side& side, double value, const double* w, const double* u) const noexcept;
    static Vec3 at_pole(const Side& side, double value, const double* w) noexcept;

    Vec3 axes_[3];
    double d_[3]{}, b_[3]{}, c0_ = 1;
    Side side_[2];
    bool planar_ = false, empty_ = true;
};

}  // namespace quadseg::surface
