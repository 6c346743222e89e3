#include "exact/found_so_far.h"

#include "partition/leaves.h"

#include <algorithm>
#include <numeric>

namespace quadseg::exact {

namespace {

std::vector<std::int32_t> largest_first(std::size_t faces, const std::vector<Candidate>& candidates) {
    std::vector<std::uint32_t> order(candidates.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return candidates[a].area > candidates[b].area; });
    std::vector<std::int32_t> owner(faces, -1);
    for (const std::uint32_t c : order) {
        for (const std::uint32_t f : candidates[c].faces) {
            if (owner[f] < 0) owner[f] = static_cast<std::int32_t>(c);
        }
    }
    return owner;
}

}  // namespace

ExactSurfaces found_so_far(const mesh::WorkMesh& mesh, const std::vector<Candidate>& candidates,
                           std::vector<std::int32_t> owner) {
    if (owner.empty()) owner = largest_first(mesh.face_count(), candidates);
    ExactSurfaces result;
    result.partial = true;
    result.labels = owner;
    const auto free = static_cast<std::int32_t>(candidates.size());
    std::replace(result.labels.begin(), result.labels.end(), -1, free);
    const std::size_t count = partition::connected_parts({&mesh, nullptr, {}}, result.labels);
    Surface freeform;
    freeform.type = SurfaceType::freeform;
    result.surfaces.assign(count, freeform);
    std::size_t named = 0;  // labels are numbered by their first faces
    double covered = 0;
    for (std::size_t f = 0; f < owner.size(); ++f) {
        const auto label = static_cast<std::size_t>(result.labels[f]);
        if (label == named) {
            if (owner[f] >= 0) result.surfaces[label] = candidates[static_cast<std::size_t>(owner[f])].surface;
            ++named;
        }
        if (owner[f] >= 0) covered += mesh.areas[f];
    }
    result.covered = mesh.total_area > 0 ? covered / mesh.total_area : 0;
    return result;
}

}  // namespace quadseg::exact
