// Least squares restricted to a family of quadrics that is a linear span (spheres, cylinders and surfaces of revolution
// of a known direction), from normal equations already assembled.
#pragma once

#include "quadric/fit.h"
#include "quadric/normal_equations.h"

namespace quadseg::quadric {

/// Over all quadrics: section 3.2.2.
QuadricFit fit_least_squares(const NormalEquations& equations) noexcept;
QuadricFit restricted_sphere(const NormalEquations& equations) noexcept;
QuadricFit restricted_cylinder(const NormalEquations& equations, const Vec3& axis) noexcept;
QuadricFit restricted_revolution(const NormalEquations& equations, const Vec3& axis) noexcept;

/// Direction to which the normals are most nearly perpendicular: the smallest eigenvector of ∫n nᵀ.
Vec3 cylinder_direction(const Moments& m) noexcept;
/// Direction with which the normals make the most nearly constant angle: the smallest eigenvector of their covariance.
Vec3 revolution_direction(const Moments& m) noexcept;
/// Axis of revolution of the nearest quadric of revolution: the eigenvector of the isolated eigenvalue of its form.
Vec3 revolution_direction(const Coefficients& c) noexcept;

}  // namespace quadseg::quadric
