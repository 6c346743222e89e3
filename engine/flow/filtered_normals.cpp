#include "flow/filtered_normals.h"

#include "mesh/vertex_faces.h"
#include "runtime/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace quadseg::flow {
namespace {

constexpr std::size_t face_grain = 4096;
// Narrower widths make staircases of smooth surfaces.
constexpr double narrowest = 8 * std::numbers::pi / 180, widest = 25 * std::numbers::pi / 180;

/// Width of the bilateral weight: three times the median difference between neighbours. (A sample of the faces depends
/// on how the mesh lies in its axes.)
double range_width(const mesh::WorkMesh& mesh, const std::vector<Vec3>& normals) {
    constexpr std::size_t most_samples = 65536;
    const std::size_t stride = 1 + (mesh.face_count() - 1) / most_samples;
    std::vector<double> squared_differences;
    for (std::size_t f = 0; f < mesh.face_count(); f += stride) {
        for (const std::int32_t g : mesh.neighbors[f]) {
            if (g < 0) continue;
            const auto u = static_cast<std::size_t>(g);
            if (stride > 1 || u > f) squared_differences.push_back(squared_norm(normals[f] - normals[u]));
        }
    }
    if (squared_differences.empty()) return widest;
    const auto middle = squared_differences.begin() + static_cast<std::ptrdiff_t>(squared_differences.size() / 2);
    std::nth_element(squared_differences.begin(), middle, squared_differences.end());
    return std::clamp(3 * std::sqrt(*middle), narrowest, widest);
}

}  // namespace

std::vector<Vec3> filtered_normals(const mesh::WorkMesh& mesh, int averages, int passes,
                                   const runtime::RunControl& control) {
    const mesh::VertexFaces incident = mesh::vertex_faces(mesh, control);
    control.check();
    std::vector<Vec3> normals = mesh.normals, next(normals.size());
    for (int pass = 0; pass < averages + passes; ++pass) {
        const bool bilateral = pass >= averages;
        const double width = bilateral ? range_width(mesh, normals) : 0;
        // (1 − d²/6w²)³ for exp(−d²/2w²): as good a weight, without the exponential; nothing beyond 2.45 w.
        const double falling = bilateral ? 1 / (6 * width * width) : 0;
        runtime::parallel_blocks(normals.size(), face_grain, [&](std::size_t begin, std::size_t end) {
            control.check();
            for (std::size_t f = begin; f < end; ++f) {
                const Vec3 own = normals[f];
                Vec3 sum;
                for (const std::uint32_t v : mesh.faces[f]) {
                    for (std::size_t i = incident.begin[v]; i < incident.begin[v + 1]; ++i) {
                        const std::size_t g = incident.face[i];
                        const double w = std::max(0.0, 1 - falling * squared_norm(normals[g] - own));
                        sum += normals[g] * (mesh.areas[g] * w * w * w);
                    }
                }
                const double length = norm(sum);
                next[f] = length > 0 ? sum / length : own;
            }
        });
        normals.swap(next);
    }
    return normals;
}

}  // namespace quadseg::flow
