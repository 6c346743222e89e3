#include "exact/release.h"

#include "exact/hypothesis.h"
#include "math/symmetric3.h"
#include "mesh/group_sums.h"
#include "runtime/parallel.h"
#include "surface/fit.h"

#include <algorithm>
#include <atomic>
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
/// … but a plane through so many vertices, all on its outline and not on two lines: no tessellation of a curved surface
/// has such facets.
constexpr std::size_t believable_outline = 12;
/// In the end, when all searches are over: a good part of the border, and fewer facets than this. Planes go on over
/// gentler folds.
constexpr double good_part = 0.4, smooth_most = 10 * std::numbers::pi / 180;
constexpr std::size_t believable_in_the_end = 32;
/// Through so many vertices a plane is no accident where it is exact, and none at all where it is not and goes on
/// smoothly along this part of the border: free-form faces have flat places.
constexpr std::size_t telling_vertices = 5;
constexpr double some_part = 0.2;

struct RegionBorder {
    double perimeter = 0;
    double to_strips = 0;  ///< gentle fold to a planar region
    double to_free = 0;    ///< smooth or gentle to a free face
    double smoothly_to_free = 0;
    std::size_t facets = 0;
    double area = 0;
};

/// Strips of one tessellation are alike; a bevel beside a face is not.
bool alike(double area_a, double area_b) {
    return std::max(area_a, area_b) <= 2.5 * std::min(area_a, area_b);
}

