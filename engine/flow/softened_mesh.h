// The mesh that regions under noise are judged on. Single faces of a raw scan are folded by its noise, and the fits,
// the borders and what a merge seems to cost all suffer; on the mesh where regions are found (flow/denoised_mesh.h)
// creases are rounded and surfaces that nearly agree have become one. This one lies between: a step, longer where the
// noise is larger, that leaves the low frequencies of the noise, which are what a surface's parameters take up (a
// region's price stays the same).
#pragma once

#include "flow/noise.h"
#include "mesh/work_mesh.h"
#include "runtime/run_control.h"

#include <vector>

namespace quadseg::flow {

/// Filtered normals, one a face, that do for it; those by which regions are found do as well. Throws Stopped.
std::vector<Vec3> softening_normals(const mesh::WorkMesh& mesh, const NoiseEstimate& noise,
                                    const runtime::RunControl& control);

/// Positions, their areas and normals; of the rest only faces, neighbours and frame. Throws Stopped.
mesh::WorkMesh softened_mesh(const mesh::WorkMesh& mesh, const std::vector<Vec3>& normals, const NoiseEstimate& noise,
                             const runtime::RunControl& control);

}  // namespace quadseg::flow
