#include "flow/polygons.h"

#include <algorithm>
#include <type_traits>
#include <utility>
#include <vector>

namespace quadseg::flow {

namespace {

/// (polygon, face) of the polygons whose triangles differ in label, sorted.
std::vector<std::pair<std::uint32_t, std::uint32_t>> mixed_polygons(const mesh::WorkMesh& mesh,
                                                                    const partition::Labels& labels) {
    std::vector<std::uint8_t> mixed(mesh.face_count(), 0);
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        const auto first = static_cast<std::size_t>(mesh.polygon[f]);
        if (labels[f] != labels[first]) mixed[first] = 1;
    }
    std::vector<std::pair<std::uint32_t, std::uint32_t>> members;
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        const auto first = static_cast<std::uint32_t>(mesh.polygon[f]);
        if (mixed[first] != 0) members.emplace_back(first, static_cast<std::uint32_t>(f));
    }
    std::sort(members.begin(), members.end());
    return members;
}

}  // namespace

void unify_polygons(const mesh::WorkMesh& mesh, FlowResult& flow) {
    if (mesh.polygon.empty()) return;
    const auto members = mixed_polygons(mesh, flow.labels);
    if (members.empty()) return;
    std::vector<std::pair<std::int32_t, double>> area;  // of each label in one polygon
    for (std::size_t begin = 0, end = 0; begin < members.size(); begin = end) {
        area.clear();
        for (; end < members.size() && members[end].first == members[begin].first; ++end) {
            const std::uint32_t f = members[end].second;
            const auto at = std::find_if(area.begin(), area.end(),
                                         [&](const auto& entry) { return entry.first == flow.labels[f]; });
            if (at == area.end()) {
                area.emplace_back(flow.labels[f], mesh.areas[f]);
            } else {
                at->second += mesh.areas[f];
            }
        }
        const auto best = std::max_element(area.begin(), area.end(), [](const auto& a, const auto& b) {
            return a.second != b.second ? a.second < b.second : a.first > b.first;
        });
        for (std::size_t i = begin; i < end; ++i) flow.labels[members[i].second] = best->first;
    }
    flow.fits.clear();
    const partition::Labels before = flow.labels;
    flow.regions = partition::split_disconnected(mesh, flow.labels);
    const auto hand_on = [&](auto& of_regions) {
        if (of_regions.empty()) return;
        std::remove_reference_t<decltype(of_regions)> handed_on(flow.regions);
        for (std::size_t f = before.size(); f-- > 0;) {
            handed_on[static_cast<std::size_t>(flow.labels[f])] = of_regions[static_cast<std::size_t>(before[f])];
        }
        of_regions = std::move(handed_on);
    };
    hand_on(flow.surfaces);
    hand_on(flow.faceted);
}

}  // namespace quadseg::flow
