// Direct fits of typed surfaces to points with normals: linear starts, then Levenberg–Marquardt on exact distances.
#pragma once

#include "math/vec3.h"
#include "surface/surface.h"

#include <cstddef>
#include <span>

namespace quadseg::surface {

/// Points of a region (tessellation vertices, which lie on the true surface) and normals at them.
struct PointSet {
    std::span<const Vec3> points;
    std::span<const Vec3> normals;    ///< unit, same size, or empty (then only plane and sphere can be started)
    std::span<const double> weights;  ///< or empty: 1
};

struct FitOptions {
    int iterations = 30;
    bool robust =
        true;  ///< Cauchy weights with scale 3·median |d|, re-estimated: trim-curve vertices may be off by 1e-5
    double minimum_scale = 1e-12;  ///< of the robust scale, in the points' unit
    double hopeless = 0;           ///< give up if the median |d| is still above this, in the points' unit; 0: never …
    int hopeless_after = 5;        ///< … after so many steps
    double wanted = 0;    ///< a fit is of use only with a median |d| up to this, in the points' unit: give up where it
                          ///< stops falling above, take the first start that leads well below; 0: any is of use
    double most_rms = 0;  ///< the same of least squares (not robust): of use only with an rms up to this; 0: any is
};

struct SurfaceFit {
    Surface surface;
    bool ok = false;                               ///< the points fix all parameters, finite, radius below 1e4 extents
    double rms = 0;                                ///< of signed distances, unweighted
    double median = 0, q90 = 0, q97 = 0, max = 0;  ///< of |distance|
};

/// Starts from points and normals: plane PCA; sphere linear; cylinder = smallest eigenvector of Σ n nᵀ and a circle;
/// cone = apex of Σ (n·(x−a))², axis = smallest eigenvector of cov(n), also from the cylinder; torus = 6×6 line
/// complex, circle in (ρ, z).
Surface initial_plane(const PointSet& p);
Surface initial_sphere(const PointSet& p);
Surface initial_cylinder(const PointSet& p);
Surface initial_cone(const PointSet& p);
Surface initial_torus(const PointSet& p);

/// Start, then refine. type: plane, sphere, cylinder, cone or torus. Orientation (`outward`) from the normals.
SurfaceFit fit(SurfaceType type, const PointSet& p, const FitOptions& options = {});
/// Refines a given start on exact distances (≤ 7 dof, analytic Jacobian). The type stays.
SurfaceFit refine(const Surface& start, const PointSet& p, const FitOptions& options = {});
/// Distances only, no fitting.
SurfaceFit measure(const Surface& s, const PointSet& p);

/// Degrees of freedom: plane 3, sphere 4, cylinder 5, cone 6, torus 7, quadrics 9.
int degrees_of_freedom(SurfaceType type) noexcept;

}  // namespace quadseg::surface
