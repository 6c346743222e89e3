// Faces that follow no simple surface, as smooth patches: few and stable, bounded by creases, explained faces and lines
// where the curvature jumps; where the curvature is not known (organic shapes, rough meshes) by energy.
#pragma once

#include "flow/flow.h"
#include "partition/regions.h"

namespace quadseg::flow {

/// Groups the faces of label −1 of `explained`; the others come out −1. Small regions amid faceted parts
/// (flow/faceted.h) become −1 in `explained` first. `surfaces`: one a label. Throws Stopped.
FlowResult group_freeform(const FlowInput& input, const std::vector<Surface>& surfaces, partition::Labels& explained);

}  // namespace quadseg::flow
