// The sheets of a quadric as a region sees them (MATH.md §4): which kinds fall apart into two, and on which a point is.
#pragma once

#include "math/vec3.h"
#include "quadric/monomials.h"

namespace quadseg::quadric {

/// At most this share of a region's area may lie on another sheet or against the gradient.
inline constexpr double tolerated_share = 0.01;

class Sheets {
  public:
    enum class Kind {
        connected,        ///< one sheet, or falls apart only farther away than the region is large
        imaginary,        ///< no real surface, or a line or a point
        by_sign,          ///< two-sheet hyperboloid, cone, hyperbolic cylinder, parallel planes: either side of a plane
        by_nearer_plane,  ///< intersecting planes
    };

    /// c: in a centred frame in which the region has an RMS radius of 1.
    explicit Sheets(const Coefficients& c) noexcept;

    Kind kind() const noexcept { return kind_; }
    /// Whether x, a point on the surface, is on the second of two sides.
    bool second_side(const Vec3& x) const noexcept;
    /// The same for the first-order foot point of x.
    bool foot_on_second_side(const Coefficients& c, const Vec3& x) const noexcept;

  private:
    void decide(double k, double largest) noexcept;
    void choose(bool positive) noexcept;

    Kind kind_ = Kind::connected;
    Vec3 axis_[3];
    double lambda_[3] = {0, 0, 0}, centre_[3] = {0, 0, 0};  // f = Σ λ_i (axis_i·x − centre_i)² − k
    int first_ = 0, second_ = 2;
};

}  // namespace quadseg::quadric
