// Steps by which the vertices of a noisy mesh give way to their surroundings.
#pragma once

#include "mesh/vertex_faces.h"
#include "mesh/work_mesh.h"
#include "runtime/run_control.h"

namespace quadseg::flow {

// Both move every vertex at once by `share` (0 to 1) of its way; the same at any thread count. Throw Stopped.

/// The way: the mean of what brings it onto the planes of its faces, through their centroids with mesh.normals.
void move_to_planes(mesh::WorkMesh& mesh, const mesh::VertexFaces& incident, double share,
                    const runtime::RunControl& control);
/// The way: to the mean of itself and its neighbours.
void move_to_ring(mesh::WorkMesh& mesh, const mesh::VertexFaces& incident, double share,
                  const runtime::RunControl& control);

}  // namespace quadseg::flow
