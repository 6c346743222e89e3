// OpenMesh's decimater (quadric module) behind the signature of ours: what ours is compared with, in tests and benches.
#pragma once

#include "simplify/decimate.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace quadseg::simplify {

struct OpenMeshTraits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
    using Normal = OpenMesh::Vec3d;
};
using OpenMeshMesh = OpenMesh::TriMesh_ArrayKernelT<OpenMeshTraits>;

/// OpenMesh refuses non-manifold faces: they are missing. It has no face map: face_map stays empty.
inline Decimated decimate_openmesh(std::span<const Vec3> positions, std::span<const std::array<std::uint32_t, 3>> faces,
                                   std::size_t target_faces) {
    OpenMeshMesh mesh;
    std::vector<OpenMeshMesh::VertexHandle> handles;
    handles.reserve(positions.size());
    for (const Vec3& p : positions) handles.push_back(mesh.add_vertex({p.x, p.y, p.z}));
    // What add_face says about the faces that it refuses goes to a log of its own.
    omerr().disable();
    for (const auto& f : faces) mesh.add_face(handles[f[0]], handles[f[1]], handles[f[2]]);
    omerr().enable();
    OpenMesh::Decimater::DecimaterT<OpenMeshMesh> decimater(mesh);
    OpenMesh::Decimater::ModQuadricT<OpenMeshMesh>::Handle quadric;
    decimater.add(quadric);
    decimater.module(quadric).unset_max_err();
    decimater.initialize();
    decimater.decimate_to_faces(0, target_faces);
    mesh.garbage_collection();

    Decimated result;
    for (const auto v : mesh.vertices()) {
        const auto& p = mesh.point(v);
        result.positions.push_back({p[0], p[1], p[2]});
    }
    for (const auto f : mesh.faces()) {
        std::array<std::uint32_t, 3> corners{};
        std::size_t k = 0;
        for (const auto v : mesh.fv_range(f)) {
            if (k < 3) corners[k++] = static_cast<std::uint32_t>(v.idx());
        }
        result.faces.push_back(corners);
    }
    return result;
}

}  // namespace quadseg::simplify
