#include "flow/simplified_mesh.h"

#include <vector>

namespace quadseg::flow {

mesh::WorkMesh build_simplified_mesh(const mesh::WorkMesh& fine, std::span<const Vec3> positions,
                                     std::span<const std::array<std::uint32_t, 3>> faces,
                                     const runtime::RunControl& control) {
    std::vector<double> coordinates;
    coordinates.reserve(3 * positions.size());
    for (const Vec3& p : positions) coordinates.insert(coordinates.end(), {p.x, p.y, p.z});
    std::vector<std::uint32_t> triangles;
    triangles.reserve(3 * faces.size());
    for (const auto& f : faces) triangles.insert(triangles.end(), f.begin(), f.end());
    mesh::WorkMesh mesh = mesh::build_work_mesh({coordinates, triangles}, control);
    // Its own unit frame is that of its own box: lengths are brought back to the frame of the fine mesh, positions to
    // the last bit, since their rounding tells how precise they are.
    const double area_scale = 1 / (mesh.frame.scale * mesh.frame.scale);
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) mesh.positions[v] = positions[mesh.input_vertex[v]];
    for (double& area : mesh.areas) area *= area_scale;
    mesh.total_area *= area_scale;
    mesh.frame = fine.frame;
    return mesh;
}

}  // namespace quadseg::flow
