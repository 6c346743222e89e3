// The search for surfaces over all smooth charts of the mesh.
#pragma once

#include "exact/candidate.h"

#include <vector>

namespace quadseg::exact {

/// Candidates of all charts, in an order that depends on the mesh only. `covered` (a flag a face) is read and extended.
std::vector<Candidate> search_surfaces(const Scene& scene, bool loose, std::vector<std::uint8_t>& covered);

}  // namespace quadseg::exact
