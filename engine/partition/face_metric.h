// Energy of one face with respect to one proxy, fast enough for the inner loop of the flood.
#pragma once

#include "mesh/work_mesh.h"
#include "quadric/region_fit.h"

#include <cstddef>

namespace quadseg::partition {

/// E = distance · E_d + normal · E_n. Eq. (3) is {1, ω}; the comparison methods weigh otherwise.
struct FaceMetric {
    double distance = 1;
    double normal = 0.5;
    /// f and ∇f are divided by |∇f| at the face's centroid (one-point gradient of section 3.2.2); false: the
    /// unnormalised metric of Kanai et al., ∫f² and ∫|∇f − n|².
    bool normalised = true;
};

/// E_d and E_n of a face, exact for polynomials (MATH.md §2): f and ∇f at the corners determine all six values, and
/// ∇f at the centroid is the mean of the three.
quadric::TriangleEnergy face_energy(const mesh::WorkMesh& mesh, std::size_t face, const quadric::Proxy& proxy,
                                    bool normalised) noexcept;

/// The same for any triangle with unit normal n.
quadric::TriangleEnergy corner_energy(const quadric::Proxy& proxy, const Vec3& a, const Vec3& b, const Vec3& c,
                                      const Vec3& n, double area, bool normalised) noexcept;

/// E / area of a face: what floods, seeds and insertions are ordered by, so that slivers and large triangles are judged
/// alike. 0 for a face without area; never NaN (an overflow counts as the largest double).
double error_density(const mesh::WorkMesh& mesh, std::size_t face, const quadric::Proxy& proxy,
                     const FaceMetric& metric) noexcept;

}  // namespace quadseg::partition
