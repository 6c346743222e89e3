#include "flow/quality.h"

#include "partition/face_metric.h"
#include "runtime/parallel.h"
#include "surface/evaluate.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace quadseg::flow {

namespace {

struct Block {
    std::uint32_t region, begin, end;
};

using Faces = std::pair<const std::uint32_t*, const std::uint32_t*>;

/// Closed forms: cheaper to evaluate at every corner than to find the corners that meet.
template <class Evaluator>
void add_distances(const mesh::WorkMesh& mesh, const Faces& faces, const Evaluator& evaluator, RegionQuality& q) {
    for (const std::uint32_t* f = faces.first; f != faces.second; ++f) {
        double sum = 0;
        for (int k = 0; k < 3; ++k) {
            const double d = std::abs(evaluator.distance(mesh.corner(*f, k)));
            sum += d * d;
            q.max_distance = std::max(q.max_distance, d);
        }
        q.squared_distance += sum * mesh.areas[*f] / 3;
    }
}

/// visit(vertex, weight) once a vertex of the faces; the weight is a third of the areas of its faces.
template <class Visit>
void for_weighted_vertices(const mesh::WorkMesh& mesh, const Faces& faces, const Visit& visit) {
    const auto count = static_cast<std::size_t>(faces.second - faces.first);
    std::uint32_t low = std::numeric_limits<std::uint32_t>::max(), high = 0;
    for (const std::uint32_t* f = faces.first; f != faces.second; ++f) {
        for (const std::uint32_t v : mesh.faces[*f]) {
            low = std::min(low, v);
            high = std::max(high, v);
        }
    }
    if (count > 0 && high - low <= 16 * count) {
        // Numbered by first use along the faces, they lie close together.
        std::vector<double> weight(high - low + 1, -1);
        for (const std::uint32_t* f = faces.first; f != faces.second; ++f) {
            for (const std::uint32_t v : mesh.faces[*f]) {
                weight[v - low] = std::max(weight[v - low], 0.0) + mesh.areas[*f] / 3;
            }
        }
        for (std::uint32_t v = low; v <= high; ++v) {
            if (weight[v - low] >= 0) visit(v, weight[v - low]);
        }
        return;
    }
    // Open addressing; visited in the order in which the faces name them.
    constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
    const std::size_t mask = std::bit_ceil(4 * count) - 1;
    std::vector<std::uint32_t> slot_of(mask + 1, none);
    std::vector<std::pair<std::uint32_t, double>> weights;
    weights.reserve(2 * count);
    for (const std::uint32_t* f = faces.first; f != faces.second; ++f) {
        for (const std::uint32_t v : mesh.faces[*f]) {
            std::size_t i = (v * std::size_t{0x9e3779b97f4a7c15} >> 32U) & mask;
            while (slot_of[i] != none && weights[slot_of[i]].first != v) i = (i + 1) & mask;
            if (slot_of[i] == none) {
                slot_of[i] = static_cast<std::uint32_t>(weights.size());
                weights.emplace_back(v, 0.0);
            }
            weights[slot_of[i]].second += mesh.areas[*f] / 3;
        }
    }
    for (const auto& [v, weight] : weights) visit(v, weight);
}

/// General quadrics, whose foot points are dear, are evaluated once a vertex.
void add_distances(const mesh::WorkMesh& mesh, const Faces& faces, const surface::QuadricEvaluator& evaluator,
                   RegionQuality& q) {
    for_weighted_vertices(mesh, faces, [&](std::uint32_t v, double weight) {
        const double d = std::abs(evaluator.distance(mesh.positions[v]));
        q.squared_distance += weight * d * d;
        q.max_distance = std::max(q.max_distance, d);
    });
}

/// Planes need no polynomials: ∫f² = |t|/12 (Σf_i² + (Σf_i)²), and the normals differ by a constant.
void add_plane_energy(const mesh::WorkMesh& mesh, const Faces& faces, const quadric::Proxy& proxy,
                      quadric::TriangleEnergy& energy) {
    const Vec3 n{proxy.c[1], proxy.c[2], proxy.c[3]};
    const double length = norm(n), inverse = length > 0 ? 1 / length : 0;
    const Vec3 unit = n * inverse;
    const double offset = proxy.c[0] * inverse - dot(unit, proxy.origin);
    for (const std::uint32_t* f = faces.first; f != faces.second; ++f) {
        const double area = mesh.areas[*f];
        if (!(area > 0)) continue;
        double sum = 0, squares = 0;
        for (int k = 0; k < 3; ++k) {
            const double value = dot(unit, mesh.corner(*f, k)) + offset;
            sum += value;
            squares += value * value;
        }
        energy.distance += area / 12 * (squares + sum * sum);
        energy.normal += area * squared_norm(unit - mesh.normals[*f]);
    }
}

void add_energy(const mesh::WorkMesh& mesh, const Faces& faces, const quadric::Proxy& proxy,
                quadric::TriangleEnergy& energy) {
    if (proxy.planar()) {
        add_plane_energy(mesh, faces, proxy, energy);
        return;
    }
    for (const std::uint32_t* f = faces.first; f != faces.second; ++f) {
        if (!(mesh.areas[*f] > 0)) continue;
        const quadric::TriangleEnergy e = partition::face_energy(mesh, *f, proxy, true);
        energy.distance += e.distance;
        energy.normal += e.normal;
    }
}

void add_gradient(const mesh::WorkMesh& mesh, const Faces& faces, const quadric::Proxy& proxy, RegionQuality& q) {
    const bool planar = proxy.planar();
    const Vec3 constant{proxy.c[1], proxy.c[2], proxy.c[3]};
    const double length = norm(constant);
    for (const std::uint32_t* f = faces.first; f != faces.second; ++f) {
        const double area = mesh.areas[*f];
        q.area += area;
        if (!(area > 0)) continue;
        const Vec3 g = planar ? constant : quadric::gradient(proxy.c, mesh.centroid(*f) - proxy.origin);
        q.gradient += area * (planar ? length : norm(g));
        if (!(dot(g, mesh.normals[*f]) > 0)) q.against += area;
    }
}

/// Faces that the figures of a stopped call are estimated from, all regions together, at least one a block.
constexpr std::size_t block_faces = 4096, sampled_faces = 4096, least_share = 64;

std::vector<Block> cut_into_blocks(const partition::RegionFaces& regions) {
    std::vector<Block> blocks;
    for (std::size_t r = 0; r < regions.count(); ++r) {
        for (std::size_t b = regions.begin[r]; b < regions.begin[r + 1]; b += block_faces) {
            blocks.push_back(
                {static_cast<std::uint32_t>(r), static_cast<std::uint32_t>(b),
                 static_cast<std::uint32_t>(std::min<std::size_t>(b + block_faces, regions.begin[r + 1]))});
        }
    }
    return blocks;
}

RegionQuality measure_faces(const mesh::WorkMesh& mesh, const Faces& faces, const FinalSurface& final) {
    RegionQuality q;
    surface::SurfaceEvaluator(final.surface).visit([&](const auto& evaluator) {
        add_distances(mesh, faces, evaluator, q);
    });
    add_gradient(mesh, faces, final.quadric, q);
    if (!final.loop_energy) add_energy(mesh, faces, final.loop_proxy.value_or(final.quadric), q.energy);
    return q;
}

/// One face in `share` stands for all of them.
RegionQuality estimate_faces(const mesh::WorkMesh& mesh, const Faces& faces, const FinalSurface& final,
                             std::size_t share) {
    const auto count = static_cast<std::size_t>(faces.second - faces.first);
    std::vector<std::uint32_t> chosen;
    Faces few{faces.first, faces.first + std::min<std::size_t>(count, 1)};
    if (count > share) {
        for (std::size_t i = 0; i < count; i += share) chosen.push_back(faces.first[i]);
        few = {chosen.data(), chosen.data() + chosen.size()};
    }
    RegionQuality q = measure_faces(mesh, few, final);
    double area = 0;
    for (const std::uint32_t* f = faces.first; f != faces.second; ++f) area += mesh.areas[*f];
    const double factor = q.area > 0 ? area / q.area : 0;
    q.area = area;
    q.squared_distance *= factor;
    q.energy.distance *= factor;
    q.energy.normal *= factor;
    q.gradient *= factor;
    q.against *= factor;
    return q;
}

}  // namespace

