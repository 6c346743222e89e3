#include <quadseg/segmentation.h>

#include "capi/guard.h"
#include "capi/handles.h"
#include "capi/versioned.h"

#include <algorithm>
#include <memory>

namespace quadseg::capi {
namespace {

quadseg_region to_region(const Region& r) noexcept {
    const Surface& s = r.surface;
    quadseg_region region{};
    region.id = r.id;
    region.type = static_cast<std::int32_t>(s.type);
    region.surface_id = r.surface_id;
    region.valid = r.valid;
    region.outward = s.outward;
    region.faces = r.faces;
    region.area = r.area;
    region.rms = r.rms;
    region.max = r.max;
    region.energy = r.energy;
    std::copy(s.coefficients.begin(), s.coefficients.end(), region.coefficients);
    std::copy(s.point.begin(), s.point.end(), region.point);
    std::copy(s.axis.begin(), s.axis.end(), region.axis);
    region.radius = s.radius;
    region.minor_radius = s.minor_radius;
    region.half_angle = s.half_angle;
    std::copy(s.axes.begin(), s.axes.end(), region.axes);
    std::copy(s.semi_axes.begin(), s.semi_axes.end(), region.semi_axes);
    return region;
}

/// Is there room for `needed` elements in what the caller gives?
quadseg_status check_buffer(const char* name, const void* buffer, std::size_t capacity, std::size_t needed) noexcept {
    if (capacity < needed) {
        return fail(QUADSEG_BUFFER_TOO_SMALL, "%s: needs room for %zu, but has %zu", name, needed, capacity);
    }
    return buffer || needed == 0 ? QUADSEG_OK : null_pointer(name);
}

template <class Vector, class Number>
quadseg_status copy_array(const char* name, const Vector& from, Number* to, std::size_t capacity) noexcept {
    if (const auto status = check_buffer(name, to, capacity, from.size())) return status;
    std::copy(from.begin(), from.end(), to);
    return QUADSEG_OK;
}

}  // namespace
}  // namespace quadseg::capi

using namespace quadseg;
using capi::check_buffer, capi::copy_array, capi::fail, capi::guarded, capi::null_pointer;

