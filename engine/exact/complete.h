// Completing the partition: planes among the facets that no surface claimed, and free faces beside surfaces that
// explain them.
#pragma once

#include "exact/explained.h"

namespace quadseg::exact {

/// Facets bounded by creases or explained faces are planes; so are small leftovers of a few facets of several triangles
/// each.
void add_planes(const Scene& scene, double largest_step, Explained& state);

/// Free faces join the neighbouring region whose surface they lie on within the border tolerance, best first.
void extend_to_borders(const Scene& scene, double largest_step, Explained& state);

}  // namespace quadseg::exact
