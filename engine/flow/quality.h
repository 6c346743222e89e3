// How far the vertices of regions lie from their surfaces, and the energy of their proxies.
#pragma once

#include "flow/final_surfaces.h"
#include "flow/flow.h"
#include "quadric/energy.h"
#include "runtime/run_control.h"

#include <vector>

namespace quadseg::flow {

struct RegionQuality {
    double area = 0;              ///< unit frame
    double squared_distance = 0;  ///< ∫ d² by vertices: a third of each face's area at each corner
    double max_distance = 0;
    quadric::TriangleEnergy energy;  ///< of the loop's proxy where there is one, else of the quadric
    double gradient = 0;             ///< ∫ |∇f(c_t)| of the quadric
    double against = 0;              ///< area where n·∇f(c_t) ≤ 0
};

/// RegionQuality::area of every region.
std::vector<double> region_areas(const mesh::WorkMesh& mesh, const partition::RegionFaces& regions);

/// Exact distances; O(F) evaluations, parallel over blocks of faces. Once `control` says stop, what is left is
/// estimated from a few.
std::vector<RegionQuality> measure_quality(const mesh::WorkMesh& mesh, const partition::RegionFaces& regions,
                                           const std::vector<FinalSurface>& surfaces,
                                           const runtime::RunControl& control);

}  // namespace quadseg::flow