std::vector<double> region_areas(const mesh::WorkMesh& mesh, const partition::RegionFaces& regions) {
    std::vector<double> areas(regions.count(), 0);
    for (const Block& block : cut_into_blocks(regions)) {
        double area = 0;  // in the order of measure_quality()
        for (std::size_t i = block.begin; i < block.end; ++i) area += mesh.areas[regions.face[i]];
        areas[block.region] += area;
    }
    return areas;
}

std::vector<RegionQuality> measure_quality(const mesh::WorkMesh& mesh, const partition::RegionFaces& regions,
                                           const std::vector<FinalSurface>& surfaces,
                                           const runtime::RunControl& control) {
    const std::vector<Block> blocks = cut_into_blocks(regions);
    std::vector<RegionQuality> parts(blocks.size());
    const std::size_t share = std::max(least_share, mesh.face_count() / sampled_faces);
    runtime::parallel_for(blocks.size(), control.should_stop() ? 256 : 1, [&](std::size_t i) {
        const Block& block = blocks[i];
        const Faces faces(regions.face.data() + block.begin, regions.face.data() + block.end);
        parts[i] = control.should_stop() ? estimate_faces(mesh, faces, surfaces[block.region], share)
                                         : measure_faces(mesh, faces, surfaces[block.region]);
    });
    std::vector<RegionQuality> quality(regions.count());
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        RegionQuality& q = quality[blocks[i].region];
        q.area += parts[i].area;
        q.squared_distance += parts[i].squared_distance;
        q.max_distance = std::max(q.max_distance, parts[i].max_distance);
        q.energy.distance += parts[i].energy.distance;
        q.energy.normal += parts[i].energy.normal;
        q.gradient += parts[i].gradient;
        q.against += parts[i].against;
    }
    for (std::size_t r = 0; r < quality.size(); ++r) {
        if (surfaces[r].loop_energy) quality[r].energy = *surfaces[r].loop_energy;
    }
    return quality;
}

}  // namespace quadseg::flow
