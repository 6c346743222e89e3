// Meshes of separate triangles (several vertices at one position) get the adjacency that their positions mean.
#include "mesh/build.h"
#include "runtime/parallel.h"

#include <algorithm>

namespace quadseg::mesh::build {

namespace {

bool less(const Vec3& a, const Vec3& b) noexcept {
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

struct BorderEdge {
    std::uint32_t low, high;  ///< position classes
    std::uint32_t id;         ///< 3 · face + edge
    bool forward;             ///< runs from low to high
};

}  // namespace

void stitch_borders(WorkMesh& mesh, const runtime::RunControl& control) {
    std::vector<BorderEdge> edges;
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        if (f % block == 0) control.check();
        for (std::size_t k = 0; k < 3; ++k) {
            if (mesh.neighbors[f][k] != no_face) continue;
            edges.push_back(
                {mesh.faces[f][k], mesh.faces[f][(k + 1) % 3], static_cast<std::uint32_t>(3 * f + k), true});
        }
    }
    if (edges.size() < 2) return;

    // Vertices at one position form a class, named by the first of them.
    std::vector<std::uint32_t> vertices;
    vertices.reserve(2 * edges.size());
    for (const BorderEdge& e : edges) {
        vertices.push_back(e.low);
        vertices.push_back(e.high);
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    control.check();
    std::vector<std::uint32_t> by_position = vertices;
    const auto at = [&](std::uint32_t v) { return without_negative_zero(mesh.positions[v]); };
    runtime::parallel_sort(by_position.begin(), by_position.end(), [&](std::uint32_t v, std::uint32_t w) {
        const Vec3 p = at(v), q = at(w);
        return p == q ? v < w : less(p, q);
    });
    control.check();
    std::vector<std::uint32_t> position_class(mesh.vertex_count());
    bool any_shared = false;
    for (std::size_t i = 0, first = 0; i < by_position.size(); ++i) {
        if (!(at(by_position[i]) == at(by_position[first]))) first = i;
        any_shared = any_shared || i != first;
        position_class[by_position[i]] = by_position[first];
    }
    if (!any_shared) return;

    for (BorderEdge& e : edges) {
        const std::uint32_t a = position_class[e.low], b = position_class[e.high];
        e.forward = a < b;
        e.low = std::min(a, b);
        e.high = std::max(a, b);
    }
    runtime::parallel_sort(edges.begin(), edges.end(), [](const BorderEdge& a, const BorderEdge& b) {
        return a.low != b.low ? a.low < b.low : a.high != b.high ? a.high < b.high : a.id < b.id;
    });
    control.check();
    const auto same_place = [](const BorderEdge& a, const BorderEdge& b) { return a.low == b.low && a.high == b.high; };
    for (std::size_t i = 0, j = 0; i < edges.size(); i = j) {
        while (j < edges.size() && same_place(edges[i], edges[j])) ++j;
        if (j - i != 2 || edges[i].low == edges[i].high) continue;
        const BorderEdge &a = edges[i], &b = edges[i + 1];
        if (a.forward == b.forward || a.id / 3 == b.id / 3) continue;
        mesh.neighbors[a.id / 3][a.id % 3] = static_cast<std::int32_t>(b.id / 3);
        mesh.neighbors[b.id / 3][b.id % 3] = static_cast<std::int32_t>(a.id / 3);
        ++mesh.report.stitched_edges;
    }
}

}  // namespace quadseg::mesh::build
