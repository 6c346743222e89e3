// The median of distances: robust fits ask for it at every step.
#pragma once

#include <cstddef>

namespace quadseg::surface {

/// Median of |values[0 … n)| with `scratch` of the same size; infinite where one of them is no number.
double median_magnitude(const double* values, std::size_t n, double* scratch);

}  // namespace quadseg::surface
