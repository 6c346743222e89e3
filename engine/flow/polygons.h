// Polygons of the file that were cut into triangles share one label.
#pragma once

#include "flow/flow.h"

namespace quadseg::flow {

/// Triangles of one polygon take the label that covers most of its area (the smaller one on a tie). Regions that fall
/// apart by this become several; surfaces follow their regions.
void unify_polygons(const mesh::WorkMesh& mesh, FlowResult& flow);

}  // namespace quadseg::flow
