// Clean-up: regions too small to stand alone join the neighbour that explains them best.
#pragma once

#include "partition/leaves.h"
#include "partition/regions.h"
#include "quadric/region_fit.h"
#include "runtime/run_control.h"

#include <cstddef>
#include <span>

namespace quadseg::partition {

struct AbsorbOptions {
    std::size_t smallest_region = 4;  ///< regions of fewer faces are absorbed where a neighbour explains them …
    double tolerance = 0;             ///< … that is, at an energy per area of at most this
    double smallest_area = 0;         ///< regions of less area (unit frame) are absorbed at any price
    double weight = 0.5;              ///< ω of the energy
};

/// Labels 0 … count−1 with one fit each; returns the number of regions, renumbered without gaps. Regions without a
/// neighbour across the passage stay.
std::size_t absorb_small(const Passage& passage, Labels& labels, std::size_t count,
                         std::span<const quadric::RegionFit> fits, const AbsorbOptions& options,
                         const runtime::RunControl& control);

}  // namespace quadseg::partition
