// The search for surfaces over all smooth charts of the mesh.
#pragma once

#include "exact/candidate.h"
#include "exact/face_fit.h"

#include <cstdint>
#include <vector>

namespace quadseg::exact {

struct SearchOptions {
    bool rows_only = false;  ///< only seeds in rows of long facets, and no discs around them
    bool loose = false;      ///< second pass, for parts whose edge curves are approximations
    bool quadrics = false;   ///< only general quadrics
    double tolerance = 0;    ///< of the vertices, unit frame; 0: that of the mesh
    double most_step = 10;   ///< candidates whose facets turn further are not taken, radians
};

/// Of `covered`, where 0 is free: belongs to a candidate; or can be grown into, but no search starts there.
inline constexpr std::uint8_t explained = 1, no_seed = 2;

/// Candidates of all charts, in an order that depends on the mesh only. `covered` (a flag a face) is read and extended.
/// Stopped: those found so far; the control knows.
std::vector<Candidate> search_surfaces(const Scene& scene, const SearchOptions& options,
                                       std::vector<std::uint8_t>& covered);

/// What the tessellator let a facet turn, radians: from the cylinders and cones with many facets, whose rulings leave
/// no doubt. A surface laid through the rims of several bands turns further. 0: nothing is known.
double learn_step(const std::vector<Candidate>& candidates);

}  // namespace quadseg::exact
