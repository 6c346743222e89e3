// Regularities between the surfaces of a part: directions, axes, planes, centres and radii that are equal within what
// the data can tell, and copies of the surfaces snapped to them.
#pragma once

#include <quadseg/segmentation.h>

#include "math/vec3.h"

#include <cstdint>
#include <span>
#include <vector>

namespace quadseg::surface {

struct RegularSurface {
    Surface surface;
    std::int32_t region = 0;
    double area = 0;
    Vec3 centroid;      ///< of the region: directions are turned about it
    double extent = 0;  ///< RMS radius of the region's points
    double noise = 0;   ///< uncertainty of positions on the surface: RMS distance over √points, never below rounding
};

struct RegularityOptions {
    double sigmas = 4;                ///< equal: within this multiple of both uncertainties
    double most_angle = 5e-3;         ///< radians, whatever the uncertainty
    double most_length_share = 1e-3;  ///< of the smaller extent, whatever the uncertainty
    double rounding = 1e-9;           ///< of the extent, even without noise
};

struct RegularityResult {
    std::vector<Regularity>
        groups;                    ///< by kind, then by first region; `perpendicular`: the largest region of each side
    std::vector<Surface> snapped;  ///< one per input
};

/// Leaders are taken by area (ties: input order), so that the result depends on nothing else and tolerances do not
/// chain.
RegularityResult find_regularities(std::span<const RegularSurface> surfaces, const RegularityOptions& options = {});

/// Largest |distance| of the points to s.
double max_distance(const Surface& s, std::span<const Vec3> points);
/// Both of one type, and each other's points within the tolerance.
bool same_surface(const Surface& a, std::span<const Vec3> points_of_a, const Surface& b,
                  std::span<const Vec3> points_of_b, double tolerance);

struct SurfacePoints {
    Surface surface;
    std::span<const Vec3> points;
    double tolerance = 0;
};
/// Equal ids for regions on one surface: the index of the first such region, compared under the larger tolerance.
std::vector<std::int32_t> surface_ids(std::span<const SurfacePoints> regions);

}  // namespace quadseg::surface
