#include "flow/region_sample.h"

#include <algorithm>

namespace quadseg::flow {

namespace {

struct Corner {
    std::uint32_t vertex, face;
    std::uint8_t k;
};

/// Fans of more faces than this are cut short; only the normal's weights suffer.
constexpr int longest_fan = 64;

Vec3 weighted_normal(const mesh::WorkMesh& mesh, std::size_t f, std::size_t k) {
    const auto& v = mesh.faces[f];
    const Vec3 p = mesh.positions[v[k]];
    return mesh.normals[f] * angle_between(mesh.positions[v[(k + 1) % 3]] - p, mesh.positions[v[(k + 2) % 3]] - p);
}

/// Sum over the faces of the label that follow one another around corner k of face `start`, both ways.
Vec3 fan_normal(const mesh::WorkMesh& mesh, const partition::Labels& labels, std::uint32_t start, std::size_t corner) {
    const std::int32_t label = labels[start];
    Vec3 sum = weighted_normal(mesh, start, corner);
    int steps = 0;
    for (const bool forward : {true, false}) {
        std::size_t f = start, k = corner;
        for (; steps < longest_fan; ++steps) {
            const std::size_t edge = forward ? k : (k + 2) % 3;
            const std::int32_t g = mesh.neighbors[f][edge];
            if (g < 0 || labels[static_cast<std::size_t>(g)] != label) break;
            const std::size_t j = mesh::matching_edge(mesh, f, edge);
            f = static_cast<std::size_t>(g);
            k = forward ? (j + 1) % 3 : j;
            if (f == start) return normalized(sum);  // all the way round
            sum += weighted_normal(mesh, f, k);
        }
    }
    return normalized(sum);
}

}  // namespace

RegionSample RegionSample::thinned(std::size_t limit) const {
    if (points.size() <= limit) return *this;
    RegionSample result;
    result.points.reserve(limit);
    result.normals.reserve(limit);
    for (std::size_t i = 0; i < limit; ++i) {
        const std::size_t j = i * points.size() / limit;
        result.points.push_back(points[j]);
        result.normals.push_back(normals[j]);
    }
    return result;
}

RegionSample sample_region(const mesh::WorkMesh& mesh, const partition::Labels& labels, const std::uint32_t* faces,
                           std::size_t count, std::size_t limit) {
    RegionSample sample;
    std::vector<Corner> corners;
    // About half as many vertices as faces: all corners of small regions, one corner of every so manyth face of others.
    sample.complete = count <= 2 * limit;
    if (sample.complete) {
        corners.reserve(3 * count);
        for (std::size_t i = 0; i < count; ++i) {
            for (std::uint8_t k = 0; k < 3; ++k) corners.push_back({mesh.faces[faces[i]][k], faces[i], k});
        }
    } else {
        corners.reserve(limit);
        for (std::size_t i = 0; i < limit; ++i) {
            const std::uint32_t f = faces[i * count / limit];
            const auto k = static_cast<std::uint8_t>(i % 3);
            corners.push_back({mesh.faces[f][k], f, k});
        }
    }
    std::sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) {
        return a.vertex != b.vertex ? a.vertex < b.vertex : a.face < b.face;
    });
    corners.erase(std::unique(corners.begin(), corners.end(),
                              [](const Corner& a, const Corner& b) { return a.vertex == b.vertex; }),
                  corners.end());
    sample.points.reserve(corners.size());
    sample.normals.reserve(corners.size());
    for (const Corner& c : corners) {
        const Vec3 normal = fan_normal(mesh, labels, c.face, c.k);
        if (!(squared_norm(normal) > 0)) continue;  // slivers without area tell nothing
        sample.points.push_back(mesh.positions[c.vertex]);
        sample.normals.push_back(normal);
    }
    return sample;
}

}  // namespace quadseg::flow
