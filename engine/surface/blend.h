// Rolling-ball blends that are no tori: canal surfaces, the envelope of a ball of constant radius along a spine curve.
#pragma once

#include "surface/fit.h"

namespace quadseg::surface {

struct BlendFit {
    bool ok = false;            ///< a radius exists: enough points, normals turn across the spine
    double radius = 0;          ///< of the ball
    bool outward = true;        ///< the mesh normal points away from the spine
    double spine_residual = 0;  ///< RMS distance of the offset points x − r n from a local curve through them
    double spine_extent = 0;    ///< RMS radius of the offset points: small against the patch's for a sphere
    double section_angle = 0;   ///< RMS angle between neighbouring normals across the spine: 0 for flat patches
    double radius_spread = 0;   ///< median |r_i − r| / r of the radii that the vertices show alone
};

/// The constant radius for which offset points concentrate on a curve, by the normals' change across the spine; the
/// principal direction (section or spine) is the one of smaller residual. Deterministic; large sets are sampled.
BlendFit fit_blend(const PointSet& p);

}  // namespace quadseg::surface
