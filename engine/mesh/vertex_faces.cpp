#include "mesh/vertex_faces.h"

#include "runtime/parallel.h"

namespace quadseg::mesh {

VertexFaces vertex_faces(const WorkMesh& mesh) {
    return vertex_faces(mesh, runtime::RunControl(nullptr));
}

VertexFaces vertex_faces(const WorkMesh& mesh, const runtime::RunControl& control) {
    VertexFaces result;
    result.begin.assign(mesh.vertex_count() + 1, 0);
    std::size_t polls = 0;
    for (const auto& t : mesh.faces) {
        control.check_often(polls);
        for (const std::uint32_t v : t) ++result.begin[v];
    }
    runtime::exclusive_scan(result.begin);
    result.face.resize(3 * mesh.face_count());
    // Filled from the back, the ends become the begins.
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) result.begin[v] = result.begin[v + 1];
    for (std::size_t f = mesh.face_count(); f-- > 0;) {
        control.check_often(polls);
        for (const std::uint32_t v : mesh.faces[f]) result.face[--result.begin[v]] = static_cast<std::uint32_t>(f);
    }
    return result;
}

}  // namespace quadseg::mesh
