// Large scans from coarse to fine: at a million faces, chance shows so many patches that look unlike their surroundings
// that no price keeps them out and lets small surfaces in; on a mesh of the same shape with fewer faces it does not.
#pragma once

#include "flow/flow.h"
#include "flow/noise.h"

#include <cstddef>

namespace quadseg::flow {

struct NoisyCoarseSizes {
    std::size_t pays_from = 250000;     ///< below it small surfaces get too few faces of a simplified mesh
    std::size_t coarse_faces = 200000;  ///< but no more than half of the faces
};

/// The noisy flow (flow/noisy.h), on large meshes through a simplified one. Options::detail above 1 raises both sizes.
FlowResult run_noisy_coarse(const FlowInput& input, const NoiseEstimate& noise, const NoisyCoarseSizes& sizes = {});

}  // namespace quadseg::flow
