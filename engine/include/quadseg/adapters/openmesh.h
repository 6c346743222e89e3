// For those who hold an OpenMesh mesh. Header-only: include it where OpenMesh is included already.
#pragma once

#include <quadseg/mesh.h>
#include <quadseg/segmentation.h>

#include <OpenMesh/Core/Mesh/Handles.hh>
#include <OpenMesh/Core/Utils/Property.hh>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace quadseg::adapters {

/// The mesh as flat arrays; faces and vertices in the order of their handles. Polygons are cut into fans. Deleted
/// elements must have been collected (garbage_collection()).
template <class OpenMeshType>
Mesh to_mesh(const OpenMeshType& mesh) {
    Mesh result;
    result.positions.reserve(3 * mesh.n_vertices());
    for (std::size_t v = 0; v < mesh.n_vertices(); ++v) {
        const auto& p = mesh.point(OpenMesh::VertexHandle(static_cast<int>(v)));
        for (std::size_t a = 0; a < 3; ++a) result.positions.push_back(static_cast<double>(p[a]));
    }
    bool polygons = false;
    std::vector<std::uint32_t> polygon_of;
    for (std::size_t f = 0; f < mesh.n_faces(); ++f) {
        std::vector<std::uint32_t> corners;
        for (const auto v : mesh.fv_range(OpenMesh::FaceHandle(static_cast<int>(f)))) {
            corners.push_back(static_cast<std::uint32_t>(v.idx()));
        }
        polygons = polygons || corners.size() > 3;
        for (std::size_t k = 2; k < corners.size(); ++k) {
            result.triangles.insert(result.triangles.end(), {corners[0], corners[k - 1], corners[k]});
            polygon_of.push_back(static_cast<std::uint32_t>(f));
        }
    }
    result.file_faces = mesh.n_faces();
    if (polygons) result.polygons = std::move(polygon_of);
    return result;
}

/// Segments the mesh; the label of every face goes into `labels`, a face property that the mesh has already.
template <class OpenMeshType>
Segmentation segment(OpenMeshType& mesh, const OpenMesh::FPropHandleT<int>& labels, const Options& options = {},
                     Context* context = nullptr) {
    const Mesh arrays = to_mesh(mesh);
    Segmentation result = quadseg::segment(arrays.view(), options, context);
    for (std::size_t t = 0; t < result.labels.size(); ++t) {
        const std::size_t f = arrays.polygons.empty() ? t : arrays.polygons[t];
        mesh.property(labels, OpenMesh::FaceHandle(static_cast<int>(f))) = result.labels[t];
    }
    return result;
}

}  // namespace quadseg::adapters
