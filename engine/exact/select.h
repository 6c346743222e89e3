// Settling overlapping claims: every face goes to the candidate that explains it best.
#pragma once

#include "exact/candidate.h"

#include <cstdint>
#include <vector>

namespace quadseg::exact {

struct Selection {
    std::vector<std::int32_t> owner;  ///< index of a candidate, or −1
    double noise = 0;                 ///< median over the claimed area of the candidates' median distances
    double largest_step = 0;  ///< tessellation step of this mesh: what the tessellator let a facet turn, radians
};

/// Median over the claimed area of the candidates' median distances, unit frame.
double noise_of(const std::vector<Candidate>& candidates);

/// What true surfaces of a mesh with this noise stay below with the median of their vertices, unless trim curves are
/// off.
double sure_distance(const Scene& scene, double noise);

/// `largest_step`: what a facet of this mesh may turn, radians. Candidates that are refused lose all their faces.
Selection select(const Scene& scene, const std::vector<Candidate>& candidates, double largest_step);

}  // namespace quadseg::exact
