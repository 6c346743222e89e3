// Minimum cut of a band of faces between two regions: moves whole rows of faces at once, where one face at a time would
// have to pass through a longer border.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace quadseg::partition {

/// Nodes have at most three neighbours. After solve() every node is on one side.
class BandCut {
  public:
    void clear() noexcept { nodes_.clear(); }
    std::size_t size() const noexcept { return nodes_.size(); }
    /// first, second: what the node costs on the first and on the second side.
    void add_node(double first, double second) { nodes_.push_back({second - first, {}, {-1, -1, -1}, 0, 0}); }
    /// Costs `price` when the nodes end on different sides. Slots 0 … 2 of a node serve one edge each.
    void add_edge(std::size_t i, std::size_t slot_i, std::size_t j, std::size_t slot_j, double price);
    /// Side of each node: 0 first, 1 second. The cheapest there is (Dinic's algorithm).
    const std::vector<std::uint8_t>& solve();

  private:
    struct Node {
        double terminal;  ///< > 0: what may still flow in from the source (first side); < 0: out to the sink
        std::array<double, 3> capacity;
        std::array<std::int32_t, 3> neighbor;  ///< 4 · node + its slot back; −1: none
        std::int32_t level;
        std::uint8_t arc;  ///< the next slot to try
    };
    bool find_levels();
    void push_from(std::size_t source);

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> queue_, path_;
    std::vector<std::uint8_t> side_;
    double rounding_ = 0;
};

}  // namespace quadseg::partition
