// The fuzzy regions of section 4.4.1: for each pair of adjacent regions the faces near their common border.
#pragma once

#include "partition/leaves.h"
#include "partition/regions.h"
#include "runtime/run_control.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace quadseg::partition {

struct BorderBands {
    struct Pair {
        std::int32_t a, b;  ///< labels, a < b
    };
    std::vector<Pair> pairs;
    /// Faces of pair i's band, ascending: face[begin[i]] … face[begin[i+1]−1].
    std::vector<std::uint32_t> begin, face;
    /// Pairs of one batch neither share nor touch each other's faces: they may be cut at once. CSR, pairs ascending.
    std::vector<std::uint32_t> batch_begin, batch_pair;

    std::size_t batch_count() const noexcept { return batch_begin.size() - 1; }
};

/// `width`: faces on each side, counted across edges, within the two regions. Deterministic.
BorderBands find_border_bands(const Passage& passage, const Labels& labels, int width,
                              const runtime::RunControl& control);

}  // namespace quadseg::partition
