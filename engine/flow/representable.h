// Coordinates whose areas and quadric coefficients double numbers can hold.
#pragma once

#include <quadseg/mesh.h>

namespace quadseg::flow {

/// Throws Error invalid_mesh when areas (squares of lengths) or coefficients (squares of coordinates over lengths) of a
/// result in the input's unit could overflow.
void require_representable(const MeshReport& report);

}  // namespace quadseg::flow
