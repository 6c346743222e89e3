// Where the border between two regions runs best, within a band of faces around where it is.
#pragma once

#include "partition/border_price.h"
#include "partition/leaves.h"
#include "partition/regions.h"
#include "quadric/region_fit.h"
#include "runtime/run_control.h"

#include <cstdint>
#include <span>
#include <vector>

namespace quadseg::partition {

struct BorderCutOptions {
    double weight = 0.5;  ///< ω
    BorderPrice border;
    int rings = 4;  ///< of faces on both sides that may change
};

/// Faces of the regions a < b that change sides.
struct BorderCut {
    std::int32_t a = 0, b = 0;
    std::vector<std::uint32_t> faces;
};

/// The cheapest cut for every pair of regions that meets at one of `border_faces`, each as if it were alone, in
/// parallel.
std::vector<BorderCut> cut_borders(const Passage& passage, const Labels& labels,
                                   std::span<const quadric::RegionFit> fits, const BorderCutOptions& options,
                                   std::span<const std::uint32_t> border_faces, const runtime::RunControl& control);

}  // namespace quadseg::partition
