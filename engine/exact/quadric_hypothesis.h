// The last rung of the ladder: general quadrics, tried on what plane … torus have left.
#pragma once

#include "exact/grow.h"

#include <functional>
#include <optional>

namespace quadseg::exact {

/// A general quadric through the vertices of a disc around the seed, grown. Nine degrees of freedom follow any smooth
/// patch closely: only what holds to the precision of the coordinates counts, on several times as many vertices.
std::optional<Candidate> find_quadric(const Scene& scene, std::uint32_t seed,
                                      const std::function<bool(std::uint32_t)>& usable, Marks& marks);

}  // namespace quadseg::exact
