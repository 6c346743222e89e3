#include "exact/hypothesis.h"

#include "exact/face_fit.h"
#include "surface/fit.h"
#include "surface/jets.h"
#include "surface/torus_family.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <queue>

namespace quadseg::exact {

namespace {

/// A patch that a surface explains has parts that it explains too: the first size decides whether the large one is
/// worth a try, the smaller ones are for faces that are narrow.
struct PatchSizes {
    std::size_t gate, large;
    std::array<std::size_t, 2> small;
};
constexpr PatchSizes disc_sizes{16, 40, {8, 4}}, row_sizes{8, 24, {5, 3}};
constexpr std::array types{SurfaceType::plane, SurfaceType::cylinder, SurfaceType::sphere, SurfaceType::cone,
                           SurfaceType::torus};
// With fewer points a torus says little, and asking costs as much as fitting.
constexpr std::size_t enough_for_torus = 16;
constexpr double most_gap = 0.3;
constexpr double hopeless = 1e300;
/// In tolerances, of least squares through few points, nine tenths of which lie on the surface.
constexpr double most_rms = 4;

/// A triangle at least three times as long as high.
bool is_long(const Scene& scene, std::uint32_t f) {
    const double height = static_cast<double>(scene.heights[f]);
    return 2 * scene.mesh.areas[f] > 3 * height * height;
}

constexpr double octagon = 46 * std::numbers::pi / 180, dodecagon = 31 * std::numbers::pi / 180;

/// Where an edge between two facets ends, others may fold sharper than those of an octagon: a prism's edges, which go
/// on as those of its pointed end.
bool ends_at_sharper_folds(const Scene& scene, std::uint32_t f, int k) {
    const mesh::WorkMesh& mesh = scene.mesh;
    const auto facet_of = [&](std::uint32_t face) { return scene.facets.of_face[face]; };
    const std::int32_t a = facet_of(f);
    const std::int32_t b = facet_of(static_cast<std::uint32_t>(mesh.neighbors[f][static_cast<std::size_t>(k)]));
    constexpr int most_faces = 64;  // around a vertex: a fan of more is no prism's
    for (const std::uint32_t v :
         {mesh.faces[f][static_cast<std::size_t>(k)], mesh.faces[f][static_cast<std::size_t>((k + 1) % 3)]}) {
        std::uint32_t face = f;
        for (int step = 0; step < most_faces; ++step) {
            // Edge j leads to vertex v, edge j + 1 away from it: from face to face around v.
            std::size_t j = 0;
            while (j < 3 && mesh.faces[face][(j + 1) % 3] != v) ++j;
            if (j == 3) break;
            const std::int32_t next = mesh.neighbors[face][(j + 1) % 3];
            if (next < 0 || static_cast<std::uint32_t>(next) == f) break;
            const auto g = static_cast<std::uint32_t>(next);
            const bool beside = facet_of(face) == a || facet_of(face) == b || facet_of(g) == a || facet_of(g) == b;
            if (!beside && dihedral(mesh, face, g) > octagon) return true;
            face = g;
        }
    }
    return false;
}

/// Facets of one size that fold by no more than those of an octagon: a row of them may be a cylinder of eight facets.
bool folds_alike(const Scene& scene, std::uint32_t f, int k) {
    const std::int32_t g = scene.mesh.neighbors[f][static_cast<std::size_t>(k)];
    if (g < 0) return false;
    const double fold = dihedral(scene.mesh, f, static_cast<std::size_t>(g));
    if (fold > octagon) return false;
    const double a = scene.facets.facet[static_cast<std::size_t>(scene.facets.of_face[f])].area;
    const double b =
        scene.facets.facet[static_cast<std::size_t>(scene.facets.of_face[static_cast<std::size_t>(g)])].area;
    return std::max(a, b) <= 1.1 * std::min(a, b) && !(fold > dodecagon && ends_at_sharper_folds(scene, f, k));
}

Vec3 facet_centre(const Scene& scene, std::size_t facet) {
    Vec3 sum;
    double area = 0;
    for (std::size_t j = scene.facets.begin[facet]; j < scene.facets.begin[facet + 1]; ++j) {
        const std::uint32_t f = scene.facets.face[j];
        sum += scene.mesh.centroid(f) * scene.mesh.areas[f];
        area += scene.mesh.areas[f];
    }
    return area > 0 ? sum / area : scene.mesh.centroid(scene.facets.face[scene.facets.begin[facet]]);
}

/// Rows through a seed: over rungs parallel to the longest outer edge of its facet, or to the outer edge most across
/// that, both ways.
std::vector<PatchShape> rows_through(const Scene& scene, std::uint32_t seed) {
    const std::int32_t id = scene.facets.of_face[seed];
    const auto facet = static_cast<std::size_t>(id);
    std::vector<Vec3> edges;
    for (std::size_t j = scene.facets.begin[facet]; j < scene.facets.begin[facet + 1]; ++j) {
        const std::uint32_t f = scene.facets.face[j];
        for (int k = 0; k < 3; ++k) {
            const std::int32_t g = scene.mesh.neighbors[f][static_cast<std::size_t>(k)];
            if (g >= 0 && scene.facets.of_face[static_cast<std::size_t>(g)] == id) continue;
            edges.push_back(scene.mesh.corner(f, (k + 1) % 3) - scene.mesh.corner(f, k));
        }
    }
    const auto longer = [](const Vec3& a, const Vec3& b) { return squared_norm(a) < squared_norm(b); };
    const Vec3 longest = normalized(*std::max_element(edges.begin(), edges.end(), longer));
    const auto more_across = [&](const Vec3& a, const Vec3& b) {
        return std::abs(dot(longest, normalized(a))) > std::abs(dot(longest, normalized(b)));
    };
    const Vec3 across = normalized(*std::max_element(edges.begin(), edges.end(), more_across));
    const Vec3 normal = scene.facets.facet[facet].normal;
    std::vector<PatchShape> rows;
    for (const Vec3& rung : {longest, across}) {
        const Vec3 forward = normalized(cross(rung, normal));
        rows.push_back({rung, forward});
        rows.push_back({rung, -forward});
    }
    return rows;
}

/// Vertices lie on the surface, except that those on trim curves may be off (PROTOTYPE: by 1e-6 to 2e-5 of the
/// diagonal).
bool holds(const Scene& scene, const surface::SurfaceFit& fit, const surface::PointSet& points, double tolerance) {
    if (!fit.ok) return false;
    const auto dof = static_cast<std::size_t>(surface::degrees_of_freedom(fit.surface.type));
    const std::size_t n = points.points.size();
    if (fit.q90 <= tolerance && n >= dof + 3) return true;
    if (!(fit.median <= tolerance / 2 && fit.q97 <= scene.tolerances.trim)) return false;
    std::size_t within = 0;
    for (const Vec3& p : points.points) {
        if (std::abs(surface::signed_distance(fit.surface, p)) <= tolerance) ++within;
    }
    return within >= 2 * dof + 2;
}

/// Vertices alone cannot decide: two rims always lie on a sphere, a cone and a torus. Smaller is better.
double misfit(const Scene& scene, const Surface& s, std::span<const std::uint32_t> faces, double tolerance) {
    const FaceFitter fitter(scene, s);
    const surface::SurfaceEvaluator evaluate(s);
    double normals = 0, midpoints = 0;
    std::size_t counted = 0, edges = 0, exact_edges = 0, turned = 0;
    for (const std::uint32_t f : faces) {
        if (!(scene.mesh.areas[f] > 0)) continue;
        const FaceFit fit = fitter(f);
        if (!(fit.angle <= fit.allowed)) {
            ++turned;
            continue;
        }
        normals += fit.angle * fit.angle;
        ++counted;
        for (int k = 0; k < 3; ++k) {
            const Vec3 a = scene.mesh.corner(f, k), b = scene.mesh.corner(f, (k + 1) % 3);
            const double length = norm(b - a);
            if (!(length > 0)) continue;
            const double d = std::abs(evaluate.distance((a + b) / 2.0));
            midpoints += 16 * d * d / (length * length);
            ++edges;
            if (d <= tolerance) ++exact_edges;
        }
    }
    if (counted == 0 || edges == 0 || 5 * turned > faces.size()) return hopeless;
    double cost = normals / static_cast<double>(counted) + midpoints / static_cast<double>(edges) + 1e-7;
    switch (s.type) {
        case SurfaceType::sphere:
            cost *= 1.05;
            break;
        case SurfaceType::cone:
            cost *= 1.02;
            break;
        case SurfaceType::torus:
            cost *= 1.15;
            break;
        default:
            break;
    }
    // Rulings: edges that lie on the surface with their midpoints.
    const bool ruled = s.type == SurfaceType::cylinder || s.type == SurfaceType::cone;
    if (ruled && 100 * exact_edges > 15 * edges) cost *= 0.5;
    return cost;
}

/// Robust, and of less than so many points nearly all must lie on the surface: then least squares tells, in a few
/// steps, where there is none. Robust fits dwell there, as half of the points always lie on some torus.
surface::SurfaceFit fit_patch(SurfaceType type, const surface::PointSet& points, const surface::FitOptions& options) {
    const auto freedom = static_cast<std::size_t>(surface::degrees_of_freedom(type));
    const bool from_points = type == SurfaceType::plane || type == SurfaceType::sphere;
    if (from_points || points.points.size() >= 2 * freedom + 2) return surface::fit(type, points, options);
    surface::FitOptions least_squares = options;
    least_squares.robust = false;
    least_squares.wanted = least_squares.hopeless = 0;
    least_squares.most_rms = most_rms * options.wanted;
    const surface::SurfaceFit start = surface::fit(type, points, least_squares);
    return start.ok ? surface::refine(start.surface, points, options) : start;
}

/// One question instead of four.
bool may_be_curved(const Scene& scene, const PatchPoints& p, double tolerance, bool coarse,
                   const surface::FitOptions& options) {
    if (p.points.size() < enough_for_torus || p.jet_normals.empty()) return true;
    const std::span<const Vec3> more = coarse ? std::span<const Vec3>(p.face_normals) : std::span<const Vec3>();
    return surface::may_lie_on_torus({p.points, p.jet_normals, {}}, more, {tolerance, scene.tolerances.trim}, options);
}

}  // namespace

bool at_precision(const Scene& scene, const Candidate& candidate) {
    return candidate.median <= std::max(10 * scene.tolerances.precision, 1e-9 * scene.tolerances.diagonal);
}

PatchPoints patch_points(const Scene& scene, std::span<const std::uint32_t> faces, Marks& marks) {
    PatchPoints p;
    marks.clear();
    Vec3 mean;
    for (const std::uint32_t f : faces) {
        mean += scene.mesh.normals[f] * scene.mesh.areas[f];
        for (const std::uint32_t v : scene.mesh.faces[f]) {
            if (marks.mark_vertex(v)) p.vertices.push_back(v);
        }
    }
    std::vector<std::uint32_t> sorted = p.vertices;
    std::sort(sorted.begin(), sorted.end());
    std::vector<Vec3> normals(sorted.size());
    for (const std::uint32_t f : faces) {
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t v = scene.mesh.faces[f][static_cast<std::size_t>(k)];
            const auto i = static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), v) - sorted.begin());
            const Vec3 a = scene.mesh.corner(f, (k + 1) % 3) - scene.mesh.corner(f, k);
            const Vec3 b = scene.mesh.corner(f, (k + 2) % 3) - scene.mesh.corner(f, k);
            normals[i] += scene.mesh.normals[f] * angle_between(a, b);
        }
    }
    p.vertices = std::move(sorted);
    for (const std::uint32_t v : p.vertices) p.points.push_back(scene.mesh.positions[v]);
    for (const Vec3& n : normals) p.face_normals.push_back(normalized(n));
    if (p.points.size() >= 9) p.jet_normals = surface::patch_normals(p.points, normalized(mean));
    return p;
}

