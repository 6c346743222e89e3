// The complete fit of a region to its triangles: frame, plane first, two-step quadric, best by true energy.
#pragma once

#include "quadric/energy.h"
#include "quadric/monomials.h"

#include <cstddef>
#include <functional>
#include <span>

namespace quadseg::quadric {

/// Triangles of a region as arrays, gathered by the caller or streamed: positions in the unit frame.
struct TriangleSoup {
    std::span<const Vec3> corners;  ///< 3 a triangle
    std::span<const Vec3> normals;  ///< unit
    std::span<const double> areas;
    std::size_t size() const noexcept { return areas.size(); }
};

/// A proxy: a plane or quadric with its own local origin, so that evaluation keeps its precision far from the unit
/// frame's origin: f(x) = value(c, x − origin). Oriented along the normals, area-weighted mean |∇f| 1 over its region.
struct Proxy {
    Vec3 origin;
    Coefficients c{};
    double gradient_floor = 1e-6;  ///< 5 % of the region's median |∇f(c_t)|
    bool planar() const noexcept { return is_plane(c); }
};

struct RegionFit {
    Proxy proxy;
    TriangleEnergy energy;  ///< true energies (one-point gradient of the final f), summed over the region, unit frame
    double total = 0;       ///< energy.hybrid(weight)
    bool valid = true;      ///< sheets and normals (validity())
};

struct RegionFitOptions {
    double weight = 0.5;
    double plane_tolerance = 1e-6;  ///< plane accepted when its hybrid energy is below: E (paper) or E/area
    bool plane_tolerance_per_area = false;
    bool best_of = true;  ///< also LSQ0 + reweighting beside Taubin + reweighting, chosen by true energy; false: the
                          ///< paper's two steps
    int reweightings = 1;
    /// Called before every pass over the faces; what it throws ends the fit. For regions of a million faces.
    std::function<void()> poll = {};
};

/// Section 4.3.2. Deterministic. O(size).
RegionFit fit_region(const TriangleSoup& region, const RegionFitOptions& options);

/// Proxy that is the plane of one triangle (section 4.2).
Proxy plane_proxy(const Vec3& point, const Vec3& normal) noexcept;

TriangleEnergy triangle_energy(const Proxy& proxy, const Vec3& v0, const Vec3& v1, const Vec3& v2, const Vec3& n,
                               double area) noexcept;

/// MATH.md §4: all foot points of the region on one connected sheet and n·∇f > 0 on ≥ 99 % of its area.
bool is_valid(const Proxy& proxy, const TriangleSoup& region);

}  // namespace quadseg::quadric
