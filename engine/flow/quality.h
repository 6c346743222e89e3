// How far the vertices of regions lie from their surfaces.
#pragma once

#include "flow/flow.h"

#include <vector>

namespace quadseg::flow {

struct RegionQuality {
    double area = 0;              ///< unit frame
    double squared_distance = 0;  ///< ∫ d² by vertices: a third of each face's area at each corner
    double max_distance = 0;
};

/// `surfaces`: one a region, unit frame. Exact distances; O(F) evaluations, parallel over blocks of faces.
std::vector<RegionQuality> measure_quality(const mesh::WorkMesh& mesh, const partition::RegionFaces& regions,
                                           const std::vector<Surface>& surfaces);

}  // namespace quadseg::flow
