// Costs of collapses, eight edges side by side.
#pragma once

#include "simplify/collapse_mesh.h"

#include <cstdint>
#include <span>

namespace quadseg::simplify {

struct RatedEdge {
    std::uint32_t v, w;
    float cost;
};

/// The costs that place_collapsed() gives.
void rate_edges(const CollapseMesh& mesh, std::span<RatedEdge> edges);

}  // namespace quadseg::simplify
