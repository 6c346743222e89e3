// Facets amid a surface that do not lie on it: remeshing cuts the corners of some.
#pragma once

#include <quadseg/segmentation.h>

#include "exact/facets.h"
#include "mesh/work_mesh.h"
#include "partition/regions.h"
#include "runtime/run_control.h"

#include <vector>

namespace quadseg::flow {

/// Regions, and connected faces without one (−1), of a few facets' size join the curved region of at least ten times
/// their area that they pass gently into along most of their border. Labels are not renumbered. Throws Stopped.
void absorb_facet_crumbs(const mesh::WorkMesh& mesh, const exact::Facets& facets, const std::vector<Surface>& surfaces,
                         const runtime::RunControl& control, partition::Labels& labels);

}  // namespace quadseg::flow
