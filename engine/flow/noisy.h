// The flow for scans: every decision is weighed against what chance would do at the estimated noise.
#pragma once

#include "flow/flow.h"
#include "flow/noise.h"

#include <vector>

namespace quadseg::flow {

/// What a simplified scan shows has been averaged: its many faces ask for no higher prices.
enum class Scan { raw, simplified };

/// On the denoised mesh: leaves → merging by description length; on the softened one: relaxation with a price on border
/// length → merging by complete fits → clean-up. Faces count by their evidence (flow/evidence_areas.h). Finds the
/// number of regions itself (options.regions is not looked at).
FlowResult run_noisy(const FlowInput& input, const NoiseEstimate& noise, Scan scan = Scan::raw);

/// Its second half, on the softened mesh, from connected regions found elsewhere: labels 0 … n−1, all of
/// them in use. `normals`: softening_normals() (flow/softened_mesh.h), where they are at hand; empty: found here.
FlowResult refine_noisy(const FlowInput& input, const NoiseEstimate& noise, const partition::Labels& labels,
                        std::vector<Vec3> normals = {});

}  // namespace quadseg::flow
