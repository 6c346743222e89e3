// Normals smoothed within smooth parts and kept apart across creases: to find regions by on scans, not to judge
// them (in an energy of borders they round the creases).
#pragma once

#include "mesh/work_mesh.h"
#include "runtime/run_control.h"

#include <vector>

namespace quadseg::flow {

/// One or two averages over the ring of faces that share a vertex, then `passes` bilateral ones. Throws Stopped.
std::vector<Vec3> filtered_normals(const mesh::WorkMesh& mesh, int averages, int passes,
                                   const runtime::RunControl& control);

}  // namespace quadseg::flow
