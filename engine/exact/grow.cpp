#include "exact/grow.h"

#include "exact/face_fit.h"
#include "surface/constrained_fit.h"

#include <algorithm>
#include <cmath>

namespace quadseg::exact {

namespace {

constexpr std::size_t fit_sample = 800;
constexpr int most_refits = 6;

double quantile(std::vector<double>& values, double share) {
    if (values.empty()) return 0;
    const auto k = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + k, values.end());
    return values[static_cast<std::size_t>(k)];
}

/// PROTOTYPE: a true surface ends in a jump, an accidental one where the distance creeps over the tolerance.
double gap_share(const Scene& scene, const FaceFitter& fitter, const Candidate& candidate, const Marks& in_region) {
    double border = 0, creeping = 0;
    for (const std::uint32_t f : candidate.faces) {
        for (int k = 0; k < 3; ++k) {
            const std::int32_t g = scene.mesh.neighbors[f][static_cast<std::size_t>(k)];
            if (g >= 0 && in_region.has_face(static_cast<std::size_t>(g))) continue;
            const double length = norm(scene.mesh.corner(f, (k + 1) % 3) - scene.mesh.corner(f, k));
            border += length;
            if (g < 0) continue;
            const FaceFit fit = fitter(static_cast<std::size_t>(g));
            if (fit.distance > scene.tolerances.trim && fit.distance <= scene.tolerances.gap &&
                fit.angle <= fit.allowed) {
                creeping += length;
            }
        }
    }
    return border > 0 ? creeping / border : 0;
}

surface::SurfaceFit refitted(const Surface& surface, std::span<const Vec3> points) {
    const surface::PointSet set{points, {}, {}};
    if (surface.type <= SurfaceType::torus) return surface::refine(surface, set);
    surface::SurfaceFit fit = surface::fit_type(SurfaceType::quadric, set, surface.coefficients);
    fit.ok = fit.ok && fit.surface.type > SurfaceType::torus && !points.empty();
    if (fit.ok && dot(surface::normal_at(fit.surface, points[0]), surface::normal_at(surface, points[0])) < 0) {
        for (double& c : fit.surface.coefficients) c = -c;
    }
    return fit;
}

}  // namespace

std::vector<std::uint32_t> reach(const Scene& scene, const Surface& surface, std::span<const std::uint32_t> start,
                                 double largest_turn, Marks& marks) {
    const FaceFitter fitter(scene, surface, largest_turn);
    const double tolerance = scene.tolerances.trim;
    const bool plane = surface.type == SurfaceType::plane;
    marks.prepare(scene.mesh.face_count(), scene.mesh.vertex_count());
    marks.clear();
    std::vector<std::uint32_t> faces;
    for (const std::uint32_t f : start) {
        if (marks.mark_face(f) && fitter.accepts(f, tolerance)) faces.push_back(f);
    }
    std::size_t polls = 0;
    for (std::size_t i = 0; i < faces.size(); ++i) {
        scene.control.check_often(polls);
        for (const std::int32_t g : scene.mesh.neighbors[faces[i]]) {
            if (g < 0 || !marks.mark_face(static_cast<std::size_t>(g))) continue;
            if (!plane && scene.in_sure_plane(static_cast<std::size_t>(g))) continue;
            if (fitter.accepts(static_cast<std::size_t>(g), tolerance)) faces.push_back(static_cast<std::uint32_t>(g));
        }
    }
    return faces;
}

std::vector<Vec3> vertices_of(const Scene& scene, std::span<const std::uint32_t> faces, std::size_t most,
                              Marks& marks) {
    marks.prepare(scene.mesh.face_count(), scene.mesh.vertex_count());
    marks.clear();
    std::vector<Vec3> points;
    const std::size_t stride = std::max<std::size_t>(1, faces.size() / (2 * most));
    for (std::size_t i = 0; i < faces.size(); i += stride) {
        for (const std::uint32_t v : scene.mesh.faces[faces[i]]) {
            if (marks.mark_vertex(v)) points.push_back(scene.mesh.positions[v]);
        }
    }
    return points;
}

double typical_step(std::vector<std::pair<double, double>> steps) {
    double total = 0, below = 0;
    for (const auto& [step, area] : steps) total += area;
    std::sort(steps.begin(), steps.end());
    for (const auto& [step, area] : steps) {
        below += area;
        if (below >= 0.75 * total) return step;
    }
    return steps.empty() ? 0 : steps.back().first;
}

void measure_candidate(const Scene& scene, Candidate& candidate, Marks& marks) {
    const FaceFitter fitter(scene, candidate.surface);
    std::vector<double> distances;
    for (const Vec3& p : vertices_of(scene, candidate.faces, 2 * fit_sample, marks)) {
        distances.push_back(std::abs(surface::signed_distance(candidate.surface, p)));
    }
    candidate.median = quantile(distances, 0.5);
    marks.clear();
    candidate.area = 0;
    std::vector<std::int32_t> facets;
    for (const std::uint32_t f : candidate.faces) {
        marks.mark_face(f);
        candidate.area += scene.mesh.areas[f];
        facets.push_back(scene.facets.of_face[f]);
    }
    std::sort(facets.begin(), facets.end());
    candidate.facets = static_cast<std::size_t>(std::unique(facets.begin(), facets.end()) - facets.begin());
    candidate.gap = gap_share(scene, fitter, candidate, marks);
    std::vector<std::pair<double, double>> steps;
    const std::size_t stride = std::max<std::size_t>(1, candidate.faces.size() / fit_sample);
    for (std::size_t i = 0; i < candidate.faces.size(); i += stride) {
        steps.emplace_back(fitter(candidate.faces[i]).step, scene.mesh.areas[candidate.faces[i]]);
    }
    candidate.step = typical_step(std::move(steps));
}

Candidate grow(const Scene& scene, const Surface& start, std::span<const std::uint32_t> patch, double largest_turn,
               Marks& marks) {
    Candidate candidate;
    candidate.surface = start;
    candidate.faces = reach(scene, start, patch, largest_turn, marks);
    for (int refit = 0; refit < most_refits; ++refit) {
        const std::vector<Vec3> points = vertices_of(scene, candidate.faces, fit_sample, marks);
        const surface::SurfaceFit fit = refitted(candidate.surface, points);
        if (!fit.ok) break;
        std::vector<std::uint32_t> faces = reach(scene, fit.surface, candidate.faces, largest_turn, marks);
        if (faces.size() < candidate.faces.size() * 9 / 10) break;
        const bool stable = faces.size() == candidate.faces.size();
        candidate.surface = fit.surface;
        candidate.faces = std::move(faces);
        if (stable) break;
    }
    std::sort(candidate.faces.begin(), candidate.faces.end());
    measure_candidate(scene, candidate, marks);
    return candidate;
}

}  // namespace quadseg::exact
