// Second fundamental form of a surface near some of its points.
#pragma once

#include "math/vec3.h"

#include <array>
#include <span>

namespace quadseg::surface {

/// The form [[along_x, mixed], [mixed, along_y]] in the tangent plane of x_axis and normal × x_axis: normal curvatures,
/// 1/length.
struct CurvatureTensor {
    Vec3 normal, x_axis;  ///< unit, perpendicular
    double along_x = 0, mixed = 0, along_y = 0;
    /// Means over the points of x⁴, x³y, x²y², xy³, y⁴ by the fourth power of their RMS radius: in which directions the
    /// points can tell a curvature.
    std::array<double, 5> spread{};
    double error = 0;  ///< of a curvature, as the misfit of the points tells; +∞: no fit
};

/// From a quadratic height function over the tangent plane at `centre`, heights of circular arcs; directions in which
/// the points are too few to tell bend little. Lengths in the points' unit.
CurvatureTensor fit_curvature(std::span<const Vec3> points, const Vec3& centre, const Vec3& orientation);

}  // namespace quadseg::surface
