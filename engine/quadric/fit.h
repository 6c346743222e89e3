// Fits of planes and general quadrics to moments: section 3.2 and 3.3.
//
// All fits expect moments in a centred, scaled frame of the region (spread(): centroid at 0, RMS radius 1) unless said
// otherwise, and return coefficients in the frame of the moments they were given.
#pragma once

#include "quadric/energy.h"
#include "quadric/moments.h"
#include "quadric/monomials.h"

namespace quadseg::quadric {

struct QuadricFit {
    Coefficients c{};
    double energy = 0;         ///< quadratic hybrid energy from the moments (E_d + ω E_n), in the moments' units
    bool regularised = false;  ///< the system was singular and had to be stabilised
};

/// Best plane in the hybrid energy: candidates are the smallest eigenvector of the covariance and the mean normal; the
/// better is kept. Exact energies.
QuadricFit fit_plane(const Moments& m, double weight) noexcept;

/// Section 3.2.1, Taubin: minimises ∫f²/∫|∇f|², the constant eliminated (9×9, Cholesky, inverse iteration). Oriented
/// along the normals, scaled to mean |∇f| 1. `energy` is area·λ (distance only). May be a pair of planes: check
/// validity.
QuadricFit fit_taubin(const Moments& m) noexcept;

/// Section 3.2.2 and appendix: (A_d + ω A_n) C = ω B_n by Cholesky on moments weighted with 1/|∇f⁰|² and 1/|∇f⁰|
/// (unit weights: the single linear fit LSQ0). Singular systems are stabilised by a ridge of 1e-13·trace and reported.
QuadricFit fit_least_squares(const Moments& weighted, double weight) noexcept;

/// Restricted least-squares fits from the same moments, for the mild model ladder of merging (unit weights): sphere
/// c0 + b·x + s|x|² (4 dof), cylinder and surface of revolution about a direction found from the normals' covariance.
QuadricFit fit_sphere_linear(const Moments& m, double weight) noexcept;
QuadricFit fit_cylinder_linear(const Moments& m, double weight) noexcept;
QuadricFit fit_revolution_linear(const Moments& m, double weight) noexcept;

/// ω of the unit cube expressed in a frame scaled by s (x' = s·x): E_d scales by s⁴, E_n by s²: ω' = ω s².
inline double scaled_weight(double weight, double s) noexcept {
    return weight * s * s;
}

}  // namespace quadseg::quadric
