#include "flow/noisy_coarse.h"

#include "flow/coarse.h"
#include "flow/denoised_mesh.h"
#include "flow/noisy.h"
#include "flow/softened_mesh.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace quadseg::flow {
namespace {

/// Smooth borders have no sharp edges under noise: nothing is kept in place.
constexpr double no_crease = 180;

/// Moves every vertex of the simplified mesh to the mean of those that it stands for: decimation, which looks for what
/// the faces' planes have in common, makes strong noise stronger.
void average(const mesh::WorkMesh& fine, simplify::Decimated& coarse, const runtime::RunControl& control) {
    std::vector<Vec3> sums(coarse.positions.size());
    std::vector<std::uint32_t> counts(coarse.positions.size(), 0);
    std::vector<std::uint8_t> seen(fine.vertex_count(), 0);
    std::size_t polls = 0;
    for (std::size_t f = 0; f < fine.face_count(); ++f) {
        control.check_often(polls);
        const std::array<std::uint32_t, 3>& stand_in = coarse.faces[coarse.face_map[f]];
        for (const std::uint32_t v : fine.faces[f]) {
            if (seen[v] != 0) continue;
            seen[v] = 1;
            const Vec3& x = fine.positions[v];
            const std::uint32_t nearest =
                *std::min_element(stand_in.begin(), stand_in.end(), [&](std::uint32_t a, std::uint32_t b) {
                    return squared_norm(coarse.positions[a] - x) < squared_norm(coarse.positions[b] - x);
                });
            sums[nearest] += x;
            ++counts[nearest];
        }
    }
    for (std::size_t v = 0; v < sums.size(); ++v) {
        if (counts[v] > 0) coarse.positions[v] = sums[v] / counts[v];
    }
}

/// `normals`: those that scans of light noise are denoised with are kept there.
simplify::Decimated simplified_scan(const FlowInput& input, const NoiseEstimate& noise, std::size_t faces,
                                    std::vector<Vec3>& normals) {
    if (!noise.strong()) {
        normals = softening_normals(input.mesh, noise, input.control);
        const std::vector<Vec3> positions = denoised_mesh(input.mesh, normals, input.control).positions;
        return simplified(input, positions, faces, no_crease);
    }
    simplify::Decimated coarse = simplified(input, input.mesh.positions, faces, no_crease);
    average(input.mesh, coarse, input.control);
    return coarse;
}

}  // namespace

FlowResult run_noisy_coarse(const FlowInput& input, const NoiseEstimate& noise, const NoisyCoarseSizes& sizes) {
    const std::size_t faces = input.mesh.face_count();
    // Who asks for more detail gets the faces to show it on: at last all of them.
    const double more = std::max(1.0, input.options.detail);
    if (static_cast<double>(faces) < more * static_cast<double>(sizes.pays_from)) return run_noisy(input, noise);
    const auto wanted = static_cast<std::size_t>(more * static_cast<double>(sizes.coarse_faces));
    const auto flow_on_coarse = [&](const FlowInput& coarse) {
        if (&coarse.mesh == &input.mesh) return run_noisy(input, noise);  // stopped, or not to be simplified
        NoiseEstimate rest = estimate_noise(coarse.mesh, coarse.control);
        rest.sigma = std::max(rest.sigma, NoiseEstimate::noisy_from * rest.edge);
        return run_noisy(coarse, rest, Scan::simplified);
    };
    std::vector<Vec3> normals;
    const auto simplify = [&](const FlowInput& fine) {
        return simplified_scan(fine, noise, std::min(wanted, faces / 2), normals);
    };
    const auto refine = [&](const FlowInput& fine, const partition::Labels& labels) {
        return refine_noisy(fine, noise, labels, std::move(normals));
    };
    return run_coarse(input, simplify, flow_on_coarse, refine);
}

}  // namespace quadseg::flow
