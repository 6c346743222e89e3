// Energies of a triangle with respect to a quadric: equations (3), (4) and the plane's closed forms of section 3.3.
#pragma once

#include "math/vec3.h"
#include "quadric/moments.h"
#include "quadric/monomials.h"

namespace quadseg::quadric {

struct TriangleEnergy {
    double distance = 0;  ///< E_d
    double normal = 0;    ///< E_n
    double hybrid(double weight) const noexcept { return distance + weight * normal; }
};

/// E_d and E_n with the one-point gradient |∇f(centroid)|, floored at gradient_floor (MATH.md §3); the integrals of the
/// polynomials are exact. Zero for area 0. All in one frame, whose origin should be near the triangle (MATH.md §3).
TriangleEnergy triangle_energy(const Coefficients& c, const Vec3& v0, const Vec3& v1, const Vec3& v2, const Vec3& n,
                               double area, double gradient_floor = 1e-6) noexcept;

/// Exact energies of a plane n·x + d, |n| = 1 (section 3.3).
TriangleEnergy plane_triangle_energy(const Vec3& plane_normal, double offset, const Vec3& v0, const Vec3& v1,
                                     const Vec3& v2, const Vec3& n, double area) noexcept;

/// Cᵀ A_d C + ω (Cᵀ A_n C − 2 Cᵀ B_n + c_n) from (weighted) moments: the quadratic energy of the second step.
TriangleEnergy moment_energy(const Coefficients& c, const Moments& m) noexcept;

}  // namespace quadseg::quadric
