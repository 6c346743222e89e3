#include "partition/band_cut.h"

#include <algorithm>
#include <cmath>

namespace quadseg::partition {

void BandCut::add_edge(std::size_t i, std::size_t slot_i, std::size_t j, std::size_t slot_j, double price) {
    nodes_[i].neighbor[slot_i] = static_cast<std::int32_t>(4 * j + slot_j);
    nodes_[j].neighbor[slot_j] = static_cast<std::int32_t>(4 * i + slot_i);
    nodes_[i].capacity[slot_i] = nodes_[j].capacity[slot_j] = price;
}

/// Distances from the source in the residual graph; false when no sink can be reached.
bool BandCut::find_levels() {
    queue_.clear();
    for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
        Node& node = nodes_[i];
        node.level = node.terminal > rounding_ ? 0 : -1;
        node.arc = 0;
        if (node.level == 0) queue_.push_back(i);
    }
    bool sink_reached = false;
    for (std::size_t head = 0; head < queue_.size(); ++head) {
        const Node& node = nodes_[queue_[head]];
        if (node.terminal < -rounding_) sink_reached = true;
        for (std::size_t k = 0; k < 3; ++k) {
            if (node.neighbor[k] < 0 || !(node.capacity[k] > rounding_)) continue;
            const auto next = static_cast<std::uint32_t>(node.neighbor[k] / 4);
            if (nodes_[next].level >= 0) continue;
            nodes_[next].level = node.level + 1;
            queue_.push_back(next);
        }
    }
    return sink_reached;
}

/// Pushes what the node has from the source along shortest paths, until it is empty or stuck.
void BandCut::push_from(std::size_t source) {
    path_.assign(1, static_cast<std::uint32_t>(source));
    while (nodes_[source].terminal > rounding_) {
        Node& tip = nodes_[path_.back()];
        if (tip.terminal < -rounding_) {
            double flow = std::min(nodes_[source].terminal, -tip.terminal);
            for (std::size_t i = 0; i + 1 < path_.size(); ++i) {
                const Node& node = nodes_[path_[i]];
                flow = std::min(flow, node.capacity[node.arc]);
            }
            nodes_[source].terminal -= flow;
            tip.terminal += flow;
            for (std::size_t i = 0; i + 1 < path_.size(); ++i) {
                Node& node = nodes_[path_[i]];
                const std::int32_t back = node.neighbor[node.arc];
                node.capacity[node.arc] -= flow;
                nodes_[static_cast<std::size_t>(back / 4)].capacity[static_cast<std::size_t>(back % 4)] += flow;
            }
            path_.resize(1);
            continue;
        }
        bool advanced = false;
        for (; tip.arc < 3; ++tip.arc) {
            if (tip.neighbor[tip.arc] < 0 || !(tip.capacity[tip.arc] > rounding_)) continue;
            const auto next = static_cast<std::uint32_t>(tip.neighbor[tip.arc] / 4);
            if (nodes_[next].level != tip.level + 1) continue;
            path_.push_back(next);
            advanced = true;
            break;
        }
        if (advanced) continue;
        tip.level = -1;
        path_.pop_back();
        if (path_.empty()) return;
        ++nodes_[path_.back()].arc;
    }
}

const std::vector<std::uint8_t>& BandCut::solve() {
    double largest = 0;
    for (const Node& node : nodes_) largest = std::max(largest, std::abs(node.terminal));
    rounding_ = 1e-12 * largest;
    while (find_levels()) {
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            if (nodes_[i].level == 0) push_from(i);
        }
    }
    side_.resize(nodes_.size());
    // What the source still reaches is on the first side.
    for (std::size_t i = 0; i < nodes_.size(); ++i) side_[i] = nodes_[i].level >= 0 ? 0 : 1;
    return side_;
}

}  // namespace quadseg::partition
