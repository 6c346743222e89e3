// Planes, spheres, cylinders and cones are limits of tori: one question for all of them, asked before each is fitted.
#pragma once

#include "surface/fit.h"
#include "surface/levenberg_marquardt.h"

namespace quadseg::surface {

/// Whether the points come so close to some torus or limit of one. No: none of the starts of all types, from the
/// points' normals and from `more_normals` (may be empty), leads there; a step or two show that for most.
bool may_lie_on_torus(const PointSet& p, std::span<const Vec3> more_normals, const Closeness& goal,
                      const FitOptions& options);

}  // namespace quadseg::surface