Patch collect_patch(const Scene& scene, std::uint32_t seed, std::size_t facets, const PatchShape& shape,
                    const std::function<bool(std::uint32_t)>& usable, Marks& marks) {
    struct Step {
        double key;
        std::size_t sequence;
        std::uint32_t face;
        bool operator<(const Step& b) const { return key != b.key ? key > b.key : sequence > b.sequence; }
    };
    marks.prepare(scene.mesh.face_count(), scene.mesh.vertex_count());
    marks.clear();
    Patch patch;
    std::priority_queue<Step> queue;
    std::size_t sequence = 0;
    queue.push({0, sequence++, seed});
    const std::int32_t seed_facet = scene.facets.of_face[seed];
    const bool row = squared_norm(shape.rung) > 0;
    const Vec3 start = facet_centre(scene, static_cast<std::size_t>(seed_facet));
    std::vector<std::int32_t> taken;
    while (!queue.empty() && taken.size() < facets) {
        const std::uint32_t next = queue.top().face;
        queue.pop();
        const std::int32_t id = scene.facets.of_face[next];
        if (!marks.mark_face(next) || std::find(taken.begin(), taken.end(), id) != taken.end()) continue;
        taken.push_back(id);
        const auto facet = static_cast<std::size_t>(id);
        const std::size_t first = patch.faces.size();
        for (std::size_t j = scene.facets.begin[facet]; j < scene.facets.begin[facet + 1]; ++j) {
            if (usable(scene.facets.face[j])) patch.faces.push_back(scene.facets.face[j]);
        }
        patch.facet_end.push_back(patch.faces.size());
        for (std::size_t j = first; j < patch.faces.size(); ++j) {
            const std::uint32_t f = patch.faces[j];
            for (int k = 0; k < 3; ++k) {
                if (scene.is_crease(f, k) && !(row && folds_alike(scene, f, k))) continue;
                const auto g = static_cast<std::uint32_t>(scene.mesh.neighbors[f][static_cast<std::size_t>(k)]);
                if (scene.in_sure_plane(g) || scene.facets.of_face[g] == id || marks.has_face(g) || !usable(g))
                    continue;
                double key = 0;
                if (row) {
                    // A step back beyond half a facet is the other way.
                    const Vec3 a = scene.mesh.corner(f, k), b = scene.mesh.corner(f, (k + 1) % 3);
                    if (scene.facets.of_face[f] == seed_facet && dot((a + b) / 2.0 - start, shape.forward) < 0)
                        continue;
                    key = 1 - std::abs(dot(shape.rung, normalized(b - a)));
                }
                queue.push({key, sequence++, g});
            }
        }
    }
    return patch;
}

