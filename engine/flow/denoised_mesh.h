// A mesh moved until its faces agree with filtered normals: what surfaces there are shows on it before anything is
// known of them. Its noise is no longer independent, and creases are off by a fraction of an edge: to find regions by,
// not to judge them or to draw their borders.
#pragma once

#include "mesh/work_mesh.h"
#include "runtime/run_control.h"

#include <vector>

namespace quadseg::flow {

/// Positions after a few steps towards the planes of the given normals, these normals, and areas; of the rest only what
/// partition/ needs: faces and neighbours. Throws Stopped.
mesh::WorkMesh denoised_mesh(const mesh::WorkMesh& mesh, const std::vector<Vec3>& normals,
                             const runtime::RunControl& control);

}  // namespace quadseg::flow
