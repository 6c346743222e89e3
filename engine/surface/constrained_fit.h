// Model choice: the simplest type of surface whose refit to the vertices is not meaningfully worse (section 4.4.2,
// decided by residuals as MATH.md §4 asks).
#pragma once

#include "surface/fit.h"
#include "surface/surface.h"

namespace quadseg::surface {

struct ChoiceOptions {
    /// Types whose RMS distance is below the floor, or below `ratio` times the best type's, are equals.
    double noise_floor = 0;  ///< in the points' unit; rounding (1e-12 extents) is always part of it
    double ratio = 2;
    bool torus = true;          ///< may be chosen
    bool general = true;        ///< quadrics beyond plane … torus may be chosen
    std::size_t sample = 2000;  ///< larger sets choose on every k-th point, then refit plane … torus on all
    FitOptions fit;
};

/// Fits every type to the points, with its constraint kept, and returns the simplest of those that are equals; among
/// equals the normals decide first, since two rims of vertices lie on a sphere, a cone and a torus alike. `start`: the
/// region's quadric, in the points' coordinates (zeros: none). Parameters and coefficients are filled in; `rms` … of
/// the result are exact distances. ok is false if nothing could be fitted.
SurfaceFit choose_surface_fit(const PointSet& p, const quadric::Coefficients& start, const ChoiceOptions& options = {});
Surface choose_surface(const PointSet& p, const quadric::Coefficients& start, const ChoiceOptions& options = {});

/// The best surface of one type, any but blend and freeform; quadric types by geometric refinement from `start`.
SurfaceFit fit_type(SurfaceType type, const PointSet& p, const quadric::Coefficients& start,
                    const FitOptions& options = {});

/// c scaled so that the mean |∇f| at the points is 1, and oriented along the normals if there are any.
quadric::Coefficients normalised_to(const quadric::Coefficients& c, const PointSet& p);

}  // namespace quadseg::surface
