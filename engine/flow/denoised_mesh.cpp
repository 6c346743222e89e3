#include "flow/denoised_mesh.h"

#include "mesh/vertex_faces.h"
#include "runtime/parallel.h"

namespace quadseg::flow {
namespace {

constexpr int steps = 10;
constexpr std::size_t vertex_grain = 4096;
constexpr std::size_t face_grain = 8192;

/// Every vertex by the mean of what brings it onto the planes of its faces (through their centroids).
void move_vertices(mesh::WorkMesh& moved, const mesh::VertexFaces& incident, const runtime::RunControl& control) {
    std::vector<Vec3> next(moved.vertex_count());
    for (int step = 0; step < steps; ++step) {
        runtime::parallel_blocks(next.size(), vertex_grain, [&](std::size_t begin, std::size_t end) {
            control.check();
            for (std::size_t v = begin; v < end; ++v) {
                Vec3 sum;
                for (std::size_t i = incident.begin[v]; i < incident.begin[v + 1]; ++i) {
                    const std::size_t f = incident.face[i];
                    const Vec3& n = moved.normals[f];
                    sum += n * dot(n, moved.centroid(f) - moved.positions[v]);
                }
                const std::uint32_t count = incident.begin[v + 1] - incident.begin[v];
                next[v] = count > 0 ? moved.positions[v] + sum / static_cast<double>(count) : moved.positions[v];
            }
        });
        moved.positions.swap(next);
    }
}

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
    move_vertices(moved, mesh::vertex_faces(mesh, control), control);
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
