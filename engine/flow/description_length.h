// Description length of a region under noise: the misfit of its best model plus a price for each parameter.
#pragma once

#include "partition/pair_merge.h"
#include "quadric/moments.h"
#include "quadric/monomials.h"

namespace quadseg::flow {

struct PricedFit {
    quadric::Coefficients c{};  ///< in the frame of the moments
    double energy = 0;          ///< E_d + ω E_n
    double length = 0;          ///< energy + price · parameters
    int parameters = 3;         ///< plane 3, sphere 4, cylinder 5, surface of revolution 7, quadric 12
};

/// Parameters that a general quadric is charged for.
inline constexpr int quadric_parameters = 12;

/// The model of smallest description length for unit-weight moments.
PricedFit fit_priced(const quadric::Moments& m, double weight, double price) noexcept;
/// The best plane, charged likewise.
PricedFit plane_priced(const quadric::Moments& m, double weight, double price) noexcept;

}  // namespace quadseg::flow
