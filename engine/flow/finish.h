// From labels to a Segmentation: post-processing, final surfaces, quality figures, input face order.
#pragma once

#include "flow/flow.h"

namespace quadseg::flow {

/// Everything of Segmentation but seconds, threads and peak_bytes. Stopping is ignored in here where it is bounded by
/// O(F); a run that is already partial skips smoothing and projection.
Segmentation finish(const FlowInput& input, FlowResult&& flow);

}  // namespace quadseg::flow
