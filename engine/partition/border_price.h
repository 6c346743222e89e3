// What the border between two regions costs. Its length alone (Potts model) makes borders short wherever the data leave
// them open; but surfaces of one solid also meet where they part, so a border far from where the two meet costs more.
// Where a fillet leaves its plane no distance of single faces shows it within many edges, the two fits do.
#pragma once

#include "mesh/work_mesh.h"
#include "quadric/region_fit.h"

#include <cstddef>

namespace quadseg::partition {

/// Edge k of face f, unit frame.
inline double edge_length(const mesh::WorkMesh& mesh, std::size_t f, std::size_t k) noexcept {
    const auto& v = mesh.faces[f];
    return norm(mesh.positions[v[(k + 1) % 3]] - mesh.positions[v[k]]);
}

struct BorderPrice {
    double length = 0;  ///< of a unit of length; 0: borders are free
    double gap = 0;     ///< times 1 + gap · d² where the surfaces are d apart, at most eleven times

    /// Of edge k of face f, with face g beyond, as the border between regions with these surfaces. The same from either
    /// side.
    double of_edge(const mesh::WorkMesh& mesh, std::size_t f, std::size_t k, std::size_t g, const quadric::Proxy& a,
                   const quadric::Proxy& b) const noexcept;
};

}  // namespace quadseg::partition
