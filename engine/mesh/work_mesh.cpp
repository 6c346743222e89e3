#include "mesh/work_mesh.h"

#include <quadseg/error.h>

#include "mesh/build.h"
#include "runtime/parallel.h"

#include <utility>

namespace quadseg::mesh {

using build::block;

WorkMesh build_work_mesh(const MeshView& input, const runtime::RunControl& control) {
    WorkMesh mesh;
    build::measure_box(input, build::check_input(input, control), mesh, control);
    build::FaceOrder order = build::morton_order(input, mesh.frame, control);
    build::renumber(input, std::move(order.faces), order.first_corner, mesh, control);
    if (mesh.face_count() == 0) throw Error(ErrorCode::empty_mesh, "no face has three different vertices");
    mesh.report.degenerate_faces = input.face_count() - mesh.face_count() - order.duplicates.size();

    const build::EdgeCounts edges = build::match_edges(mesh, control);
    mesh.report.duplicate_faces = order.duplicates.size();
    mesh.report.border_edges = edges.border;
    mesh.report.non_manifold_edges = edges.non_manifold;

    build::measure_faces(mesh, control);
    if (!(mesh.total_area > 0)) throw Error(ErrorCode::empty_mesh, "no face has an area");
    mesh.report.non_manifold_vertices = build::count_non_manifold_vertices(mesh, control);
    if (edges.same_direction > 0) build::orient(mesh, control);
    if (edges.border > 0) build::stitch_borders(mesh, control);
    build::find_components(mesh, control);
    build::find_label_sources(input, order.duplicates, mesh, control);

    runtime::parallel_for(mesh.positions.size(), block,
                          [&](std::size_t v) { mesh.positions[v] = mesh.frame.to_unit(mesh.positions[v]); });
    return mesh;
}

std::size_t matching_edge(const WorkMesh& mesh, std::size_t f, std::size_t k) noexcept {
    const auto& back = mesh.neighbors[static_cast<std::size_t>(mesh.neighbors[f][k])];
    const auto& t = mesh.faces[static_cast<std::size_t>(mesh.neighbors[f][k])];
    const auto face = static_cast<std::int32_t>(f);
    const Vec3 a = mesh.corner(f, static_cast<int>(k)), b = mesh.corner(f, static_cast<int>((k + 1) % 3));
    std::size_t match = 0;
    for (std::size_t j = 0; j < 3; ++j) {
        if (back[j] != face) continue;
        match = j;
        if (mesh.positions[t[j]] == b && mesh.positions[t[(j + 1) % 3]] == a) return j;
    }
    return match;
}

std::vector<std::int32_t> labels_to_input(const WorkMesh& mesh, const std::vector<std::int32_t>& labels) {
    std::vector<std::int32_t> result(mesh.label_source.size());
    runtime::parallel_for(result.size(), block, [&](std::size_t i) {
        const std::int32_t f = mesh.label_source[i];
        result[i] = f == no_face ? -1 : labels[static_cast<std::size_t>(f)];
    });
    return result;
}

std::vector<std::int32_t> labels_from_input(const WorkMesh& mesh, std::span<const std::int32_t> labels) {
    std::vector<std::int32_t> result(mesh.face_count());
    runtime::parallel_for(result.size(), block, [&](std::size_t f) { result[f] = labels[mesh.input_face[f]]; });
    return result;
}

}  // namespace quadseg::mesh