std::vector<RegionBorder> measure_borders(const Scene& scene, const Explained& state) {
    std::vector<RegionBorder> borders(state.surface.size());
    constexpr std::size_t block = 16384;
    runtime::parallel_blocks(scene.facets.count(), block, [&](std::size_t begin, std::size_t end) {
        scene.control.check();
        std::vector<std::int32_t> regions;
        for (std::size_t facet = begin; facet < end; ++facet) {
            regions.clear();
            for (std::size_t j = scene.facets.begin[facet]; j < scene.facets.begin[facet + 1]; ++j) {
                const std::int32_t r = state.region[scene.facets.face[j]];
                if (r >= 0 && (regions.empty() || regions.back() != r)) regions.push_back(r);
            }
            std::sort(regions.begin(), regions.end());
            regions.erase(std::unique(regions.begin(), regions.end()), regions.end());
            for (const std::int32_t r : regions)
                std::atomic_ref(borders[static_cast<std::size_t>(r)].facets).fetch_add(1, std::memory_order_relaxed);
        }
    });
    // Found by all threads, summed in their order.
    struct Edge {
        std::uint32_t face;
        int k;
    };
    const auto find_edges = [&](std::size_t begin, std::size_t end, std::vector<Edge>& edges) {
        scene.control.check();
        for (std::size_t f = begin; f < end; ++f) {
            if (state.region[f] < 0) continue;
            for (int k = 0; k < 3; ++k) {
                const std::int32_t g = scene.mesh.neighbors[f][static_cast<std::size_t>(k)];
                if (g < 0 || state.region[static_cast<std::size_t>(g)] != state.region[f])
                    edges.push_back({static_cast<std::uint32_t>(f), k});
            }
        }
    };
    std::vector<double> area(borders.size(), 0);
    mesh::add_by_group(state.region, scene.mesh.areas, area);
    for (std::size_t r = 0; r < borders.size(); ++r) borders[r].area = area[r];
    std::size_t polls = 0;
    for (const auto& [f, k] : runtime::collect_blocks<Edge>(state.region.size(), block, find_edges)) {
        scene.control.check_often(polls);
        RegionBorder& border = borders[static_cast<std::size_t>(state.region[f])];
        const std::int32_t g = scene.mesh.neighbors[f][static_cast<std::size_t>(k)];
        const double length = norm(scene.mesh.corner(f, (k + 1) % 3) - scene.mesh.corner(f, k));
        border.perimeter += length;
        if (g < 0) continue;
        const double fold = dihedral(scene.mesh, f, static_cast<std::size_t>(g));
        if (fold > gentle_most) continue;
        const std::int32_t other = state.region[static_cast<std::size_t>(g)];
        if (other < 0) {
            border.to_free += length;
            if (fold <= smooth_most) border.smoothly_to_free += length;
        } else if (fold > gentle_least && state.surface[static_cast<std::size_t>(other)].type == SurfaceType::plane) {
            border.to_strips += length;
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

enum class PlaneEvidence : std::uint8_t { unquestioned, few_vertices, inexact };

/// Of planes that go on smoothly into free faces along some part of their border.
std::vector<PlaneEvidence> judge_planes(const Scene& scene, double noise, const std::vector<RegionBorder>& borders,
                                        const Explained& state) {
    std::vector<std::vector<std::uint32_t>> faces(borders.size());
    for (std::size_t f = 0; f < state.region.size(); ++f) {
        if (state.region[f] < 0) continue;
        const auto r = static_cast<std::size_t>(state.region[f]);
        if (state.surface[r].type == SurfaceType::plane &&
            borders[r].smoothly_to_free >= some_part * borders[r].perimeter) {
            faces[r].push_back(static_cast<std::uint32_t>(f));
        }
    }
    const double exact = std::max({10 * noise, 3 * scene.tolerances.precision, 1e-10 * scene.tolerances.diagonal});
    std::vector<PlaneEvidence> evidence(borders.size(), PlaneEvidence::unquestioned);
    Marks marks;
    marks.prepare(scene.mesh.face_count(), scene.mesh.vertex_count());
    for (std::size_t r = 0; r < faces.size(); ++r) {
        if (faces[r].empty()) continue;
        scene.control.check();
        const PatchPoints p = patch_points(scene, faces[r], marks);
        if (p.points.size() < telling_vertices) {
            evidence[r] = PlaneEvidence::few_vertices;
            continue;
        }
        const surface::SurfaceFit fit = surface::fit(SurfaceType::plane, {p.points, {}, {}});
        if (!fit.ok || !(fit.median <= exact)) evidence[r] = PlaneEvidence::inexact;
    }
    return evidence;
}

/// Regions are no longer doubtful that are planes of many corners rather than facets.
void trust_polygons(const Scene& scene, const Explained& state, std::vector<std::uint8_t>& doubtful) {
    std::vector<std::uint8_t> asked(doubtful.size(), 0);
    bool any = false;
    for (std::size_t r = 0; r < asked.size(); ++r) {
        asked[r] = doubtful[r] != 0 && state.surface[r].type == SurfaceType::plane ? 1 : 0;
        any = any || asked[r] != 0;
    }
    if (!any) return;
    std::vector<std::uint8_t> sure(asked.size(), 0);
    std::vector<std::vector<std::uint32_t>> vertices(asked.size()), outline(asked.size());
    std::size_t polls = 0;
    for (std::size_t f = 0; f < state.region.size(); ++f) {
        scene.control.check_often(polls);
        if (state.region[f] < 0 || asked[static_cast<std::size_t>(state.region[f])] == 0) continue;
        const auto r = static_cast<std::size_t>(state.region[f]);
        if (scene.in_sure_plane(f)) sure[r] = 1;
        for (std::size_t k = 0; k < 3; ++k) {
            vertices[r].push_back(scene.mesh.faces[f][k]);
            const std::int32_t g = scene.mesh.neighbors[f][k];
            if (g >= 0 && state.region[static_cast<std::size_t>(g)] == state.region[f]) continue;
            outline[r].push_back(scene.mesh.faces[f][k]);
            outline[r].push_back(scene.mesh.faces[f][(k + 1) % 3]);
        }
    }
    const auto count = [](std::vector<std::uint32_t>& list) {
        std::sort(list.begin(), list.end());
        return static_cast<std::size_t>(std::unique(list.begin(), list.end()) - list.begin());
    };
    for (std::size_t r = 0; r < asked.size(); ++r) {
        if (sure[r] == 0) continue;
        const std::size_t corners = count(outline[r]);
        if (corners >= believable_outline && corners == count(vertices[r])) doubtful[r] = 0;
    }
}

/// A triangle that is all of its plane is evidence of none where the mesh goes on gently, over a free face or another
/// such triangle.
void release_lone_triangles(const Scene& scene, Explained& state) {
    std::vector<std::uint32_t> faces(state.surface.size(), 0);
    for (const std::int32_t r : state.region) {
        if (r >= 0) ++faces[static_cast<std::size_t>(r)];
    }
    const auto is_lone = [&](std::int32_t r) {
        return r >= 0 && faces[static_cast<std::size_t>(r)] == 1 &&
               state.surface[static_cast<std::size_t>(r)].type == SurfaceType::plane;
    };
    std::vector<std::uint32_t> released;
    std::size_t polls = 0;
    for (std::size_t f = 0; f < state.region.size(); ++f) {
        scene.control.check_often(polls);
        if (!is_lone(state.region[f])) continue;
        const auto goes_on = [&](std::int32_t g) {
            if (g < 0) return false;
            const std::int32_t other = state.region[static_cast<std::size_t>(g)];
            return (other < 0 || is_lone(other)) && dihedral(scene.mesh, f, static_cast<std::size_t>(g)) <= gentle_most;
        };
        const auto& neighbors = scene.mesh.neighbors[f];
        if (std::any_of(neighbors.begin(), neighbors.end(), goes_on)) released.push_back(static_cast<std::uint32_t>(f));
    }
    for (const std::uint32_t f : released) state.region[f] = -1;
}

}  // namespace

void release_extruded(const Scene& scene, Explained& state) {
    std::vector<Symmetric3> spread(state.surface.size());
    std::vector<double> area(state.surface.size(), 0);
    for (std::size_t f = 0; f < state.region.size(); ++f) {
        if (state.region[f] < 0) continue;
        const auto r = static_cast<std::size_t>(state.region[f]);
        if (may_be_extruded(state.surface[r].type)) continue;
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
    trust_polygons(scene, state, doubtful);
    const std::vector<std::size_t> row = row_sizes(scene, state, borders, strip);
    for (std::size_t r = 0; r < borders.size(); ++r) {
        if (strip[r] != 0 && row[r] >= least_strips) doubtful[r] = 1;
    }
    for (std::int32_t& r : state.region) {
        if (r >= 0 && doubtful[static_cast<std::size_t>(r)] != 0) r = -1;
    }
    separate_parts(scene, state);
}

void release_crumbs(const Scene& scene, double noise, Explained& state) {
    if (std::find(state.region.begin(), state.region.end(), -1) == state.region.end()) {
        release_lone_triangles(scene, state);
        return;
    }
    const std::vector<RegionBorder> borders = measure_borders(scene, state);
    const std::vector<PlaneEvidence> evidence = judge_planes(scene, noise, borders, state);
    for (std::int32_t& r : state.region) {
        if (r < 0) continue;
        const auto region = static_cast<std::size_t>(r);
        const RegionBorder& b = borders[region];
        bool crumb = false;
        if (state.surface[region].type != SurfaceType::plane) {
            crumb = b.to_free >= good_part * b.perimeter && b.facets < believable_in_the_end;
        } else if (evidence[region] == PlaneEvidence::few_vertices) {
            crumb = b.smoothly_to_free >= good_part * b.perimeter;
        } else {
            crumb = evidence[region] == PlaneEvidence::inexact;
        }
        if (crumb) r = -1;
    }
    release_lone_triangles(scene, state);
}

}  // namespace quadseg::exact