std::optional<Surface> explain(const Scene& scene, std::span<const std::uint32_t> faces, double tolerance, bool coarse,
                               Marks& marks) {
    const PatchPoints p = patch_points(scene, faces, marks);
    std::optional<Surface> best;
    double best_cost = 0;
    surface::FitOptions options;
    options.iterations = 20;
    options.minimum_scale = tolerance / 1000;
    options.hopeless = std::min(1000 * tolerance, std::max(30 * tolerance, scene.tolerances.trim));
    options.wanted = tolerance;
    for (const SurfaceType type : types) {
        if (p.points.size() < static_cast<std::size_t>(surface::degrees_of_freedom(type)) + 3) continue;
        // Most of what is no plane lies on none of the other types either. Planes fit at little cost, whatever lies
        // off.
        if (type == types[1] && !best && !may_be_curved(scene, p, tolerance, coarse, options)) return std::nullopt;
        for (const std::vector<Vec3>* normals : {&p.jet_normals, &p.face_normals}) {
            if (normals->empty()) continue;
            // Height fields over the mean plane are poor only where facets turn far; planes and spheres start from
            // points.
            const bool from_points = type == SurfaceType::plane || type == SurfaceType::sphere;
            if (normals == &p.face_normals && !p.jet_normals.empty() && (!coarse || from_points)) break;
            const surface::PointSet points{p.points, *normals, {}};
            const surface::SurfaceFit fit = fit_patch(type, points, options);
            if (!holds(scene, fit, points, tolerance)) continue;
            const double cost = misfit(scene, fit.surface, faces, tolerance);
            if (cost < hopeless && (!best || cost < best_cost)) {
                best = fit.surface;
                best_cost = cost;
            }
            break;
        }
    }
    return best;
}

