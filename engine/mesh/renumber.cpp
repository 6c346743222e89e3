#include "mesh/build.h"
#include "runtime/parallel.h"

#include <limits>
#include <utility>

namespace quadseg::mesh::build {

void renumber(const MeshView& input, std::vector<std::uint32_t> order, const std::vector<std::uint8_t>& first_corner,
              WorkMesh& mesh, const runtime::RunControl& control) {
    constexpr std::uint32_t unseen = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> work_vertex(input.vertex_count(), unseen);
    mesh.input_face = std::move(order);
    mesh.faces.resize(mesh.input_face.size());
    mesh.input_vertex.clear();
    mesh.input_vertex.reserve(std::min(input.vertex_count(), mesh.faces.size()));
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        if (f % block == 0) control.check();
        const std::uint32_t* t = &input.triangles[3 * std::size_t{mesh.input_face[f]}];
        std::size_t corner = first_corner[f];
        for (std::size_t k = 0; k < 3; ++k, corner = corner < 2 ? corner + 1 : 0) {
            std::uint32_t& w = work_vertex[t[corner]];
            if (w == unseen) {
                w = static_cast<std::uint32_t>(mesh.input_vertex.size());
                mesh.input_vertex.push_back(t[corner]);
            }
            mesh.faces[f][k] = w;
        }
    }
    mesh.positions.resize(mesh.input_vertex.size());
    runtime::parallel_blocks(mesh.positions.size(), block, [&](std::size_t begin, std::size_t end) {
        control.check();
        for (std::size_t v = begin; v < end; ++v) {
            const double* p = &input.positions[3 * std::size_t{mesh.input_vertex[v]}];
            mesh.positions[v] = {p[0], p[1], p[2]};
        }
    });
}

}  // namespace quadseg::mesh::build
