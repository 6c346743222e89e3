#include <quadseg/segmenter.h>

#include "capi/guard.h"
#include "capi/handles.h"

#include <algorithm>
#include <cstddef>
#include <memory>

using namespace quadseg;
using capi::fail, capi::guarded, capi::null_pointer;

namespace {

/// Runs work(the segmenter), which throws what is wrong.
template <class Handle, class Work>
quadseg_status with(Handle* segmenter, const Work& work) noexcept {
    if (!segmenter) return null_pointer("segmenter");
    return guarded([&] {
        work(segmenter->value);
        return QUADSEG_OK;
    });
}

template <class Value>
void give(Value* to, Value value) noexcept {
    if (to) *to = value;
}

}  // namespace

extern "C" {

quadseg_status quadseg_segmenter_create(const quadseg_mesh_view* mesh, const quadseg_options* options,
                                        quadseg_context* context, quadseg_segmenter** segmenter) {
    if (!segmenter) return null_pointer("segmenter");
    *segmenter = nullptr;
    MeshView view;
    if (const auto status = capi::to_view(mesh, view)) return status;
    return guarded([&]() -> quadseg_status {
        Options chosen;
        if (const auto status = capi::to_options(options, chosen)) return status;
        *segmenter = new quadseg_segmenter{Segmenter(view, chosen, capi::context_of(context))};
        return QUADSEG_OK;
    });
}

void quadseg_segmenter_destroy(quadseg_segmenter* segmenter) {
    delete segmenter;
}

quadseg_status quadseg_segmenter_set_context(quadseg_segmenter* segmenter, quadseg_context* context) {
    return with(segmenter, [&](Segmenter& s) { s.set_context(capi::context_of(context)); });
}

quadseg_status quadseg_segmenter_set_options(quadseg_segmenter* segmenter, const quadseg_options* options) {
    if (!segmenter) return null_pointer("segmenter");
    return guarded([&]() -> quadseg_status {
        Options chosen;
        if (const auto status = capi::to_options(options, chosen)) return status;
        segmenter->value.set_options(chosen);
        return QUADSEG_OK;
    });
}

quadseg_status quadseg_segmenter_run(quadseg_segmenter* segmenter, int32_t* stop) {
    return with(segmenter, [&](Segmenter& s) { give(stop, static_cast<std::int32_t>(s.run())); });
}

quadseg_status quadseg_segmenter_set_labels(quadseg_segmenter* segmenter, const int32_t* labels, size_t count) {
    if (!labels && count > 0) return null_pointer("labels");
    return with(segmenter, [&](Segmenter& s) { s.set_labels({labels, count}); });
}

quadseg_status quadseg_segmenter_insert(quadseg_segmenter* segmenter, int64_t face, int32_t* label) {
    if (face < QUADSEG_WORST_FACE) {
        return fail(QUADSEG_INVALID_ARGUMENT, "face: must be an index or QUADSEG_WORST_FACE, but is %lld",
                    static_cast<long long>(face));
    }
    return with(segmenter, [&](Segmenter& s) {
        give(label, face == QUADSEG_WORST_FACE ? s.insert() : s.insert(static_cast<std::size_t>(face)));
    });
}

quadseg_status quadseg_segmenter_merge(quadseg_segmenter* segmenter, int32_t a, int32_t b) {
    return with(segmenter, [&](Segmenter& s) { s.merge(a, b); });
}

quadseg_status quadseg_segmenter_merge_candidate(const quadseg_segmenter* segmenter, int32_t a, int32_t b,
                                                 double* increase, int32_t* valid) {
    return with(segmenter, [&](const Segmenter& s) {
        const Segmenter::MergeCandidate candidate = s.merge_candidate(a, b);
        give(increase, candidate.increase);
        give(valid, std::int32_t{candidate.valid});
    });
}

quadseg_status quadseg_segmenter_relax(quadseg_segmenter* segmenter, int32_t iterations, double* energy) {
    if (iterations < 0) return fail(QUADSEG_INVALID_ARGUMENT, "iterations: must be 0 or more, but is %d", iterations);
    return with(segmenter, [&](Segmenter& s) { give(energy, s.relax(iterations)); });
}

quadseg_status quadseg_segmenter_smooth(quadseg_segmenter* segmenter) {
    return with(segmenter, [](Segmenter& s) { s.smooth(); });
}

quadseg_status quadseg_segmenter_undo(quadseg_segmenter* segmenter, int32_t* undone) {
    return with(segmenter, [&](Segmenter& s) { give(undone, std::int32_t{s.undo()}); });
}

size_t quadseg_segmenter_regions(const quadseg_segmenter* segmenter) {
    return segmenter ? segmenter->value.region_count() : 0;
}

quadseg_status quadseg_segmenter_labels(const quadseg_segmenter* segmenter, int32_t* labels, size_t capacity) {
    if (!segmenter) return null_pointer("segmenter");
    const auto ours = segmenter->value.labels();
    if (capacity < ours.size()) {
        return fail(QUADSEG_BUFFER_TOO_SMALL, "labels: needs room for %zu, but has %zu", ours.size(), capacity);
    }
    if (!labels) return null_pointer("labels");
    std::copy(ours.begin(), ours.end(), labels);
    return QUADSEG_OK;
}

quadseg_status quadseg_segmenter_result(const quadseg_segmenter* segmenter, quadseg_segmentation** segmentation) {
    if (!segmentation) return null_pointer("segmentation");
    *segmentation = nullptr;
    return with(segmenter, [&](const Segmenter& s) {
        auto handle = std::make_unique<quadseg_segmentation>();
        handle->value = s.result();
        *segmentation = handle.release();
    });
}

}  // extern "C"
