// Least-squares fits of nested families from one factorisation: planes ⊂ spheres ⊂ surfaces of revolution ⊂ quadrics.
//
// With |x|² in the place of x² the first five unknowns span the spheres, so that the factor of the general quadric's
// system contains theirs; a surface of revolution about a known direction a adds (a·x)² to them: one more row.
#pragma once

#include "quadric/fit.h"
#include "quadric/normal_equations.h"

namespace quadseg::quadric {

class NestedFits {
  public:
    /// Moments with unit weights or with those of the second step.
    NestedFits(const Moments& m, double weight) noexcept;

    /// Energies are E_d + ω E_n with the gradient not normalised, ≥ 0; without a fit where nothing could be solved.
    bool usable() const noexcept { return state_.usable; }
    double sphere_energy() const noexcept { return energy_without(cholesky_.reduction(5)); }
    double quadric_energy() const noexcept { return energy_without(cholesky_.reduction()); }

    QuadricFit sphere() const noexcept;
    QuadricFit quadric() const noexcept;
    QuadricFit cylinder(const Vec3& axis) const noexcept;
    QuadricFit revolution(const Vec3& axis) const noexcept;

  private:
    double energy_without(double reduction) const noexcept;

    NormalEquations equations_;  // in 1, x, y, z, |x|², xy, xz, y², yz, z²
    Cholesky<10> cholesky_;
    Cholesky<10>::State state_;
};

/// Direction to which the normals are most nearly perpendicular: the smallest eigenvector of ∫n nᵀ.
Vec3 cylinder_direction(const Moments& m) noexcept;
/// Direction with which the normals make the most nearly constant angle: the smallest eigenvector of their covariance.
Vec3 revolution_direction(const Moments& m) noexcept;
/// Axis of revolution of the nearest quadric of revolution: the eigenvector of the isolated eigenvalue of its form.
Vec3 revolution_direction(const Coefficients& c) noexcept;

}  // namespace quadseg::quadric
