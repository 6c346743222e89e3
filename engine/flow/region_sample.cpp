#include "flow/region_sample.h"

#include <algorithm>
#include <limits>
#include <utility>

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

/// Which of `size` things, evenly spread, is number i of `limit`.
std::size_t thinned_index(std::size_t i, std::size_t size, std::size_t limit) {
    return i * size / limit;
}

/// By ascending vertex, of each the corner that stands first (its face is the smallest).
void keep_first_of_each_vertex(std::vector<Corner>& corners) {
    if (corners.empty()) return;
    const auto [low, high] = std::minmax_element(corners.begin(), corners.end(),
                                                 [](const Corner& a, const Corner& b) { return a.vertex < b.vertex; });
    const std::uint32_t first_vertex = low->vertex;
    const std::size_t range = std::size_t{high->vertex} - first_vertex + 1;
    std::vector<Corner> kept;
    if (range <= 16 * corners.size()) {
        // Vertices are numbered by first use along the faces: those of a region lie close together.
        constexpr auto none = std::numeric_limits<std::uint32_t>::max();
        std::vector<std::uint32_t> first(range, none);
        std::size_t count = 0;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            std::uint32_t& place = first[corners[i].vertex - first_vertex];
            if (place != none) continue;
            place = static_cast<std::uint32_t>(i);
            ++count;
        }
        kept.reserve(count);
        for (const std::uint32_t i : first) {
            if (i != none) kept.push_back(corners[i]);
        }
        corners = std::move(kept);
        return;
    }
    std::stable_sort(corners.begin(), corners.end(),
                     [](const Corner& a, const Corner& b) { return a.vertex < b.vertex; });
    corners.erase(std::unique(corners.begin(), corners.end(),
                              [](const Corner& a, const Corner& b) { return a.vertex == b.vertex; }),
                  corners.end());
}

}  // namespace

RegionSample RegionSample::thinned(std::size_t limit) const {
    if (points.size() <= limit) return *this;
    RegionSample result;
    result.points.reserve(limit);
    result.normals.reserve(limit);
    for (std::size_t i = 0; i < limit; ++i) {
        const std::size_t j = thinned_index(i, points.size(), limit);
        result.points.push_back(points[j]);
        result.normals.push_back(normals[j]);
    }
    return result;
}

RegionSample sample_region(const mesh::WorkMesh& mesh, const partition::Labels& labels, const std::uint32_t* faces,
                           std::size_t count, std::size_t limit, std::size_t smooth_normals,
                           const std::vector<std::uint8_t>& left_out) {
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
    if (!left_out.empty()) std::erase_if(corners, [&](const Corner& c) { return left_out[c.vertex] != 0; });
    keep_first_of_each_vertex(corners);
    sample.points.reserve(corners.size());
    sample.normals.reserve(corners.size());
    const bool all_smooth = corners.size() <= smooth_normals;
    std::size_t kept = 0;
    for (const Corner& c : corners) {
        Vec3 normal = all_smooth ? Vec3{} : mesh.normals[c.face];
        if (!(squared_norm(normal) > 0)) normal = fan_normal(mesh, labels, c.face, c.k);
        if (!(squared_norm(normal) > 0)) continue;  // slivers without area tell nothing
        sample.points.push_back(mesh.positions[c.vertex]);
        sample.normals.push_back(normal);
        corners[kept++] = c;
    }
    if (all_smooth) return sample;
    for (std::size_t i = 0; i < std::min(smooth_normals, kept); ++i) {
        const std::size_t j = thinned_index(i, kept, std::min(smooth_normals, kept));
        const Vec3 normal = fan_normal(mesh, labels, corners[j].face, corners[j].k);
        if (squared_norm(normal) > 0) sample.normals[j] = normal;
    }
    return sample;
}

}  // namespace quadseg::flow
