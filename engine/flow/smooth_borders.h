// Boundary smoothing of section 4.4.1 on the final surfaces.
#pragma once

#include "flow/final_surfaces.h"
#include "flow/flow.h"

#include <vector>

namespace quadseg::flow {

/// Moves the labels of faces near borders; region numbers stay. Returns whether any label changed. Not stopped by
/// control: bounded by O(F); a stopped run stops after the current batch of borders.
bool smooth_borders(const FlowInput& input, FlowResult& flow, const partition::RegionFaces& regions,
                    const std::vector<FinalSurface>& surfaces);

}  // namespace quadseg::flow
