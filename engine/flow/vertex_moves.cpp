#include "flow/vertex_moves.h"

#include "runtime/parallel.h"

#include <vector>

namespace quadseg::flow {
namespace {

constexpr std::size_t vertex_grain = 4096;

/// `way(v)` is called for vertices that have faces.
template <class Way>
void move_vertices(mesh::WorkMesh& mesh, const mesh::VertexFaces& incident, double share,
                   const runtime::RunControl& control, const Way& way) {
    std::vector<Vec3> next(mesh.vertex_count());
    runtime::parallel_blocks(next.size(), vertex_grain, [&](std::size_t begin, std::size_t end) {
        control.check();
        for (std::size_t v = begin; v < end; ++v) {
            const bool used = incident.begin[v] < incident.begin[v + 1];
            next[v] = used ? mesh.positions[v] + way(v) * share : mesh.positions[v];
        }
    });
    mesh.positions.swap(next);
}

}  // namespace

void move_to_planes(mesh::WorkMesh& mesh, const mesh::VertexFaces& incident, double share,
                    const runtime::RunControl& control) {
    move_vertices(mesh, incident, share, control, [&](std::size_t v) {
        Vec3 sum;
        for (std::size_t i = incident.begin[v]; i < incident.begin[v + 1]; ++i) {
            const std::size_t f = incident.face[i];
            const Vec3& n = mesh.normals[f];
            sum += n * dot(n, mesh.centroid(f) - mesh.positions[v]);
        }
        return sum / static_cast<double>(incident.begin[v + 1] - incident.begin[v]);
    });
}

void move_to_ring(mesh::WorkMesh& mesh, const mesh::VertexFaces& incident, double share,
                  const runtime::RunControl& control) {
    move_vertices(mesh, incident, share, control, [&](std::size_t v) {
        // Inside a surface every neighbour is met in two faces, the vertex counts for as much as one of them.
        Vec3 sum = mesh.positions[v] * 2;
        double count = 2;
        for (std::size_t i = incident.begin[v]; i < incident.begin[v + 1]; ++i) {
            for (const std::uint32_t w : mesh.faces[incident.face[i]]) {
                if (w == v) continue;
                sum += mesh.positions[w];
                ++count;
            }
        }
        return sum / count - mesh.positions[v];
    });
}

}  // namespace quadseg::flow
