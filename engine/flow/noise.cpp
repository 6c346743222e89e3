#include "flow/noise.h"

#include "flow/filtered_normals.h"
#include "mesh/vertex_faces.h"
#include "runtime/parallel.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace quadseg::flow {
namespace {

/// Which faces a sample holds depends on how the mesh lies in its axes. What scans are judged by should not, up to
/// this size; that there is noise at all shows in a smaller one.
constexpr std::size_t first_samples = 16384, most_samples = 65536;
constexpr std::size_t vertex_grain = 8192;

double quantile(std::vector<double>& values, double q) {
    if (values.empty()) return 0;
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

struct EdgeStatistics {
    double mean_length = 0;
    double low_angle = 0;  ///< 20 % quantile of the dihedral angles
    double flat = 0;       ///< share of angles below a hundredth of that: of white noise .002
};

EdgeStatistics sample_edges(const mesh::WorkMesh& mesh, std::size_t samples) {
    const std::size_t stride = 1 + (mesh.face_count() - 1) / samples;
    double sum = 0;
    std::size_t count = 0;
    std::vector<double> angles;
    for (std::size_t f = 0; f < mesh.face_count(); f += stride) {
        for (int k = 0; k < 3; ++k) {
            sum += norm(mesh.corner(f, (k + 1) % 3) - mesh.corner(f, k));
            ++count;
            const std::int32_t g = mesh.neighbors[f][static_cast<std::size_t>(k)];
            if (g < 0) continue;
            const Vec3 &a = mesh.normals[f], &b = mesh.normals[static_cast<std::size_t>(g)];
            if (squared_norm(a) > 0 && squared_norm(b) > 0) angles.push_back(angle_between(a, b));
        }
    }
    EdgeStatistics edges;
    edges.mean_length = count > 0 ? sum / static_cast<double>(count) : 0;
    edges.low_angle = quantile(angles, 0.2);
    const auto flat = std::count_if(angles.begin(), angles.end(), [&](double a) { return a < 0.01 * edges.low_angle; });
    if (!angles.empty()) edges.flat = static_cast<double>(flat) / static_cast<double>(angles.size());
    return edges;
}

NoiseEstimate from_edges(const EdgeStatistics& edges) {
    NoiseEstimate estimate;
    estimate.edge = edges.mean_length;
    estimate.flat = edges.flat;
    // Of white noise of standard deviation 1 edge the dihedral angles have 2.31; .2533 is the 20 % quantile of
    // |N(0,1)|.
    estimate.sigma = edges.low_angle / 0.2533 * edges.mean_length / 2.31;
    return estimate;
}

/// Averages over the ring that bring normals back even where noise is as large as the edges.
constexpr int normal_averages = 4;

/// Robust standard deviation of n·(I − S)²x, S the mean over the ring: low frequencies are gone, of white noise of
/// standard deviation 1 remains 1.36. Normals of faces that are not smoothed would point along the noise and hide half
/// of it.
double bilaplacian_deviation(const mesh::WorkMesh& mesh, const std::vector<Vec3>& smoothed,
                             const runtime::RunControl& control) {
    const mesh::VertexFaces incident = mesh::vertex_faces(mesh, control);
    control.check();
    const std::size_t vertices = mesh.vertex_count();
    const auto minus_ring_mean = [&](const std::vector<Vec3>& x, std::size_t v) {
        Vec3 sum;
        double count = 0;
        for (std::size_t i = incident.begin[v]; i < incident.begin[v + 1]; ++i) {
            for (const std::uint32_t w : mesh.faces[incident.face[i]]) {
                if (w == v) continue;
                sum += x[w];
                ++count;
            }
        }
        return count > 0 ? x[v] - sum / count : Vec3{};
    };
    std::vector<Vec3> laplacian(vertices);
    runtime::parallel_blocks(vertices, vertex_grain, [&](std::size_t begin, std::size_t end) {
        control.check();
        for (std::size_t v = begin; v < end; ++v) laplacian[v] = minus_ring_mean(mesh.positions, v);
    });
    std::vector<double> deviation(vertices);
    runtime::parallel_blocks(vertices, vertex_grain, [&](std::size_t begin, std::size_t end) {
        control.check();
        for (std::size_t v = begin; v < end; ++v) {
            Vec3 normal;
            for (std::size_t i = incident.begin[v]; i < incident.begin[v + 1]; ++i) {
                normal += smoothed[incident.face[i]] * mesh.areas[incident.face[i]];
            }
            deviation[v] = std::abs(dot(normalized(normal), minus_ring_mean(laplacian, v)));
        }
    });
    control.check();
    return 1.4826 * quantile(deviation, 0.5) / 1.36;
}

/// Mean length of the edges as they were without noise: their projections onto the smoothed faces.
double projected_edge(const mesh::WorkMesh& mesh, const std::vector<Vec3>& smoothed) {
    const std::size_t stride = 1 + (mesh.face_count() - 1) / most_samples;
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t f = 0; f < mesh.face_count(); f += stride) {
        for (int k = 0; k < 3; ++k) {
            const Vec3 edge = mesh.corner(f, (k + 1) % 3) - mesh.corner(f, k);
            sum += norm(edge - smoothed[f] * dot(edge, smoothed[f]));
            ++count;
        }
    }
    return count > 0 ? sum / static_cast<double>(count) : 0;
}

}  // namespace

double misfit_angle(const NoiseEstimate& noise) noexcept {
    constexpr double exact = 4.4, organic = 14, noisy_from = 0.02, fading_from = 0.042;
    const double ratio = noise.edge > 0 ? noise.sigma / noise.edge : 0;
    if (ratio < noisy_from) return exact + (organic - exact) * ratio / noisy_from;
    const double fading = std::min(1.0, fading_from / ratio);
    return organic * fading * fading;
}

NoiseEstimate estimate_noise(const mesh::WorkMesh& mesh, const runtime::RunControl& control) {
    control.check();
    if (mesh.face_count() == 0) return {};
    NoiseEstimate estimate = from_edges(sample_edges(mesh, first_samples));
    if (!estimate.noisy()) return estimate;
    if (mesh.face_count() > first_samples) {
        estimate = from_edges(sample_edges(mesh, most_samples));
        if (!estimate.noisy()) return estimate;
    }
    const std::vector<Vec3> smoothed = filtered_normals(mesh, normal_averages, 0, control);
    estimate.sigma = std::min(estimate.sigma, bilaplacian_deviation(mesh, smoothed, control));
    estimate.edge = projected_edge(mesh, smoothed);
    return estimate;
}

}  // namespace quadseg::flow
