#include "bench/support/score.h"

#include "mesh/work_mesh.h"
#include "partition/regions.h"
#include "quadric/monomials.h"
#include "runtime/run_control.h"
#include "surface/quadric_projector.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <stdexcept>

namespace quadseg::bench {
namespace {

/// ∫d² with a third of the area at each corner.
double squared_distance(const mesh::WorkMesh& mesh, const partition::RegionFaces& regions, std::size_t region,
                        const quadric::Proxy& proxy) {
    const surface::QuadricProjector projector(proxy.c);
    double sum = 0;
    for (std::uint32_t k = regions.begin[region]; k < regions.begin[region + 1]; ++k) {
        const std::size_t face = regions.face[k];
        for (int c = 0; c < 3; ++c) {
            const Vec3 p = mesh.corner(face, c) - proxy.origin;
            const Vec3 d = p - projector.foot_point(p);
            sum += mesh.areas[face] / 3 * dot(d, d);
        }
    }
    return sum;
}

}  // namespace

Score score(const MeshView& view, std::span<const std::int32_t> labels) {
    if (labels.size() != view.face_count()) {
        throw std::invalid_argument(std::to_string(labels.size()) + " labels for " + std::to_string(view.face_count()) +
                                    " faces");
    }
    const runtime::RunControl control(nullptr);
    const mesh::WorkMesh mesh = mesh::build_work_mesh(view, control);

    // Unlabelled faces become one more region, which is counted but not fitted.
    partition::Labels work = mesh::labels_from_input(mesh, labels);
    const std::int32_t largest = work.empty() ? -1 : *std::max_element(work.begin(), work.end());
    const std::int32_t nobody = largest + 1;
    bool complete = true;
    for (std::int32_t& label : work) {
        if (label >= 0) continue;
        label = nobody;
        complete = false;
    }
    std::size_t count = partition::compact(work);
    std::int32_t unlabelled = -1;
    const std::vector<std::int32_t> again = mesh::labels_from_input(mesh, labels);
    for (std::size_t f = 0; !complete && f < work.size() && unlabelled < 0; ++f) {
        if (again[f] < 0) unlabelled = work[f];
    }

    Score result;
    result.regions = count - (complete ? 0 : 1);
    const partition::RegionFaces regions = partition::region_faces(work, count);
    const std::vector<quadric::RegionFit> fits = partition::fit_regions(mesh, regions, {}, control);
    double labelled_area = 0, squared = 0;
    for (std::size_t r = 0; r < count; ++r) {
        if (static_cast<std::int32_t>(r) == unlabelled) continue;
        for (std::uint32_t k = regions.begin[r]; k < regions.begin[r + 1]; ++k) {
            labelled_area += mesh.areas[regions.face[k]];
        }
        result.energy += fits[r].total;
        squared += squared_distance(mesh, regions, r, fits[r].proxy);
    }
    partition::Labels parts = work;
    partition::split_disconnected(mesh, parts);
    std::vector<bool> counted;
    for (std::size_t f = 0; f < parts.size(); ++f) {
        const auto part = static_cast<std::size_t>(parts[f]);
        if (work[f] == unlabelled) continue;
        if (part >= counted.size()) counted.resize(part + 1, false);
        if (counted[part]) continue;
        counted[part] = true;
        ++result.pieces;
    }
    if (mesh.total_area > 0) result.unlabelled_area = 1 - labelled_area / mesh.total_area;
    if (complete) result.unlabelled_area = 0;
    if (labelled_area > 0) {
        result.energy_density = result.energy / labelled_area;
        result.rms = std::sqrt(squared / labelled_area) / mesh.frame.diagonal;
    }
    return result;
}

std::vector<std::int32_t> blind_partition(const MeshView& view, std::size_t regions) {
    const mesh::WorkMesh mesh = mesh::build_work_mesh(view, runtime::RunControl(nullptr));
    const std::size_t faces = mesh.face_count();
    partition::Labels labels(faces, -1);
    std::deque<std::uint32_t> queue;
    std::int32_t next = 0;
    const auto open = [&](std::size_t face) {
        labels[face] = next++;
        queue.push_back(static_cast<std::uint32_t>(face));
    };
    const auto grow = [&] {
        while (!queue.empty()) {
            const std::uint32_t face = queue.front();
            queue.pop_front();
            for (const std::int32_t neighbor : mesh.neighbors[face]) {
                if (neighbor < 0 || labels[static_cast<std::size_t>(neighbor)] >= 0) continue;
                labels[static_cast<std::size_t>(neighbor)] = labels[face];
                queue.push_back(static_cast<std::uint32_t>(neighbor));
            }
        }
    };
    regions = std::min(regions, faces);
    for (std::size_t r = 0; r < regions; ++r) open(r * faces / regions);
    grow();
    for (std::size_t f = 0; f < faces; ++f) {  // components without a seed
        if (labels[f] >= 0) continue;
        open(f);
        grow();
    }
    return mesh::labels_to_input(mesh, labels);
}

}  // namespace quadseg::bench
