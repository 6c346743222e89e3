#include <quadseg/io.h>

#include "capi/guard.h"
#include "capi/handles.h"
#include "capi/versioned.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>

namespace quadseg::capi {
namespace {

/// An array as the caller states it: present unless empty, aligned, and of a size that memory can hold.
template <class Number>
quadseg_status check_array(const char* name, const Number* data, std::uint64_t groups) noexcept {
    if (groups > std::numeric_limits<std::size_t>::max() / (3 * sizeof(Number))) {
        return fail(QUADSEG_INVALID_ARGUMENT, "%s: %llu of them can't be in memory", name,
                    static_cast<unsigned long long>(groups));
    }
    if (!data && groups > 0) return null_pointer(name);
    if (reinterpret_cast<std::uintptr_t>(data) % alignof(Number) != 0) {
        return fail(QUADSEG_INVALID_ARGUMENT, "%s: must be aligned to %zu bytes", name, alignof(Number));
    }
    return QUADSEG_OK;
}

}  // namespace

quadseg_status to_view(const quadseg_mesh_view* mesh, MeshView& view) noexcept {
    if (!mesh) return null_pointer("mesh");
    quadseg_mesh_view v{};
    if (const auto status = copy_in("quadseg_mesh_view", *mesh, v)) return status;
    if (const auto status = check_array("positions", v.positions, v.vertex_count)) return status;
    if (const auto status = check_array("triangles", v.triangles, v.face_count)) return status;
    if (v.polygons) {
        if (const auto status = check_array("polygons", v.polygons, v.face_count)) return status;
    }
    view.positions = {v.positions, static_cast<std::size_t>(3 * v.vertex_count)};
    view.triangles = {v.triangles, static_cast<std::size_t>(3 * v.face_count)};
    view.polygons = {v.polygons, v.polygons ? static_cast<std::size_t>(v.face_count) : 0};
    return QUADSEG_OK;
}

quadseg_mesh_report to_report(const MeshReport& r) noexcept {
    quadseg_mesh_report report{};
    report.faces = r.faces;
    report.vertices = r.vertices;
    report.components = r.components;
    report.border_edges = r.border_edges;
    report.non_manifold_edges = r.non_manifold_edges;
    report.non_manifold_vertices = r.non_manifold_vertices;
    report.isolated_vertices = r.isolated_vertices;
    report.degenerate_faces = r.degenerate_faces;
    report.duplicate_faces = r.duplicate_faces;
    report.flipped_faces = r.flipped_faces;
    report.unorientable_edges = r.unorientable_edges;
    report.stitched_edges = r.stitched_edges;
    report.feature_edges = r.feature_edges;
    report.diagonal = r.diagonal;
    report.area = r.area;
    report.offset = r.offset;
    std::copy(r.box_min.begin(), r.box_min.end(), report.box_min);
    std::copy(r.box_max.begin(), r.box_max.end(), report.box_max);
    return report;
}

}  // namespace quadseg::capi

using namespace quadseg;
using capi::guarded, capi::null_pointer;

extern "C" {

quadseg_status quadseg_mesh_read(const char* path, quadseg_context* context, quadseg_mesh** mesh) {
    if (!mesh) return null_pointer("mesh");
    *mesh = nullptr;
    if (!path) return null_pointer("path");
    return guarded([&] {
        auto handle = std::make_unique<quadseg_mesh>();
        handle->mesh = read_mesh(path, capi::context_of(context));
        *mesh = handle.release();
        return QUADSEG_OK;
    });
}

void quadseg_mesh_destroy(quadseg_mesh* mesh) {
    delete mesh;
}

quadseg_status quadseg_mesh_get_view(const quadseg_mesh* mesh, quadseg_mesh_view* view) {
    if (!mesh) return null_pointer("mesh");
    if (!view) return null_pointer("view");
    quadseg_mesh_view v{};
    v.positions = mesh->mesh.positions.data();
    v.vertex_count = mesh->mesh.positions.size() / 3;
    v.triangles = mesh->mesh.triangles.data();
    v.face_count = mesh->mesh.triangles.size() / 3;
    v.polygons = mesh->mesh.polygons.empty() ? nullptr : mesh->mesh.polygons.data();
    return capi::copy_out("quadseg_mesh_view", v, view);
}

quadseg_status quadseg_inspect(const quadseg_mesh_view* mesh, double feature_degrees, quadseg_context* context,
                               quadseg_mesh_report* report) {
    if (!report) return null_pointer("report");
    MeshView view;
    if (const auto status = capi::to_view(mesh, view)) return status;
    return guarded([&] {
        const MeshReport found = inspect(view, feature_degrees, capi::context_of(context));
        return capi::copy_out("quadseg_mesh_report", capi::to_report(found), report);
    });
}

quadseg_status quadseg_write_mesh(const char* path, const quadseg_mesh_view* mesh) {
    if (!path) return null_pointer("path");
    MeshView view;
    if (const auto status = capi::to_view(mesh, view)) return status;
    return guarded([&] {
        write_mesh(path, view);
        return QUADSEG_OK;
    });
}

quadseg_status quadseg_write_ply(const char* path, const quadseg_mesh_view* mesh, const int32_t* labels,
                                 const uint8_t* rgb) {
    if (!path) return null_pointer("path");
    MeshView view;
    if (const auto status = capi::to_view(mesh, view)) return status;
    return guarded([&] {
        FaceColors colors;
        if (labels) colors.labels = {labels, view.face_count()};
        if (rgb) colors.rgb = {rgb, 3 * view.face_count()};
        write_ply(path, view, colors);
        return QUADSEG_OK;
    });
}

quadseg_status quadseg_write_labels(const char* path, const quadseg_mesh_view* mesh, const int32_t* labels) {
    if (!path) return null_pointer("path");
    MeshView view;
    if (const auto status = capi::to_view(mesh, view)) return status;
    if (!labels && view.face_count() > 0) return null_pointer("labels");
    return guarded([&] {
        write_labels(path, {labels, view.face_count()}, view.polygons);
        return QUADSEG_OK;
    });
}

}  // extern "C"
