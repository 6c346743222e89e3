// The exact stage: on clean CAD meshes surfaces are hypothesised on patches and verified on vertices, which lie on the
// true surface to the precision of the file while wrong surfaces miss by orders of magnitude more.
#pragma once

#include <quadseg/segmentation.h>

#include "exact/facets.h"
#include "exact/tolerances.h"
#include "mesh/work_mesh.h"
#include "partition/regions.h"

#include <vector>

namespace quadseg::exact {

struct ExactSurfaces {
    partition::Labels labels;       ///< −1: no surface found (free-form); regions are edge-connected
    std::vector<Surface> surfaces;  ///< one a label, unit frame
    double covered = 0;             ///< share of the area that has a surface
    double noise = 0;               ///< median distance of vertices to their surfaces, unit frame
    double largest_step = 0;        ///< radians; see Selection
    bool partial = false;           ///< stopped: the surfaces found so far; free-form parts are labelled too
    Tolerances tolerances;
    Facets facets;  ///< of the mesh; partial: none
};

/// Throws Stopped while there is no surface yet.
ExactSurfaces find_exact_surfaces(const mesh::WorkMesh& mesh, const runtime::RunControl& control);

}  // namespace quadseg::exact
