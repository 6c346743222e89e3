// A cut graph in the form in which Boost's maximum-flow algorithms take it: static, compressed rows.
#pragma once

#include "partition/min_cut.h"

#include <algorithm>
#include <boost/graph/compressed_sparse_row_graph.hpp>
#include <boost/property_map/property_map.hpp>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace quadseg::partition {

/// Node v of the cut graph is vertex v; source and sink follow. The smaller of a node's two terminal capacities is cut
/// in any case and left out, so that every node has one terminal arc at most.
struct FlowNetwork {
    using Graph = boost::compressed_sparse_row_graph<boost::directedS, boost::no_property, boost::no_property,
                                                     boost::no_property, std::uint32_t, std::uint32_t>;
    using Arc = boost::graph_traits<Graph>::edge_descriptor;

    explicit FlowNetwork(const CutGraph& cut) : nodes_(static_cast<std::uint32_t>(cut.node_count())) {
        const std::uint32_t s = source(), t = sink();
        std::vector<std::pair<std::uint32_t, std::uint32_t>> arcs;
        std::vector<std::uint32_t> twin;
        arcs.reserve(cut.head.size() + 2 * nodes_);
        std::vector<std::uint32_t> terminal_arc(nodes_, 0);
        std::vector<std::uint32_t> first(nodes_ + 1, 0);
        for (std::uint32_t v = 0; v < nodes_; ++v) {
            first[v] = static_cast<std::uint32_t>(arcs.size());
            for (std::uint32_t a = cut.begin[v]; a < cut.begin[v + 1]; ++a) {
                arcs.emplace_back(v, cut.head[a]);
                capacity.push_back(cut.capacity[a]);
            }
            const Capacity surplus = cut.side0[v] - cut.side1[v];
            if (surplus == 0) continue;
            terminal_arc[v] = static_cast<std::uint32_t>(arcs.size());
            arcs.emplace_back(v, surplus > 0 ? s : t);
            capacity.push_back(surplus > 0 ? 0 : -surplus);
        }
        for (const bool from_source : {true, false}) {
            for (std::uint32_t v = 0; v < nodes_; ++v) {
                const Capacity surplus = cut.side0[v] - cut.side1[v];
                if (surplus == 0 || (surplus > 0) != from_source) continue;
                arcs.emplace_back(from_source ? s : t, v);
                capacity.push_back(from_source ? surplus : 0);
            }
        }
        twin.resize(arcs.size());
        for (std::uint32_t v = 0; v < nodes_; ++v) {
            for (std::uint32_t k = 0; k < cut.begin[v + 1] - cut.begin[v]; ++k) {
                const std::uint32_t w = cut.head[cut.begin[v] + k];
                const auto back = std::find(cut.head.begin() + cut.begin[w], cut.head.begin() + cut.begin[w + 1], v);
                twin[first[v] + k] = first[w] + static_cast<std::uint32_t>(back - cut.head.begin()) - cut.begin[w];
            }
        }
        for (std::uint32_t a = 0; a < arcs.size(); ++a) {
            if (arcs[a].first < nodes_) continue;
            twin[a] = terminal_arc[arcs[a].second];
            twin[twin[a]] = a;
        }
        graph = Graph(boost::edges_are_sorted, arcs.begin(), arcs.end(), nodes_ + 2);
        residual.resize(arcs.size());
        reverse.resize(arcs.size());
        for (std::uint32_t a = 0; a < arcs.size(); ++a) reverse[a] = Arc(arcs[twin[a]].first, twin[a]);
    }

    std::uint32_t source() const noexcept { return nodes_; }
    std::uint32_t sink() const noexcept { return nodes_ + 1; }
    auto capacity_map() { return boost::make_iterator_property_map(capacity.begin(), arc_index()); }
    auto residual_map() { return boost::make_iterator_property_map(residual.begin(), arc_index()); }
    auto reverse_map() { return boost::make_iterator_property_map(reverse.begin(), arc_index()); }

    Graph graph;
    std::vector<Capacity> capacity, residual;
    std::vector<Arc> reverse;

  private:
    boost::property_map<Graph, boost::edge_index_t>::const_type arc_index() const {
        return boost::get(boost::edge_index, graph);
    }
    std::uint32_t nodes_;
};

}  // namespace quadseg::partition
