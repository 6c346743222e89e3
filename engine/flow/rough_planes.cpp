#include "flow/rough_planes.h"

#include "runtime/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace quadseg::flow {

namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// Sums over the faces of a region, and two of them that are far from each other along the mesh's curve of faces.
struct FaceSums {
    Vec3 normal;
    double area = 0;
    std::uint32_t first = none, last = none;
};

RoughPlane plane_of(const mesh::WorkMesh& mesh, const FaceSums& sums) {
    RoughPlane plane;
    if (sums.first == none) return plane;
    plane.area = sums.area;
    const double length = norm(sums.normal);
    if (length > 0) plane.normal = sums.normal / length;
    // Σ a |n_t − n|² = 2 (Σ a − n·Σ a n_t)
    plane.normal_energy = std::max(0.0, 2 * (sums.area - length));
    plane.point = (mesh.centroid(sums.first) + mesh.centroid(sums.last)) / 2;
    double looked_at = 0;
    for (const std::uint32_t f : {sums.first, sums.last}) {
        const double area = mesh.areas[f];
        double sum = 0, squares = 0;
        for (int k = 0; k < 3; ++k) {
            const double d = dot(plane.normal, mesh.corner(f, k) - plane.point);
            sum += d;
            squares += d * d;
            plane.max_distance = std::max(plane.max_distance, std::abs(d));
        }
        plane.squared_distance += area / 3 * squares;
        plane.distance_energy += area / 12 * (squares + sum * sum);
        if (area > 0 && !(dot(plane.normal, mesh.normals[f]) > 0)) plane.agrees = false;
        looked_at += area;
    }
    const double factor = looked_at > 0 ? sums.area / looked_at : 0;
    plane.squared_distance *= factor;
    plane.distance_energy *= factor;
    return plane;
}

}  // namespace

std::vector<RoughPlane> rough_planes(const mesh::WorkMesh& mesh, const partition::Labels& labels, std::size_t count) {
    std::vector<FaceSums> sums(count);
    for (std::size_t f = 0; f < labels.size(); ++f) {
        if (labels[f] < 0) continue;
        FaceSums& s = sums[static_cast<std::size_t>(labels[f])];
        s.normal += mesh.normals[f] * mesh.areas[f];
        s.area += mesh.areas[f];
        s.last = static_cast<std::uint32_t>(f);
        if (s.first == none) s.first = s.last;
    }
    std::vector<RoughPlane> planes(count);
    runtime::parallel_for(count, 256, [&](std::size_t r) { planes[r] = plane_of(mesh, sums[r]); });
    return planes;
}

}  // namespace quadseg::flow
