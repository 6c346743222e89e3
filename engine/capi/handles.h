// What is behind the opaque handles.
#pragma once

#include <quadseg/context.h>
#include <quadseg/mesh.h>
#include <quadseg/quadseg.h>
#include <quadseg/segmentation.h>
#include <quadseg/segmenter.h>

struct quadseg_context {
    quadseg::Context context;
};

struct quadseg_mesh {
    quadseg::Mesh mesh;
};

struct quadseg_segmentation {
    quadseg::Segmentation value;
};

struct quadseg_segmenter {
    quadseg::Segmenter value;
};

namespace quadseg::capi {

inline Context* context_of(quadseg_context* handle) noexcept {
    return handle ? &handle->context : nullptr;
}

/// Checks the caller's view and makes spans of it.
quadseg_status to_view(const quadseg_mesh_view* mesh, MeshView& view) noexcept;

/// Checks the caller's options, null for the defaults.
quadseg_status to_options(const quadseg_options* given, Options& options);

quadseg_mesh_report to_report(const MeshReport& report) noexcept;

}  // namespace quadseg::capi
