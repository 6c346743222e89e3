// Merging when few regions are left: pairs are scored with complete fits and true energies, which the quadratic ones of
// moments overestimate where |∇f| varies (cones).
#pragma once

#include "partition/leaves.h"
#include "partition/pair_merge.h"
#include "partition/regions.h"
#include "quadric/region_fit.h"
#include "runtime/run_control.h"

#include <cstddef>
#include <vector>

namespace quadseg::flow {

struct CompleteMergeRules {
    double weight = 0;               ///< ω
    double price = 0;                ///< of a parameter, unit of the energy
    double region_price = 0;         ///< of a region as such: chance has as many places as there are faces to raise one
    double border_reward = 0;        ///< of removed border, per length
    double misfit = 0;               ///< a merge may lengthen the description by this, per area of the smaller region
    double blur = 0, blur_area = 0;  ///< and, of the smaller area a, by blur · a² / (a + blur_area)
    double size_ratio = 8;           ///< beyond it the smaller region is tried under the larger one's surface as it is
};

/// Labels 0 … count−1 without gaps, with a complete fit (to whatever weight) and moments each. Returns the number of
/// regions left; labels keep the lower number of a merged pair and their order (partition::close_gaps). Throws Stopped.
std::size_t merge_by_complete_fits(const partition::Passage& passage, partition::Labels& labels,
                                   std::vector<quadric::RegionFit> fits, std::vector<partition::MergeRegion> moments,
                                   const CompleteMergeRules& rules, const runtime::RunControl& control);

}  // namespace quadseg::flow
