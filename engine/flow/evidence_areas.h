// What a face counts for under noise. Every vertex tells as much as any other, wherever the mesh is dense: ∫d² should
// have its faces' areas divided by a, the local area of a vertex. Normals are the noisier the denser the mesh is: their
// part should stay as it is. Both have one weight, so it is the mean of the two, area / √a.
#pragma once

#include "mesh/work_mesh.h"
#include "runtime/run_control.h"

#include <vector>

namespace quadseg::flow {

/// F' weights, ≥ 0, that sum to `total`. Where the mesh is evenly dense they are as the areas of its faces. Throws
/// Stopped.
std::vector<double> evidence_areas(const mesh::WorkMesh& mesh, double total, const runtime::RunControl& control);

}  // namespace quadseg::flow
