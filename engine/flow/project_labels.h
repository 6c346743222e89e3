// Labels of a simplified mesh brought to the mesh that it was made from (section 5.2), and made connected there.
#pragma once

#include "partition/leaves.h"
#include "partition/regions.h"
#include "runtime/run_control.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace quadseg::flow {

/// The label of each face's stand-in; −1 stays −1.
partition::Labels project_labels(std::span<const std::int32_t> coarse_labels, std::span<const std::uint32_t> face_map);

/// Every label becomes a region that is connected across the passage: its largest part. Another part stands as a region
/// of its own from `independent_share` of the largest part's area on; smaller ones, and faces of label −1, are flooded
/// from their neighbours, across the flattest edges first come. What nothing can reach becomes a region. Renumbers by
/// first face; returns the number of regions.
std::size_t connect_labels(const partition::Passage& passage, partition::Labels& labels, double independent_share,
                           const runtime::RunControl& control);

}  // namespace quadseg::flow
