#include "partition/regions.h"

#include "mesh/connected.h"
#include "runtime/parallel.h"

#include <algorithm>
#include <limits>

namespace quadseg::partition {
namespace {

/// One more than the largest label; 0: none.
std::size_t used_numbers(const Labels& labels) {
    std::int64_t largest = -1;
    for (const std::int32_t label : labels) largest = std::max<std::int64_t>(largest, label);
    return static_cast<std::size_t>(largest + 1);
}

}  // namespace

RegionFaces region_faces(const Labels& labels, std::size_t count) {
    RegionFaces regions;
    regions.begin.assign(count + 1, 0);
    for (const std::int32_t label : labels) {
        if (label >= 0) ++regions.begin[static_cast<std::size_t>(label)];
    }
    const std::uint32_t total = runtime::exclusive_scan(regions.begin);
    regions.face.resize(total);
    std::vector<std::uint32_t> next(regions.begin.begin(), regions.begin.end() - 1);
    for (std::size_t f = 0; f < labels.size(); ++f) {
        if (labels[f] >= 0) regions.face[next[static_cast<std::size_t>(labels[f])]++] = static_cast<std::uint32_t>(f);
    }
    return regions;
}

std::size_t compact(Labels& labels) {
    std::vector<std::int32_t> renumbered;
    return compact(labels, renumbered);
}

std::size_t compact(Labels& labels, std::vector<std::int32_t>& renumbered) {
    renumbered.assign(used_numbers(labels), -1);
    std::int32_t count = 0;
    for (std::int32_t& label : labels) {
        if (label < 0) continue;
        std::int32_t& r = renumbered[static_cast<std::size_t>(label)];
        if (r < 0) r = count++;
        label = r;
    }
    return static_cast<std::size_t>(count);
}

std::size_t close_gaps(Labels& labels) {
    std::vector<std::int32_t> renumbered;
    return close_gaps(labels, renumbered);
}

std::size_t close_gaps(Labels& labels, std::vector<std::int32_t>& renumbered) {
    renumbered.assign(used_numbers(labels), -1);
    for (const std::int32_t label : labels) {
        if (label >= 0) renumbered[static_cast<std::size_t>(label)] = 0;
    }
    std::int32_t count = 0;
    for (std::int32_t& r : renumbered) {
        if (r == 0) r = count++;
    }
    for (std::int32_t& label : labels) {
        if (label >= 0) label = renumbered[static_cast<std::size_t>(label)];
    }
    return static_cast<std::size_t>(count);
}

std::size_t split_disconnected(const mesh::WorkMesh& mesh, Labels& labels) {
    return mesh::connected_faces(
        mesh, [&](std::size_t f) { return labels[f] >= 0; },
        [&](std::size_t f, std::size_t, std::size_t g) { return labels[f] == labels[g]; }, [] {}, labels);
}

namespace {

void copy_faces(const mesh::WorkMesh& mesh, const std::uint32_t* faces, std::size_t count, std::size_t begin,
                GatheredRegion& out) {
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t f = faces[i];
        const auto& v = mesh.faces[f];
        for (std::size_t k = 0; k < 3; ++k) out.corners[3 * (begin + i) + k] = mesh.positions[v[k]];
        out.normals[begin + i] = mesh.normals[f];
        out.areas[begin + i] = mesh.areas[f];
    }
}

}  // namespace

void gather(const mesh::WorkMesh& mesh, const std::uint32_t* faces, std::size_t count, GatheredRegion& out,
            const runtime::RunControl* control) {
    constexpr std::size_t step = 65536;
    if (control != nullptr && count > step) {
        out.clear();
        out.reserve(count);
        for (std::size_t begin = 0; begin < count; begin += step) {
            control->check();
            append(mesh, faces + begin, std::min(step, count - begin), out);
        }
        return;
    }
    out.corners.resize(3 * count);
    out.normals.resize(count);
    out.areas.resize(count);
    copy_faces(mesh, faces, count, 0, out);
}

void append(const mesh::WorkMesh& mesh, const std::uint32_t* faces, std::size_t count, GatheredRegion& out) {
    const std::size_t begin = out.areas.size();
    out.corners.resize(3 * (begin + count));
    out.normals.resize(begin + count);
    out.areas.resize(begin + count);
    copy_faces(mesh, faces, count, begin, out);
}

std::vector<quadric::RegionFit> fit_regions(const mesh::WorkMesh& mesh, const RegionFaces& regions,
                                            const quadric::RegionFitOptions& options,
                                            const runtime::RunControl& control) {
    std::vector<quadric::RegionFit> fits(regions.count());
    quadric::RegionFitOptions polled = options;
    polled.poll = [&control] { control.check(); };
    const auto fit = [&](std::size_t r, GatheredRegion& scratch) {
        control.check();
        gather(mesh, regions.face.data() + regions.begin[r], regions.size(r), scratch, &control);
        fits[r] = quadric::fit_region(scratch.soup(), polled);
    };
    // Runs of small regions share a task; a large one has a task of its own, so that no task waits behind it.
    constexpr std::size_t task_faces = 4096;
    std::vector<std::size_t> task_begin;
    std::size_t filled = task_faces;
    for (std::size_t r = 0; r < regions.count(); ++r) {
        if (filled >= task_faces || regions.size(r) >= task_faces) {
            task_begin.push_back(r);
            filled = 0;
        }
        filled += regions.size(r) + 16;
    }
    task_begin.push_back(regions.count());
    // Large first: the last task to start should be a short one.
    std::vector<std::size_t> order(task_begin.size() - 1);
    for (std::size_t t = 0; t < order.size(); ++t) order[t] = t;
    const auto faces_of = [&](std::size_t t) {
        return regions.begin[task_begin[t + 1]] - regions.begin[task_begin[t]];
    };
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return faces_of(a) != faces_of(b) ? faces_of(a) > faces_of(b) : a < b;
    });
    runtime::parallel_for(order.size(), 1, [&](std::size_t i) {
        GatheredRegion scratch;
        const std::size_t t = order[i];
        for (std::size_t r = task_begin[t]; r < task_begin[t + 1]; ++r) fit(r, scratch);
    });
    return fits;
}

}  // namespace quadseg::partition
