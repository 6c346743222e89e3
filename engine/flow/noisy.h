// The flow for scans: every decision is weighed against what chance would do at the estimated noise.
#pragma once

#include "flow/flow.h"
#include "flow/noise.h"

namespace quadseg::flow {

/// Leaves on filtered normals → merging by description length, relaxed between its levels with a price on border
/// length → merging by complete fits → clean-up. Finds the number of regions itself (options.regions is not looked at).
FlowResult run_noisy(const FlowInput& input, const NoiseEstimate& noise);

}  // namespace quadseg::flow
