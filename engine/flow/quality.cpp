#include "flow/quality.h"

#include "runtime/parallel.h"
#include "surface/surface.h"

#include <algorithm>
#include <cmath>

namespace quadseg::flow {

namespace {

struct Block {
    std::uint32_t region, begin, end;
};

bool has_closed_form(SurfaceType type) {
    return type == SurfaceType::plane || type == SurfaceType::sphere || type == SurfaceType::cylinder ||
           type == SurfaceType::cone || type == SurfaceType::torus;
}

RegionQuality measure_block(const mesh::WorkMesh& mesh, const std::uint32_t* faces, std::size_t count,
                            const Surface& s) {
    // Corners meet several times; general quadrics, whose foot points are dear, are evaluated once a vertex.
    RegionQuality q;
    if (has_closed_form(s.type)) {
        for (std::size_t i = 0; i < count; ++i) {
            double sum = 0;
            for (int k = 0; k < 3; ++k) {
                const double d = std::abs(surface::signed_distance(s, mesh.corner(faces[i], k)));
                sum += d * d;
                q.max_distance = std::max(q.max_distance, d);
            }
            q.area += mesh.areas[faces[i]];
            q.squared_distance += sum * mesh.areas[faces[i]] / 3;
        }
        return q;
    }
    std::vector<std::pair<std::uint32_t, double>> weights;
    weights.reserve(3 * count);
    for (std::size_t i = 0; i < count; ++i) {
        q.area += mesh.areas[faces[i]];
        for (const std::uint32_t v : mesh.faces[faces[i]]) weights.emplace_back(v, mesh.areas[faces[i]] / 3);
    }
    std::stable_sort(weights.begin(), weights.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    const surface::QuadricProjector projector(s.coefficients);
    for (std::size_t i = 0; i < weights.size();) {
        const Vec3 p = mesh.positions[weights[i].first];
        const double d = norm(p - projector.foot_point(p));
        double weight = 0;
        for (const std::uint32_t v = weights[i].first; i < weights.size() && weights[i].first == v; ++i) {
            weight += weights[i].second;
        }
        q.squared_distance += weight * d * d;
        q.max_distance = std::max(q.max_distance, d);
    }
    return q;
}

}  // namespace

std::vector<RegionQuality> measure_quality(const mesh::WorkMesh& mesh, const partition::RegionFaces& regions,
                                           const std::vector<Surface>& surfaces) {
    constexpr std::size_t block_faces = 8192;
    std::vector<Block> blocks;
    for (std::size_t r = 0; r < regions.count(); ++r) {
        for (std::size_t b = regions.begin[r]; b < regions.begin[r + 1]; b += block_faces) {
            blocks.push_back(
                {static_cast<std::uint32_t>(r), static_cast<std::uint32_t>(b),
                 static_cast<std::uint32_t>(std::min<std::size_t>(b + block_faces, regions.begin[r + 1]))});
        }
    }
    std::vector<RegionQuality> parts(blocks.size());
    runtime::parallel_for(blocks.size(), 1, [&](std::size_t i) {
        const Block& block = blocks[i];
        parts[i] =
            measure_block(mesh, regions.face.data() + block.begin, block.end - block.begin, surfaces[block.region]);
    });
    std::vector<RegionQuality> quality(regions.count());
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        RegionQuality& q = quality[blocks[i].region];
        q.area += parts[i].area;
        q.squared_distance += parts[i].squared_distance;
        q.max_distance = std::max(q.max_distance, parts[i].max_distance);
    }
    return quality;
}

}  // namespace quadseg::flow
