// Sums over the faces of regions, parts, facets …
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace quadseg::mesh {

/// sums[group[i]] += values[i] for all i whose group is not negative, in their order. Neighbours in memory are mostly
/// of one group: its sum stays in a register, where one in memory would make every face wait for the one before.
inline void add_by_group(std::span<const std::int32_t> group, std::span<const double> values, std::span<double> sums) {
    for (std::size_t i = 0; i < group.size();) {
        const std::int32_t own = group[i];
        if (own < 0) {
            ++i;
            continue;
        }
        double sum = sums[static_cast<std::size_t>(own)];
        for (; i < group.size() && group[i] == own; ++i) sum += values[i];
        sums[static_cast<std::size_t>(own)] = sum;
    }
}

}  // namespace quadseg::mesh
