// Tori of scans. A quadric follows a torus over a short arc only, so that merging leaves bent pipes and long fillets in
// pieces; here neighbours become one where a torus describes them more shortly than their quadrics do.
#pragma once

#include <quadseg/segmentation.h>

#include "flow/complete_merge.h"
#include "partition/pair_merge.h"
#include "partition/regions.h"
#include "quadric/region_fit.h"
#include "runtime/run_control.h"

#include <vector>

namespace quadseg::flow {

struct TorusMergeRules {
    CompleteMergeRules merge;  ///< in which a torus has 7 parameters
    double cut_weight = 0;     ///< ω where the borders of tori are drawn anew
    double border_price = 0;   ///< of a unit of length there
    double least_ratio = 1;    ///< of the two radii: nearly closed rings bend like anything that is smooth
};

/// Labels 0 … count−1 without gaps, with a complete fit and moments each, about meshes whose noise the rules know. They
/// keep the lower number of a merged pair and their order, without gaps. What a quadric held beyond the end of a torus
/// goes back to it. Returns one surface a region that is left: its torus, or of type freeform. Deterministic. Throws
/// Stopped: labels are then those of a whole step, with gaps.
std::vector<Surface> merge_into_tori(const partition::Passage& passage, partition::Labels& labels,
                                     const std::vector<quadric::RegionFit>& fits,
                                     const std::vector<partition::MergeRegion>& moments, const TorusMergeRules& rules,
                                     const runtime::RunControl& control);

}  // namespace quadseg::flow
