#include "partition/border_measure.h"

#include "runtime/parallel.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace quadseg::partition {

namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// Edges between two labels, once each, by the face of smaller index.
std::vector<Edge> border_edges(const mesh::WorkMesh& mesh, const Labels& labels) {
    std::vector<Edge> edges;
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::int32_t g = mesh.neighbors[f][k];
            if (g < 0 || static_cast<std::size_t>(g) < f || labels[static_cast<std::size_t>(g)] == labels[f]) continue;
            edges.emplace_back(mesh.faces[f][k], mesh.faces[f][(k + 1) % 3]);
        }
    }
    return edges;
}

}  // namespace

BorderMeasure measure_borders(const mesh::WorkMesh& mesh, const Labels& labels) {
    BorderMeasure measure;
    const std::vector<Edge> edges = border_edges(mesh, labels);
    std::vector<Edge> ends;  // (vertex, other end)
    ends.reserve(2 * edges.size());
    for (const auto& [a, b] : edges) {
        measure.length += norm(mesh.positions[a] - mesh.positions[b]);
        ends.emplace_back(a, b);
        ends.emplace_back(b, a);
    }
    if (mesh.frame.diagonal > 0) measure.length /= mesh.frame.diagonal;
    runtime::parallel_sort(ends.begin(), ends.end(), std::less<>());
    double turned = 0;
    std::size_t vertices = 0;
    for (std::size_t begin = 0, end = 0; begin < ends.size(); begin = end) {
        while (end < ends.size() && ends[end].first == ends[begin].first) ++end;
        if (end - begin != 2) continue;
        const Vec3 p = mesh.positions[ends[begin].first];
        const Vec3 in = p - mesh.positions[ends[begin].second], out = mesh.positions[ends[begin + 1].second] - p;
        if (!(squared_norm(in) > 0) || !(squared_norm(out) > 0)) continue;
        turned += angle_between(in, out);
        ++vertices;
    }
    constexpr double degrees = 57.29577951308232;
    if (vertices > 0) measure.zigzag = degrees * turned / static_cast<double>(vertices);
    return measure;
}

}  // namespace quadseg::partition
