// Vertex normals and curvatures from local polynomials over the mean plane: far better than face normals on dense
// meshes.
#pragma once

#include "math/vec3.h"

#include <span>
#include <vector>

namespace quadseg::surface {

struct Jet {
    Vec3 normal;                                  ///< unit, at the point, oriented along `orientation`
    double residual = 0;                          ///< RMS of the polynomial fit
    double curvature_min = 0, curvature_max = 0;  ///< principal; positive where the surface bends away from the normal
                                                  ///< (a ball seen from outside)
    int order = 0;  ///< 4, 3, 2 by the number of independent points (≥ 26, 16, 9); 1: plane; 0: the orientation is
                    ///< all there is
};

/// Jet at points[0] from points (the first being the one of interest); orientation: rough normal.
Jet fit_jet(std::span<const Vec3> points, const Vec3& orientation);
/// Normals at all points of a patch from one polynomial over its mean plane (heights over the plane of `orientation`).
std::vector<Vec3> patch_normals(std::span<const Vec3> points, const Vec3& orientation, double* residual = nullptr);

}  // namespace quadseg::surface
