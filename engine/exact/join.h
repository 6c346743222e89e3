// Surfaces of facets that fold too far to be searched as one chart: two rows of a coarse fillet are a torus only
// together.
#pragma once

#include "exact/explained.h"

namespace quadseg::exact {

/// Searches small free pieces again, with creases that only folds of more than an octagon make.
void search_coarse_pieces(const Scene& scene, Explained& state);

/// Free pieces (bounded by creases) and their free neighbours over moderate folds become a region where one surface
/// explains both to the precision of the search.
void join_free_pieces(const Scene& scene, Explained& state);

}  // namespace quadseg::exact
