// Minimum cut of a small undirected graph between two terminals (Boykov, Kolmogorov 2004).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace quadseg::partition {

/// Capacities are whole numbers, so that the result depends on nothing but the graph.
using Capacity = std::int64_t;

/// Nodes 0 … n−1 and their neighbours, CSR: arcs of v are begin[v] … begin[v+1]−1. Every edge is there twice, once from
/// each end, with the same capacity; no parallel edges.
struct CutGraph {
    std::vector<std::uint32_t> begin, head;
    std::vector<Capacity> capacity;
    /// To the terminals: what it costs to part v from side 0, from side 1.
    std::vector<Capacity> side0, side1;
    std::size_t node_count() const noexcept { return side0.size(); }
};

/// Side (0 or 1) of every node in the minimum cut whose side 0 is smallest.
std::vector<std::uint8_t> minimum_cut(const CutGraph& graph);

/// What a labelling costs: the sum of all capacities between the sides.
Capacity cut_value(const CutGraph& graph, const std::vector<std::uint8_t>& side);

}  // namespace quadseg::partition
