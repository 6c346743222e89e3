// Projection of the vertices onto the surfaces of their regions: section 4.4.3.
#pragma once

#include "flow/final_surfaces.h"
#include "flow/flow.h"

#include <vector>

namespace quadseg::flow {

/// 3V coordinates in the input's frame and vertex order. A vertex of one region goes to its foot point; one of several
/// to the mean of its foot points (the paper), or with Options::project_joint to the nearest point that lies on all of
/// their surfaces. Vertices of no face stay. Nothing leaves the bounding box, enlarged by a hundredth of its diagonal.
std::vector<double> projected_positions(const FlowInput& input, const partition::Labels& labels,
                                        const std::vector<FinalSurface>& surfaces);

}  // namespace quadseg::flow
