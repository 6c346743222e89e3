// What a stopped search has to show.
#pragma once

#include "exact/candidate.h"
#include "exact/exact.h"

#include <cstdint>
#include <vector>

namespace quadseg::exact {

/// Faces by their owner, an index of a candidate or −1; `owner` empty: each face goes to the largest candidate that
/// reaches it. Connected parts, those of the faces without a candidate (free-form) included: no label is −1.
ExactSurfaces found_so_far(const mesh::WorkMesh& mesh, const std::vector<Candidate>& candidates,
                           std::vector<std::int32_t> owner);

}  // namespace quadseg::exact
