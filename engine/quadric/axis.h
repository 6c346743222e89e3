// Eigenvectors of symmetric 3×3 matrices in closed form: directions of axes, where speed matters more than the last
// digit of nearly equal eigenvalues.
#pragma once

#include "math/symmetric3.h"

namespace quadseg::quadric {

/// Unit eigenvector of the smallest eigenvalue.
Vec3 smallest_eigenvector(const Symmetric3& m) noexcept;
/// Unit eigenvector of the eigenvalue that is farther from the middle one: the axis of revolution of a form.
Vec3 isolated_eigenvector(const Symmetric3& m) noexcept;

}  // namespace quadseg::quadric
