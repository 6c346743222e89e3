// Geometric refinement of general quadrics and of the families that a special type forms among them:
// Levenberg–Marquardt on the first-order (Sampson) distance f/|∇f|, which is exact in the limit of points on the
// surface; the constraint is kept by the parametrisation (a moving frame and the monomials that the family has in it).
#pragma once

#include "quadric/monomials.h"
#include "surface/local_points.h"

namespace quadseg::surface {

enum class QuadricFamily {
    general,             ///< 9 dof
    cylinder,            ///< elliptic, hyperbolic: a conic along a direction: 7
    parabolic_cylinder,  ///< 6
    paraboloid,          ///< elliptic, hyperbolic: one principal curvature direction without quadratic term: 8
    cone,                ///< elliptic: 8
    revolution           ///< about an axis: 7
};

int degrees_of_freedom(QuadricFamily family) noexcept;

/// Frame in which a family's monomials are written: origin and a right-handed triad; the last direction is the
/// generator, axis of revolution or axis of the paraboloid.
struct QuadricFrame {
    Vec3 origin, axes[3];
    quadric::Coefficients c{};
};

/// The family's best coefficients in the frame by values and normals (linear), without moving the frame.
bool start_quadric(QuadricFamily family, const LocalPoints& points, QuadricFrame& frame);

/// Refines; false when it fails. `coefficients` come back in the local points' frame.
bool refine_quadric(QuadricFamily family, LocalPoints& points, const QuadricFrame& start, const FitOptions& options,
                    quadric::Coefficients& coefficients);

/// The same quadric in the frame's coordinates, and back.
quadric::Coefficients to_frame(const quadric::Coefficients& c, const QuadricFrame& frame) noexcept;
quadric::Coefficients from_frame(const QuadricFrame& frame) noexcept;

}  // namespace quadseg::surface
