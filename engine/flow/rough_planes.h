// What a stopped call says of very many regions to which nothing has been fitted yet.
#pragma once

#include "flow/flow.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace quadseg::flow {

/// More regions than this get planes when a call is stopped: fits would take longer than a stop may.
inline constexpr std::size_t most_rough_fits = 64;

/// The plane of a region's mean normal, through two of its faces, with their distances (unit frame).
struct RoughPlane {
    Vec3 normal{0, 0, 1}, point;
    double area = 0;
    double normal_energy = 0;    ///< E_n, of all faces
    double distance_energy = 0;  ///< E_d and ∫ d² by vertices, as the two faces have it
    double squared_distance = 0;
    double max_distance = 0;
    bool agrees = true;  ///< the two faces look the plane's way
};

/// One a label; one pass over the mesh, whatever the number of regions: as many as a flow has leaves.
std::vector<RoughPlane> rough_planes(const mesh::WorkMesh& mesh, const partition::Labels& labels, std::size_t count);

}  // namespace quadseg::flow
