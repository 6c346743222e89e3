#include "flow/denoised_mesh.h"

#include "flow/vertex_moves.h"
#include "mesh/vertex_faces.h"
#include "runtime/parallel.h"

namespace quadseg::flow {
namespace {

constexpr int steps = 10;
constexpr std::size_t face_grain = 8192;

}  // namespace

mesh::WorkMesh denoised_mesh(const mesh::WorkMesh& mesh, const std::vector<Vec3>& normals,
                             const runtime::RunControl& control) {
    mesh::WorkMesh moved;
    moved.positions = mesh.positions;
    moved.faces = mesh.faces;
    moved.neighbors = mesh.neighbors;
    moved.normals = normals;
    moved.areas = mesh.areas;
    moved.frame = mesh.frame;
    const mesh::VertexFaces incident = mesh::vertex_faces(mesh, control);
    for (int step = 0; step < steps; ++step) move_to_planes(moved, incident, 1, control);
    runtime::parallel_blocks(moved.face_count(), face_grain, [&](std::size_t begin, std::size_t end) {
        control.check();
        for (std::size_t f = begin; f < end; ++f) {
            const Vec3 a = moved.corner(f, 0);
            moved.areas[f] = norm(cross(moved.corner(f, 1) - a, moved.corner(f, 2) - a)) / 2;
            // A face that shrank to nothing has no normal either, as in any mesh.
            if (!(moved.areas[f] > 0)) moved.normals[f] = {};
        }
    });
    return moved;
}

}  // namespace quadseg::flow
