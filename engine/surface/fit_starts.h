// Linear starts of the typed fits, on local points.
#pragma once

#include "surface/fit.h"
#include "surface/local_points.h"

namespace quadseg::surface {

/// A data point near which the frame of a start is well-conditioned.
Vec3 anchor(const Surface& s, const LocalPoints& p);

Surface start_plane(const LocalPoints& p);
Surface start_sphere(const LocalPoints& p);
Surface start_cylinder(const LocalPoints& p);
/// About the longest direction of the points, normals unused: long strips, whose normals tell the axis too coarsely.
Surface start_cylinder_along(const LocalPoints& p);
Surface start_cone(const LocalPoints& p);
/// The apex and half angle that the points show about the axis of a cylinder.
Surface start_cone_from(const Surface& cylinder, const LocalPoints& p);
/// Axes that the normals' lines meet: eigenvectors of the 6×6 line complex.
class TorusAxes {
  public:
    explicit TorusAxes(const LocalPoints& p);
    /// rank: which eigenvector (0: the best).
    Surface start(const LocalPoints& p, int rank = 0) const;

  private:
    Vec3 direction_[3], point_[3];
};
/// A cylinder bent along its axis as the points show: fillets whose major radius is large.
Surface start_torus_from(const Surface& cylinder, const LocalPoints& p);
/// The circle that the points show in the half planes through the axis (point, direction).
Surface start_torus_about(const Vec3& point, const Vec3& direction, const LocalPoints& p);

}  // namespace quadseg::surface
