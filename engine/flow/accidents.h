// Exact surfaces of meshes that have none.
#pragma once

#include "partition/regions.h"

namespace quadseg::flow {

/// Where hardly any of a mesh lies on exact surfaces (organic shapes, simplified meshes), the small ones are accidents:
/// three vertices lie on a plane, a few rows of facets on a torus. Labels of few faces become −1, the others stay as
/// they are.
void release_accidents(partition::Labels& labels);

}  // namespace quadseg::flow
