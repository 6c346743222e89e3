// Boundary smoothing of section 4.4.1 on the final surfaces.
#pragma once

#include "flow/final_surfaces.h"
#include "flow/flow.h"

#include <vector>

namespace quadseg::flow {

/// Moves the labels of faces near borders; region numbers stay. Returns whether any label changed; a run that is
/// stopped in here keeps its labels.
bool smooth_borders(const FlowInput& input, FlowResult& flow, const std::vector<FinalSurface>& surfaces);

}  // namespace quadseg::flow