extern "C" {

quadseg_status quadseg_segment(const quadseg_mesh_view* mesh, const quadseg_options* options, quadseg_context* context,
                               quadseg_segmentation** segmentation) {
    if (!segmentation) return null_pointer("segmentation");
    *segmentation = nullptr;
    MeshView view;
    if (const auto status = capi::to_view(mesh, view)) return status;
    return guarded([&]() -> quadseg_status {
        Options chosen;
        if (const auto status = capi::to_options(options, chosen)) return status;
        auto handle = std::make_unique<quadseg_segmentation>();
        handle->value = segment(view, chosen, capi::context_of(context));
        *segmentation = handle.release();
        return QUADSEG_OK;
    });
}

void quadseg_segmentation_destroy(quadseg_segmentation* segmentation) {
    delete segmentation;
}

quadseg_status quadseg_segmentation_summary(const quadseg_segmentation* segmentation, quadseg_summary* summary) {
    if (!segmentation) return null_pointer("segmentation");
    if (!summary) return null_pointer("summary");
    const Segmentation& s = segmentation->value;
    quadseg_summary c{};
    c.stop = static_cast<std::int32_t>(s.stop);
    c.partial = s.partial;
    c.threads = s.threads;
    c.labels = s.labels.size();
    c.regions = s.regions.size();
    c.unlabelled = s.unlabelled.size();
    c.merges = s.history.size();
    c.energies = s.energies.size();
    c.regularities = s.regularities.size();
    c.projected = s.projected.size();
    c.energy_total = s.energy.total;
    c.energy_distance = s.energy.distance;
    c.energy_normal = s.energy.normal;
    c.rms = s.rms;
    c.max = s.max;
    c.noise = s.noise;
    c.seconds_prepare = s.seconds.prepare;
    c.seconds_coarse = s.seconds.coarse;
    c.seconds_fine = s.seconds.fine;
    c.seconds_post = s.seconds.post;
    c.seconds_total = s.seconds.total;
    c.peak_bytes = s.peak_bytes;
    return capi::copy_out("quadseg_summary", c, summary);
}

quadseg_status quadseg_segmentation_report(const quadseg_segmentation* segmentation, quadseg_mesh_report* report) {
    if (!segmentation) return null_pointer("segmentation");
    if (!report) return null_pointer("report");
    return capi::copy_out("quadseg_mesh_report", capi::to_report(segmentation->value.input), report);
}

quadseg_status quadseg_segmentation_labels(const quadseg_segmentation* segmentation, int32_t* labels, size_t capacity) {
    if (!segmentation) return null_pointer("segmentation");
    return copy_array("labels", segmentation->value.labels, labels, capacity);
}

quadseg_status quadseg_segmentation_unlabelled(const quadseg_segmentation* segmentation, uint32_t* faces,
                                               size_t capacity) {
    if (!segmentation) return null_pointer("segmentation");
    return copy_array("faces", segmentation->value.unlabelled, faces, capacity);
}

quadseg_status quadseg_segmentation_regions(const quadseg_segmentation* segmentation, quadseg_region* regions,
                                            size_t region_size, size_t capacity) {
    if (!segmentation) return null_pointer("segmentation");
    if (region_size < capi::first_size<quadseg_region>) {
        return capi::wrong_size<quadseg_region>("quadseg_region", region_size);
    }
    const auto& ours = segmentation->value.regions;
    if (const auto status = check_buffer("regions", regions, capacity, ours.size())) return status;
    auto* bytes = reinterpret_cast<unsigned char*>(regions);
    for (std::size_t i = 0; i < ours.size(); ++i) {
        capi::write_bytes(capi::to_region(ours[i]), bytes + i * region_size, region_size);
    }
    return QUADSEG_OK;
}

quadseg_status quadseg_segmentation_merges(const quadseg_segmentation* segmentation, quadseg_merge* merges,
                                           size_t capacity) {
    if (!segmentation) return null_pointer("segmentation");
    const auto& history = segmentation->value.history;
    if (const auto status = check_buffer("merges", merges, capacity, history.size())) return status;
    std::transform(history.begin(), history.end(), merges, [](const MergeStep& step) {
        return quadseg_merge{step.regions, step.energy};
    });
    return QUADSEG_OK;
}

quadseg_status quadseg_segmentation_energies(const quadseg_segmentation* segmentation, double* energies,
                                             size_t capacity) {
    if (!segmentation) return null_pointer("segmentation");
    return copy_array("energies", segmentation->value.energies, energies, capacity);
}

quadseg_status quadseg_segmentation_projected(const quadseg_segmentation* segmentation, double* positions,
                                              size_t capacity) {
    if (!segmentation) return null_pointer("segmentation");
    return copy_array("positions", segmentation->value.projected, positions, capacity);
}

quadseg_status quadseg_segmentation_regularity(const quadseg_segmentation* segmentation, size_t index,
                                               quadseg_regularity* regularity, int32_t* regions, size_t capacity) {
    if (!segmentation) return null_pointer("segmentation");
    if (!regularity) return null_pointer("regularity");
    const auto& all = segmentation->value.regularities;
    if (index >= all.size()) {
        return fail(QUADSEG_INVALID_ARGUMENT, "index: must be below %zu, but is %zu", all.size(), index);
    }
    const Regularity& ours = all[index];
    if (regions) {
        if (const auto status = check_buffer("regions", regions, capacity, ours.regions.size())) return status;
    }
    quadseg_regularity c{};
    c.kind = static_cast<std::int32_t>(ours.kind);
    c.snapped = ours.snapped;
    c.regions = ours.regions.size();
    if (const auto status = capi::copy_out("quadseg_regularity", c, regularity)) return status;
    if (regions) std::copy(ours.regions.begin(), ours.regions.end(), regions);
    return QUADSEG_OK;
}

}  // extern "C"
