#include "exact/quadric_hypothesis.h"

#include "exact/hypothesis.h"
#include "surface/constrained_fit.h"
#include "surface/quadric_refine.h"

#include <algorithm>
#include <cmath>

namespace quadseg::exact {

namespace {

constexpr std::size_t disc_facets = 40, least_points = 20, least_grown_faces = 40;
constexpr double most_gap = 0.3;

/// Largest distance of nine tenths of the points to the quadric, to first order.
double sampson_q90(const quadric::Coefficients& c, const surface::LocalPoints& points) {
    std::vector<double> distances;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double steep = norm(quadric::gradient(c, points.point(i)));
        distances.push_back(steep > 0 ? std::abs(quadric::value(c, points.point(i))) / steep : 1);
    }
    const auto q90 = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() * 9 / 10);
    std::nth_element(distances.begin(), q90, distances.end());
    return *q90 * points.extent;
}

/// One cheap refinement from the linear fit: all that most free-form discs get.
bool is_quadric(const surface::PointSet& disc, double tolerance, quadric::Coefficients& c) {
    surface::LocalPoints local(disc);
    if (!local.usable()) return false;
    surface::QuadricFrame frame{{}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {}};
    surface::FitOptions quick;
    quick.iterations = 8;
    quick.minimum_scale = tolerance / 1000;
    if (!surface::start_quadric(surface::QuadricFamily::general, local, frame)) return false;
    if (!surface::refine_quadric(surface::QuadricFamily::general, local, frame, quick, c)) return false;
    if (sampson_q90(c, local) > tolerance) return false;
    c = quadric::from_local(c, local.centre, 1 / local.extent);
    return true;
}

}  // namespace

std::optional<Candidate> find_quadric(const Scene& scene, std::uint32_t seed,
                                      const std::function<bool(std::uint32_t)>& usable, Marks& marks) {
    const Patch patch = collect_patch(scene, seed, disc_facets, {}, usable, marks);
    const PatchPoints p = patch_points(scene, patch.faces, marks);
    if (p.points.size() < least_points) return std::nullopt;
    const surface::PointSet disc{p.points, p.face_normals, {}};
    quadric::Coefficients c;
    if (!is_quadric(disc, scene.tolerances.fit, c)) return std::nullopt;
    const surface::SurfaceFit fit = surface::fit_type(SurfaceType::quadric, disc, c, {});
    if (!fit.ok || fit.surface.type <= SurfaceType::torus || !(fit.q90 <= scene.tolerances.fit)) return std::nullopt;
    Candidate candidate = grow(scene, fit.surface, patch.faces, largest_facet_turn, marks);
    if (candidate.faces.size() < least_grown_faces || candidate.gap > most_gap) return std::nullopt;
    if (!at_precision(scene, candidate)) return std::nullopt;
    return candidate;
}

}  // namespace quadseg::exact
