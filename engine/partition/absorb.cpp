#include "partition/absorb.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace quadseg::partition {
namespace {

struct Neighbor {
    std::int32_t label = -1;
    double energy = 0;
};

/// Neighbour of the region of `faces` whose surface costs least on them; label −1: none.
Neighbor cheapest_neighbor(const Passage& passage, const Labels& labels, std::span<const std::uint32_t> faces,
                           std::span<const quadric::RegionFit> fits, double weight) {
    const mesh::WorkMesh& mesh = *passage.mesh;
    const std::int32_t own = labels[faces.front()];
    std::vector<std::int32_t> neighbors;
    for (const std::uint32_t f : faces) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::int32_t g = passage.across(f, k);
            if (g < 0) continue;
            const std::int32_t label = labels[static_cast<std::size_t>(g)];
            if (label >= 0 && label != own) neighbors.push_back(label);
        }
    }
    std::sort(neighbors.begin(), neighbors.end());
    neighbors.erase(std::unique(neighbors.begin(), neighbors.end()), neighbors.end());
    Neighbor best;
    for (const std::int32_t label : neighbors) {
        double sum = 0;
        for (const std::uint32_t f : faces) {
            sum += quadric::triangle_energy(fits[static_cast<std::size_t>(label)].proxy, mesh.corner(f, 0),
                                            mesh.corner(f, 1), mesh.corner(f, 2), mesh.normals[f], mesh.areas[f])
                       .hybrid(weight);
        }
        if (std::isnan(sum)) sum = std::numeric_limits<double>::max();
        if (best.label < 0 || sum < best.energy) best = {label, sum};
    }
    return best;
}

}  // namespace

std::size_t absorb_small(const Passage& passage, Labels& labels, std::size_t count,
                         std::span<const quadric::RegionFit> fits, const AbsorbOptions& options,
                         const runtime::RunControl& control) {
    const mesh::WorkMesh& mesh = *passage.mesh;
    const RegionFaces regions = region_faces(labels, count);
    std::vector<double> area(count, 0);
    for (std::size_t f = 0; f < labels.size(); ++f) {
        if (labels[f] >= 0) area[static_cast<std::size_t>(labels[f])] += mesh.areas[f];
    }
    const auto small = [&](std::size_t size, double a) {
        return size < options.smallest_region || a < options.smallest_area;
    };
    std::vector<std::uint32_t> order;
    std::vector<std::vector<std::uint32_t>> members(count);
    for (std::uint32_t r = 0; r < count; ++r) {
        if (regions.size(r) == 0 || !small(regions.size(r), area[r])) continue;
        order.push_back(r);
        members[r].assign(regions.face.begin() + regions.begin[r], regions.face.begin() + regions.begin[r + 1]);
    }
    // The smallest first: it is the least likely to be anybody's surface.
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return area[a] != area[b] ? area[a] < area[b] : a < b; });
    std::size_t polled = 0;
    for (const std::uint32_t r : order) {
        control.check_often(polled);
        // It may have grown by others that joined it.
        if (!small(members[r].size(), area[r])) continue;
        const Neighbor to = cheapest_neighbor(passage, labels, members[r], fits, options.weight);
        if (to.label < 0) continue;
        if (!(to.energy <= options.tolerance * area[r]) && !(area[r] < options.smallest_area)) continue;
        const auto t = static_cast<std::size_t>(to.label);
        for (const std::uint32_t f : members[r]) labels[f] = to.label;
        area[t] += area[r];
        if (!members[t].empty()) members[t].insert(members[t].end(), members[r].begin(), members[r].end());
        members[r].clear();
    }
    return close_gaps(labels);
}

}  // namespace quadseg::partition
