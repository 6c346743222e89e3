// What "on the surface" means on a clean mesh: lengths in the unit frame, from the diagonal and the precision of the
// coordinates.
#pragma once

#include "mesh/work_mesh.h"

namespace quadseg::exact {

struct Tolerances {
    double diagonal = 1;
    double precision = 0;  ///< standard deviation of the rounding of the coordinates (text digits, float32)
    double facet = 0;      ///< vertex to the plane of a facet
    double fit = 0;        ///< first pass: vertices of a patch to its surface
    double loose_fit = 0;  ///< second pass, for parts whose edge curves are approximations
    double trim = 0;       ///< how far vertices on trim curves may be off, also the tolerance of growing
    double gap = 0;        ///< up to here a neighbour that creeps away speaks against a surface
    double border = 0;     ///< unclaimed faces join a neighbour within this
};

Tolerances choose_tolerances(const mesh::WorkMesh& mesh);

/// Standard deviation of the rounding of the coordinates, unit frame: from the number of significant digits that they
/// have, or from their being float32. Samples at most 4,096 vertices.
double coordinate_precision(const mesh::WorkMesh& mesh);

}  // namespace quadseg::exact