Finding find_surface(const Scene& scene, std::uint32_t seed, const SearchOptions& options, Explanations& explanations,
                     const std::function<bool(std::uint32_t)>& usable, Marks& marks) {
    Finding finding;
    // Well-shaped triangles come from dense meshes, on which breadth is right and a failure means free-form.
    const bool strips =
        scene.facets.size(static_cast<std::size_t>(scene.facets.of_face[seed])) > 1 || is_long(scene, seed);
    const auto try_patch = [&](const PatchShape& shape, const PatchSizes& sizes) -> std::optional<Candidate> {
        const Patch patch = collect_patch(scene, seed, sizes.large, shape, usable, marks);
        const std::size_t available = patch.facet_end.size();
        if (available < 2) return std::nullopt;
        const auto explained_part = [&](std::size_t facets) {
            return explanations.of(std::span(patch.faces).first(patch.facet_end[facets - 1]), strips, marks);
        };
        const auto grown = [&](const Surface& surface, std::size_t facets) -> std::optional<Candidate> {
            Candidate candidate = grow(scene, surface, patch.up_to(facets), options.most_step, marks);
            if (candidate.faces.size() * 2 < patch.facet_end[facets - 1]) return std::nullopt;
            if (candidate.gap > most_gap && !at_precision(scene, candidate)) {
                if (candidate.faces.size() > finding.refused.size()) finding.refused = std::move(candidate.faces);
                return std::nullopt;
            }
            return candidate;
        };
        const std::size_t gate = std::min(sizes.gate, available);
        if (const std::optional<Surface> surface = explained_part(gate)) {
            const std::size_t large = std::min(sizes.large, available);
            if (large > gate) {
                if (const std::optional<Surface> larger = explained_part(large)) {
                    if (std::optional<Candidate> found = grown(*larger, large)) return found;
                }
            }
            if (std::optional<Candidate> found = grown(*surface, gate)) return found;
        }
        for (const std::size_t size : sizes.small) {
            if (size >= gate) continue;
            if (const std::optional<Surface> surface = explained_part(size)) {
                if (std::optional<Candidate> found = grown(*surface, size)) return found;
            }
        }
        return std::nullopt;
    };
    if (!options.rows_only) finding.candidate = try_patch({}, disc_sizes);
    if (finding.candidate || !strips) return finding;
    for (const PatchShape& row : rows_through(scene, seed)) {
        finding.candidate = try_patch(row, row_sizes);
        if (finding.candidate) break;
    }
    return finding;
}

}  // namespace quadseg::exact
