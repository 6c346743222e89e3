#include "partition/min_cut.h"

#include "partition/flow_network.h"

#include <boost/graph/boykov_kolmogorov_max_flow.hpp>

namespace quadseg::partition {

std::vector<std::uint8_t> minimum_cut(const CutGraph& graph) {
    const std::size_t nodes = graph.node_count();
    std::vector<std::uint8_t> side(nodes, 1);
    if (nodes == 0) return side;
    FlowNetwork network(graph);
    const auto index = boost::get(boost::vertex_index, network.graph);
    std::vector<FlowNetwork::Arc> predecessor(nodes + 2);
    std::vector<boost::default_color_type> color(nodes + 2);
    std::vector<std::int32_t> distance(nodes + 2);
    boost::boykov_kolmogorov_max_flow(
        network.graph, network.capacity_map(), network.residual_map(), network.reverse_map(),
        boost::make_iterator_property_map(predecessor.begin(), index),
        boost::make_iterator_property_map(color.begin(), index),
        boost::make_iterator_property_map(distance.begin(), index), index, network.source(), network.sink());
    for (std::size_t v = 0; v < nodes; ++v) side[v] = color[v] == boost::black_color ? 0 : 1;
    return side;
}

Capacity cut_value(const CutGraph& graph, const std::vector<std::uint8_t>& side) {
    Capacity value = 0;
    for (std::size_t v = 0; v < graph.node_count(); ++v) {
        value += side[v] == 0 ? graph.side1[v] : graph.side0[v];
        for (std::uint32_t a = graph.begin[v]; a < graph.begin[v + 1]; ++a) {
            if (graph.head[a] > v && side[graph.head[a]] != side[v]) value += graph.capacity[a];
        }
    }
    return value;
}

}  // namespace quadseg::partition
