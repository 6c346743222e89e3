#include "mesh/build.h"
#include "runtime/parallel.h"

#include <algorithm>

namespace quadseg::mesh::build {

namespace {

/// First work face of the polygon of every input face (no_face: none of its triangles is a work face); empty when every
/// polygon is a triangle.
std::vector<std::int32_t> polygon_faces(const MeshView& input, const WorkMesh& mesh) {
    const auto continues = [&](std::size_t f) { return input.polygons[f] == input.polygons[f - 1]; };
    bool any = false;
    for (std::size_t f = 1; f < input.polygons.size() && !any; ++f) any = continues(f);
    if (!any) return {};
    std::vector<std::int32_t> first(input.polygons.size());
    for (std::size_t begin = 0, end = 1; begin < first.size(); begin = end++) {
        while (end < first.size() && continues(end)) ++end;
        std::int32_t least = no_face;
        for (std::size_t f = begin; f < end; ++f) {
            const std::int32_t w = mesh.label_source[f];
            if (w != no_face && (least == no_face || w < least)) least = w;
        }
        std::fill(first.begin() + static_cast<std::ptrdiff_t>(begin), first.begin() + static_cast<std::ptrdiff_t>(end),
                  least);
    }
    return first;
}

/// Faces with a repeated index: a work face across their one real edge, else one at any of their vertices.
void label_collapsed(const MeshView& input, const std::vector<std::uint32_t>& collapsed, WorkMesh& mesh,
                     const runtime::RunControl& control) {
    // (input vertex, index in collapsed), for a look-up by vertex
    std::vector<std::pair<std::uint32_t, std::uint32_t>> at_vertex;
    std::vector<std::uint8_t> touched(input.vertex_count(), 0);
    for (std::size_t i = 0; i < collapsed.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t v = input.triangles[3 * std::size_t{collapsed[i]} + k];
            at_vertex.emplace_back(v, static_cast<std::uint32_t>(i));
            touched[v] = 1;
        }
    }
    std::sort(at_vertex.begin(), at_vertex.end());
    at_vertex.erase(std::unique(at_vertex.begin(), at_vertex.end()), at_vertex.end());

    std::vector<std::int32_t> across(collapsed.size(), no_face), beside(collapsed.size(), no_face);
    std::size_t counter = 0;
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        control.check_often(counter);
        const std::uint32_t* t = &input.triangles[3 * std::size_t{mesh.input_face[f]}];
        for (std::size_t k = 0; k < 3; ++k) {
            if (!touched[t[k]]) continue;
            for (auto it = std::lower_bound(at_vertex.begin(), at_vertex.end(), std::pair{t[k], std::uint32_t{0}});
                 it != at_vertex.end() && it->first == t[k]; ++it) {
                const std::uint32_t i = it->second;
                if (beside[i] == no_face) beside[i] = static_cast<std::int32_t>(f);
                if (across[i] != no_face) continue;
                const std::uint32_t* d = &input.triangles[3 * std::size_t{collapsed[i]}];
                const std::uint32_t other = d[0] != t[k] ? d[0] : d[1] != t[k] ? d[1] : d[2];
                if (other != t[k] && (other == t[0] || other == t[1] || other == t[2])) {
                    across[i] = static_cast<std::int32_t>(f);
                }
            }
        }
    }
    for (std::size_t i = 0; i < collapsed.size(); ++i) {
        mesh.label_source[collapsed[i]] = across[i] != no_face ? across[i] : beside[i];
    }
}

}  // namespace

void find_label_sources(const MeshView& input, const Duplicates& duplicates, WorkMesh& mesh,
                        const runtime::RunControl& control) {
    mesh.label_source.assign(input.face_count(), no_face);
    runtime::parallel_blocks(mesh.face_count(), block, [&](std::size_t begin, std::size_t end) {
        control.check();
        for (std::size_t f = begin; f < end; ++f) mesh.label_source[mesh.input_face[f]] = static_cast<std::int32_t>(f);
    });
    for (const auto& [face, first] : duplicates) mesh.label_source[face] = mesh.label_source[first];

    if (mesh.face_count() + duplicates.size() < input.face_count()) {
        std::vector<std::uint32_t> collapsed;
        for (std::size_t f = 0; f < input.face_count(); ++f) {
            if (f % block == 0) control.check();
            if (has_repeated_index(&input.triangles[3 * f])) collapsed.push_back(static_cast<std::uint32_t>(f));
        }
        const std::vector<std::int32_t> own_polygon = polygon_faces(input, mesh);
        label_collapsed(input, collapsed, mesh, control);
        if (!own_polygon.empty()) {
            for (const std::uint32_t f : collapsed) {
                if (own_polygon[f] != no_face) mesh.label_source[f] = own_polygon[f];
            }
        }
    }
    const std::vector<std::int32_t> first = polygon_faces(input, mesh);
    mesh.polygon.clear();
    if (first.empty()) return;
    mesh.polygon.resize(mesh.face_count());
    for (std::size_t f = 0; f < mesh.face_count(); ++f) mesh.polygon[f] = first[mesh.input_face[f]];
}

}  // namespace quadseg::mesh::build
