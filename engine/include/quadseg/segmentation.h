// The one call, and its result.
#pragma once

#include <quadseg/context.h>
#include <quadseg/export.h>
#include <quadseg/mesh.h>
#include <quadseg/options.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace quadseg {

enum class SurfaceType : std::uint8_t {
    plane,
    sphere,
    cylinder,
    cone,
    torus,
    ellipsoid,
    elliptic_cylinder,
    elliptic_cone,
    elliptic_paraboloid,
    hyperbolic_paraboloid,
    hyperboloid_one_sheet,
    hyperboloid_two_sheets,
    parabolic_cylinder,
    hyperbolic_cylinder,
    quadric,  ///< a quadric of no better name (imaginary, plane pair, or near a border between types)
    blend,    ///< rolling-ball fillet that is no torus: spine curve and radius
    freeform  ///< smooth patch that no quadric or torus explains; its quadric is the best fit
};
inline constexpr std::size_t surface_type_count = 17;

/// "plane", "elliptic_cylinder" … Never null.
QUADSEG_API const char* to_string(SurfaceType type) noexcept;

/// f(x) = c · [1, x, y, z, x², xy, xz, y², yz, z²], in the input's coordinates and unit, ∇f along the mesh normals,
/// area-weighted mean of |∇f| over its region 1.
using Quadric = std::array<double, 10>;

/// A typed surface in the input's coordinates and unit. Fields that a type does not have are 0.
struct Surface {
    SurfaceType type = SurfaceType::plane;
    Quadric coefficients{};  ///< torus, blend, freeform: the best quadric of the region
    std::array<double, 3>
        point{};  ///< plane: a point; sphere, torus, ellipsoid, hyperboloid: centre; cylinder: axis point; cone: apex
    std::array<double, 3> axis{};       ///< unit. plane: normal (outward); cone: from the apex into the cone
    double radius = 0;                  ///< sphere, cylinder, blend; torus: major radius
    double minor_radius = 0;            ///< torus
    double half_angle = 0;              ///< cone, radians
    std::array<double, 9> axes{};       ///< general quadrics: three unit principal axes, row by row
    std::array<double, 3> semi_axes{};  ///< general quadrics, where they exist
    bool outward = true;                ///< the mesh normal points away from axis, centre or spine (boss, not hole)
};

struct Region {
    std::int32_t id = 0;  ///< its label
    Surface surface;
    std::size_t faces = 0;
    double area = 0;          ///< input unit squared
    double rms = 0, max = 0;  ///< exact distances of the region's vertices to its surface, relative to the diagonal;
                              ///< rms area-weighted
    double energy = 0;        ///< hybrid energy in the unit cube
    std::int32_t surface_id = 0;  ///< equal for regions that lie on one analytic surface
    bool valid = true;            ///< the foot points lie on one sheet and the normals agree (MATH.md §4)
};

enum class StopReason {
    converged,  ///< by itself: nothing left that is worth merging or splitting
    regions,    ///< the wanted number of regions was reached
    tolerance,  ///< the wanted tolerance or energy threshold was reached
    maximum,    ///< the bound on the number of regions was reached
    deadline,   ///< partial result: out of time
    cancelled   ///< partial result: cancelled
};
QUADSEG_API const char* to_string(StopReason reason) noexcept;

struct Energy {
    double total = 0, distance = 0, normal = 0;  ///< unit cube; total = distance + ω·normal
};

struct Timings {
    double read = 0, prepare = 0, coarse = 0, fine = 0, post = 0, write = 0, total = 0;  ///< seconds, wall
};

/// One merge of the bottom-up flow: E(K) for every K, so that a number of regions can be chosen afterwards.
struct MergeStep {
    std::uint32_t regions = 0;  ///< regions left after this merge
    double energy = 0;          ///< the flow's estimate of the total energy (unit cube) at that point
};

/// Regions that share a direction, an axis, a radius … found on the final surfaces.
struct Regularity {
    enum class Kind { parallel, perpendicular, coaxial, coplanar, concentric, equal_radius } kind = Kind::parallel;
    std::vector<std::int32_t> regions;
    bool snapped = false;
};
QUADSEG_API const char* to_string(Regularity::Kind kind) noexcept;

/// Length and mean turning angle of the borders between regions, before and after smoothing.
struct BorderMeasure {
    double length = 0;  ///< relative to the diagonal
    double zigzag = 0;  ///< mean turning angle at border vertices of two border edges, degrees
};

struct Segmentation {
    /// One per input face, in input order: the id of its region (0 … regions−1). −1 only for faces listed in
    /// `unlabelled`.
    std::vector<std::int32_t> labels;
    std::vector<std::uint32_t> unlabelled;  ///< input faces without a label: degenerate ones without any neighbour
    std::vector<Region> regions;
    Energy energy;
    double rms = 0, max = 0;  ///< exact vertex-to-surface distances over all regions, relative to the diagonal
    StopReason stop = StopReason::converged;
    bool partial = false;  ///< stopped by deadline or cancellation
    double noise = 0;      ///< estimated noise of the vertices, relative to the diagonal
    Timings seconds;
    int threads = 0;             ///< that could take part
    std::size_t peak_bytes = 0;  ///< peak resident memory of the process at the end of the call
    MeshReport input;
    std::vector<MergeStep> history;
    std::vector<double> energies;  ///< paper preset: total energy after every Lloyd iteration
    std::vector<Regularity> regularities;
    std::vector<double> projected;  ///< 3V, with Options::project
    BorderMeasure borders_before, borders_after;
};

/// Segments a mesh. Labels come back in input face order. Same input and options give the same result at any thread
/// count. At a deadline or cancellation the best partial result comes back with `partial` set. Throws Error
/// (invalid_argument, invalid_mesh, empty_mesh, memory_limit). Re-entrant; uses the caller's TBB arena, limited to
/// Context::threads(). Source: Yan, Wang, Liu, Yang: Variational mesh segmentation via quadric surface fitting, CAD 44
/// (2012).
QUADSEG_API Segmentation segment(const MeshView& mesh, const Options& options = {}, Context* context = nullptr);

}  // namespace quadseg
