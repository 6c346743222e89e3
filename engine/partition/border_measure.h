// How long and how jagged the borders between regions are.
#pragma once

#include <quadseg/segmentation.h>

#include "mesh/work_mesh.h"
#include "partition/regions.h"

namespace quadseg::partition {

/// Length: of all edges between two labels, over the diagonal. Zigzag: mean turning angle in degrees over the vertices
/// where exactly two such edges meet (junctions of borders do not count).
BorderMeasure measure_borders(const mesh::WorkMesh& mesh, const Labels& labels);

}  // namespace quadseg::partition
