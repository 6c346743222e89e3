// Second thoughts about tori: circles of revolution as few as three always lie on one, and four often do. A cylinder
// between two fillets or chamfers has such rims, and a torus through all of them would be in bands of unequal width, as
// no tessellator makes it.
#pragma once

#include "exact/candidate.h"

#include <vector>

namespace quadseg::exact {

/// A torus whose vertices lie on a few circles around its axis, at unequal steps of its tube.
bool has_uneven_bands(const Scene& scene, const Candidate& candidate);

/// Tori of uneven bands give way to surfaces of the single bands where those explain nearly all of them.
void split_uneven_bands(const Scene& scene, std::vector<Candidate>& candidates);

}  // namespace quadseg::exact
