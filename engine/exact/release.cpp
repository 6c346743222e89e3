#include "exact/release.h"

#include "exact/hypothesis.h"
#include "math/symmetric3.h"
#include "surface/fit.h"

#include <algorithm>
#include <numbers>
#include <numeric>
#include <optional>
#include <span>

namespace quadseg::exact {

namespace {

constexpr double gentle_least = 0.3 * std::numbers::pi / 180, gentle_most = 30 * std::numbers::pi / 180;
constexpr double mostly = 0.5;
/// Fewer strips in a row than this are planes that someone meant.
constexpr std::size_t least_strips = 6;
/// Amid free faces a surface needs as many facets as this to be believed.
constexpr std::size_t believable_facets = 12;

struct RegionBorder {
    double perimeter = 0;
    double to_strips = 0;  ///< gentle fold to a planar region
    double to_free = 0;    ///< smooth or gentle to a free face
    std::size_t facets = 0;
    double area = 0;
};

/// Strips of one tessellation are alike; a bevel beside a face is not.
bool alike(double area_a, double area_b) {
    return std::max(area_a, area_b) <= 2.5 * std::min(area_a, area_b);
}

std::vector<RegionBorder> measure_borders(const Scene& scene, const Explained& state) {
    std::vector<RegionBorder> borders(state.surface.size());
    std::vector<std::int32_t> last_facet(state.surface.size(), -1);
    for (std::size_t facet = 0; facet < scene.facets.count(); ++facet) {
        for (std::size_t j = scene.facets.begin[facet]; j < scene.facets.begin[facet + 1]; ++j) {
            const std::int32_t r = state.region[scene.facets.face[j]];
            if (r < 0 || last_facet[static_cast<std::size_t>(r)] == static_cast<std::int32_t>(facet)) continue;
            last_facet[static_cast<std::size_t>(r)] = static_cast<std::int32_t>(facet);
            ++borders[static_cast<std::size_t>(r)].facets;
        }
    }
    for (std::size_t f = 0; f < state.region.size(); ++f) {
        if (state.region[f] >= 0) borders[static_cast<std::size_t>(state.region[f])].area += scene.mesh.areas[f];
    }
    std::size_t polls = 0;
    for (std::size_t f = 0; f < state.region.size(); ++f) {
        scene.control.check_often(polls);
        if (state.region[f] < 0) continue;
        RegionBorder& border = borders[static_cast<std::size_t>(state.region[f])];
        for (int k = 0; k < 3; ++k) {
            const std::int32_t g = scene.mesh.neighbors[f][static_cast<std::size_t>(k)];
            if (g >= 0 && state.region[static_cast<std::size_t>(g)] == state.region[f]) continue;
            const double length = norm(scene.mesh.corner(f, (k + 1) % 3) - scene.mesh.corner(f, k));
            border.perimeter += length;
            if (g < 0) continue;
            const double fold = dihedral(scene.mesh, f, static_cast<std::size_t>(g));
            if (fold > gentle_most) continue;
            const std::int32_t other = state.region[static_cast<std::size_t>(g)];
            if (other < 0) {
                border.to_free += length;
            } else if (fold > gentle_least &&
                       state.surface[static_cast<std::size_t>(other)].type == SurfaceType::plane) {
                border.to_strips += length;
            }
        }
    }
    return borders;
}

/// For every strip the number of strips that hang together with it over gentle folds.
std::vector<std::size_t> row_sizes(const Scene& scene, const Explained& state, const std::vector<RegionBorder>& borders,
                                   const std::vector<std::uint8_t>& strip) {
    std::vector<std::uint32_t> parent(strip.size());
    std::iota(parent.begin(), parent.end(), 0U);
    const auto find = [&](std::uint32_t r) {
        while (parent[r] != r) r = parent[r] = parent[parent[r]];
        return r;
    };
    std::size_t polls = 0;
    for (std::size_t f = 0; f < state.region.size(); ++f) {
        scene.control.check_often(polls);
        const std::int32_t a = state.region[f];
        if (a < 0 || strip[static_cast<std::size_t>(a)] == 0) continue;
        for (const std::int32_t g : scene.mesh.neighbors[f]) {
            if (g < 0) continue;
            const std::int32_t b = state.region[static_cast<std::size_t>(g)];
            if (b <= a || strip[static_cast<std::size_t>(b)] == 0) continue;
            if (!alike(borders[static_cast<std::size_t>(a)].area, borders[static_cast<std::size_t>(b)].area)) continue;
            if (dihedral(scene.mesh, f, static_cast<std::size_t>(g)) > gentle_most) continue;
            const std::uint32_t x = find(static_cast<std::uint32_t>(a)), y = find(static_cast<std::uint32_t>(b));
            parent[std::max(x, y)] = std::min(x, y);
        }
    }
    std::vector<std::size_t> count(strip.size(), 0);
    for (std::uint32_t r = 0; r < strip.size(); ++r) {
        if (strip[r] != 0) ++count[find(r)];
    }
    std::vector<std::size_t> size(strip.size(), 0);
    for (std::uint32_t r = 0; r < strip.size(); ++r) size[r] = count[find(r)];
    return size;
}

/// No parallel straight lines run along these surfaces.
bool may_be_extruded(SurfaceType type) {
    switch (type) {
        case SurfaceType::sphere:
        case SurfaceType::cone:
        case SurfaceType::torus:
        case SurfaceType::ellipsoid:
        case SurfaceType::elliptic_cone:
        case SurfaceType::elliptic_paraboloid:
        case SurfaceType::hyperbolic_paraboloid:
        case SurfaceType::hyperboloid_one_sheet:
        case SurfaceType::hyperboloid_two_sheets:
            return false;
        default:
            return true;
    }
}

/// Normals all perpendicular to one direction, and not all equal.
bool is_extruded(const Symmetric3& normals, double area) {
    constexpr double most_tilt = 1e-5, least_turn = 1e-2;  // RMS, radians
    const EigenSystem eigen = eigen_decomposition(normals);
    return eigen.values[0] <= most_tilt * most_tilt * area && eigen.values[1] > least_turn * least_turn * area;
}

std::optional<Surface> cylinder_through(const Scene& scene, std::span<const std::uint32_t> faces, Marks& marks) {
    const PatchPoints p = patch_points(scene, faces, marks);
    const surface::SurfaceFit fit = surface::fit(SurfaceType::cylinder, {p.points, p.face_normals, {}});
    if (!fit.ok || fit.median > scene.tolerances.fit || fit.max > scene.tolerances.trim) return std::nullopt;
    return fit.surface;
}

}  // namespace

void release_extruded(const Scene& scene, Explained& state) {
    std::vector<Symmetric3> spread(state.surface.size());
    std::vector<double> area(state.surface.size(), 0);
    for (std::size_t f = 0; f < state.region.size(); ++f) {
        if (state.region[f] < 0) continue;
        const auto r = static_cast<std::size_t>(state.region[f]);
        spread[r].add_outer(scene.mesh.normals[f], scene.mesh.areas[f]);
        area[r] += scene.mesh.areas[f];
    }
    std::vector<std::vector<std::uint32_t>> faces(state.surface.size());
    for (std::size_t f = 0; f < state.region.size(); ++f) {
        if (state.region[f] < 0) continue;
        const auto r = static_cast<std::size_t>(state.region[f]);
        if (area[r] > 0 && !may_be_extruded(state.surface[r].type)) faces[r].push_back(static_cast<std::uint32_t>(f));
    }
    Marks marks;
    marks.prepare(scene.mesh.face_count(), scene.mesh.vertex_count());
    for (std::size_t r = 0; r < faces.size(); ++r) {
        if (faces[r].empty() || !is_extruded(spread[r], area[r])) continue;
        scene.control.check();
        if (const std::optional<Surface> cylinder = cylinder_through(scene, faces[r], marks)) {
            state.surface[r] = *cylinder;
            continue;
        }
        for (const std::uint32_t f : faces[r]) state.region[f] = -1;
    }
}

void release_doubtful(const Scene& scene, Explained& state) {
    const std::vector<RegionBorder> borders = measure_borders(scene, state);
    std::vector<std::uint8_t> doubtful(borders.size(), 0);
    std::vector<std::uint8_t> strip(borders.size(), 0);
    for (std::size_t r = 0; r < borders.size(); ++r) {
        const RegionBorder& b = borders[r];
        const bool plane = state.surface[r].type == SurfaceType::plane;
        strip[r] = plane && b.to_strips + b.to_free > mostly * b.perimeter && b.to_strips > 0.25 * b.perimeter ? 1 : 0;
        doubtful[r] = b.to_free > mostly * b.perimeter && b.facets < believable_facets ? 1 : 0;
    }
    const std::vector<std::size_t> row = row_sizes(scene, state, borders, strip);
    for (std::size_t r = 0; r < borders.size(); ++r) {
        if (strip[r] != 0 && row[r] >= least_strips) doubtful[r] = 1;
    }
    for (std::int32_t& r : state.region) {
        if (r >= 0 && doubtful[static_cast<std::size_t>(r)] != 0) r = -1;
    }
    separate_parts(scene, state);
}

}  // namespace quadseg::exact
