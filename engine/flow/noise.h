// How noisy the vertices of a mesh are: what decides between exact surfaces and likelihood.
#pragma once

#include "mesh/work_mesh.h"
#include "runtime/run_control.h"

namespace quadseg::flow {

/// All in the unit frame.
struct NoiseEstimate {
    double sigma = 0;  ///< standard deviation of the vertices along their normals; about 0 on clean meshes
    double edge = 0;   ///< mean edge length, as it would be without the noise
    double flat = 0;   ///< share of edges that are flatter than noise leaves them

    /// Above this normals are of little use and every decision needs an honest price of chance.
    static constexpr double noisy_from = 0.02;  ///< σ/h
    bool noisy() const noexcept { return sigma > noisy_from * edge; }
    /// From here on (σ/h) even filtered normals say little.
    static constexpr double strong_from = 0.25;
    bool strong() const noexcept { return sigma >= strong_from * edge; }
    /// The roughness may be that of a coarse tessellation: some edges show no noise at all.
    bool doubtful() const noexcept { return flat > 0.02; }
};

/// Degrees by which a region's normals may miss its surface where it is worth a merge: small on exact meshes, larger on
/// organic shapes and light scans, whose surfaces are no quadrics and whose noise is correlated, and fading to nothing
/// where the noise is strong enough to be its own allowance.
double misfit_angle(const NoiseEstimate& noise) noexcept;

/// The smaller of two estimates: one from the bilaplacian of the vertices, which creases inflate, and one from the
/// 20 % quantile of the dihedral angles, which is 0 on CAD meshes. About 10 % low at .5 edges, a third at
/// one edge. Throws Stopped.
NoiseEstimate estimate_noise(const mesh::WorkMesh& mesh, const runtime::RunControl& control);

}  // namespace quadseg::flow
