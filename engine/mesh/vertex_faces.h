// Faces at every vertex, found so that a call can be stopped meanwhile.
#pragma once

#include "mesh/work_mesh.h"
#include "runtime/run_control.h"

namespace quadseg::mesh {

/// Throws Stopped.
VertexFaces vertex_faces(const WorkMesh& mesh, const runtime::RunControl& control);

}  // namespace quadseg::mesh
