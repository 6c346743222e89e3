// The exact stage: on clean CAD meshes surfaces are hypothesised on patches and verified on vertices, which lie on the
// true surface to the precision of the file while wrong surfaces miss by orders of magnitude more.
#pragma once

#include "flow/flow.h"

namespace quadseg::flow {

struct ExactResult {
    partition::Labels labels;       ///< −1: no surface found (free-form)
    std::vector<Surface> surfaces;  ///< one a label, unit frame
    double covered = 0;             ///< share of the area with a surface
    double noise = 0;               ///< median distance of vertices to their surfaces, unit frame
};

/// Throws Stopped.
ExactResult find_exact_surfaces(const mesh::WorkMesh& mesh, const runtime::RunControl& control);

}  // namespace quadseg::flow
