// Surfaces whose tessellation was divided further: by subdivision, boolean operations, repairs of T-junctions. The new
// vertices lie on the facets instead of on the surface, so that no surface is exact; without them, one is.
#pragma once

#include "exact/exact.h"
#include "flow/flow.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace quadseg::flow {

struct DividedSurfaces {
    partition::Labels labels;       ///< a work face each, not numbered without gaps; −1: none
    std::vector<Surface> surfaces;  ///< one a label, unit frame
    /// A work vertex each: 1 where a vertex lies on the facets of its curved surface, not on it.
    std::vector<std::uint8_t> on_facets;
};

/// exact: complete, of input.mesh. Looks for the surfaces of the plain tessellation where planes, or faces without a
/// surface (label −1), lie in rows that fold gently and have vertices that are no corners of theirs. Components are
/// taken over as a whole where that explains as much by less, else surfaces that take the place of whole regions. None:
/// nothing changes. Throws Stopped.
std::optional<DividedSurfaces> find_divided(const FlowInput& input, const exact::ExactSurfaces& exact);

}  // namespace quadseg::flow
