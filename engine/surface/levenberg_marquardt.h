// Levenberg–Marquardt on exact distances for the frames of shape_frame.h.
#pragma once

#include "surface/fit.h"
#include "surface/local_points.h"
#include "surface/shape_frame.h"

namespace quadseg::surface {

/// What "on the surface" means: nine tenths of the points within `tolerance`, or half of them while nearly all are
/// within `stray`.
struct Closeness {
    double tolerance = 0, stray = 0;  ///< in the points' own unit
};

struct Adjustment {
    ShapeFrame frame;
    double median = 0;        ///< of |distance|, in the local points' unit
    double rms = 0;           ///< of least squares, likewise
    bool determined = false;  ///< the points fix all parameters of the type
    bool finite = false;
    bool close = false;  ///< came as close as asked, and stopped there
};

/// Minimises the (robust) sum of squared distances from `start`. options.hopeless, minimum_scale, wanted and most_rms
/// are in the points' own unit.
Adjustment adjust(const ShapeFrame& start, LocalPoints& points, const FitOptions& options);

/// Only asks whether it comes so close: ends as soon as it does, or falls too slowly to get there.
Adjustment adjust_towards(const Closeness& goal, const ShapeFrame& start, LocalPoints& points,
                          const FitOptions& options);

}  // namespace quadseg::surface
