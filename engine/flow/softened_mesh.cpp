#include "flow/softened_mesh.h"

#include "flow/filtered_normals.h"
#include "flow/vertex_moves.h"
#include "mesh/vertex_faces.h"
#include "runtime/parallel.h"

#include <algorithm>

namespace quadseg::flow {
namespace {

constexpr std::size_t face_grain = 8192;
/// Below these (σ/h) creases suffer more from a step than the noise does.
constexpr double planes_from = 0.1, ring_from = 0.25;
constexpr double planes_slope = 10, ring_slope = 3;
constexpr double largest_ring_share = 0.5;

}  // namespace

std::vector<Vec3> softening_normals(const mesh::WorkMesh& mesh, const NoiseEstimate& noise,
                                    const runtime::RunControl& control) {
    return noise.strong() ? filtered_normals(mesh, 2, 4, control) : filtered_normals(mesh, 1, 3, control);
}

mesh::WorkMesh softened_mesh(const mesh::WorkMesh& mesh, const std::vector<Vec3>& normals, const NoiseEstimate& noise,
                             const runtime::RunControl& control) {
    const double ratio = noise.sigma / noise.edge;
    mesh::WorkMesh moved;
    moved.positions = mesh.positions;
    moved.faces = mesh.faces;
    moved.neighbors = mesh.neighbors;
    moved.normals = mesh.normals;
    moved.areas = mesh.areas;
    moved.frame = mesh.frame;
    const double to_planes = std::clamp(planes_slope * (ratio - planes_from), 0.0, 1.0);
    const double to_ring = std::clamp(ring_slope * (ratio - ring_from), 0.0, largest_ring_share);
    if (!(to_planes > 0)) return moved;
    const mesh::VertexFaces incident = mesh::vertex_faces(mesh, control);
    moved.normals = normals;
    move_to_planes(moved, incident, to_planes, control);
    if (to_ring > 0) move_to_ring(moved, incident, to_ring, control);
    runtime::parallel_blocks(moved.face_count(), face_grain, [&](std::size_t begin, std::size_t end) {
        control.check();
        for (std::size_t f = begin; f < end; ++f) {
            const Vec3 a = moved.corner(f, 0);
            const Vec3 twice = cross(moved.corner(f, 1) - a, moved.corner(f, 2) - a);
            moved.areas[f] = norm(twice) / 2;
            moved.normals[f] = moved.areas[f] > 0 ? normalized(twice) : Vec3{};
        }
    });
    return moved;
}

}  // namespace quadseg::flow
