#include "flow/final_surfaces.h"

#include "exact/tolerances.h"
#include "flow/methods.h"
#include "flow/region_sample.h"
#include "flow/rough_planes.h"
#include "runtime/parallel.h"
#include "surface/blend.h"
#include "surface/constrained_fit.h"
#include "surface/evaluate.h"
#include "surface/fit.h"
#include "surface/surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace quadseg::flow {

namespace {

using surface::PointSet;
using surface::SurfaceFit;

constexpr std::size_t choice_points = 64;        ///< types are chosen on so many vertices …
constexpr std::size_t refinement_points = 2000;  ///< … and refined on so many
constexpr std::size_t general_points = 500;      ///< general quadrics, whose distances are dear
constexpr std::size_t fit_faces = 16384;         ///< the default preset's quadric of a region is fitted to so many
// Regions made by energy follow no surface exactly: a few vertices tell the type, a few steps the parameters.
constexpr std::size_t energy_choice_points = 32, energy_refinement_points = 96;
constexpr int choice_steps = 15, energy_choice_steps = 5, energy_refinement_steps = 6;
constexpr int energy_hopeless_after = 3;
/// Half of the values exceed the median, so that it is at most √2 times the RMS.
constexpr double most_median_of_rms = 1.42;
constexpr std::size_t kept_points = 24;
/// RMS distance, in multiples of the better one, up to which a simpler type is not meaningfully worse.
constexpr double equal_ratio = 1.5;
/// The RMS distance of a good surface from noisy vertices is at most this multiple of the noise.
constexpr double noise_margin = 1.5;
/// Where vertices were found exact, what a surface may miss free-form vertices by: the exact stage's second pass.
constexpr double exact_tolerance = 2e-7;
/// By how much vertices on the trim curves of a CAD file may be off, unit frame.
constexpr double trim_error = 2e-5;
/// The RMS distance of a free-form patch from the surface that names it, in those from its plane: what bends it is that
/// surface; and in the unit frame.
constexpr double nearly_all_bend = 0.01, nearly_exact_distance = 1e-4;
/// And of a plane, in RMS radii of the patch.
constexpr double nearly_flat = 1e-3;
/// Degrees by which the normals of a surface that explains a free-form patch may differ from the mesh's (RMS).
constexpr double free_form_angle = 12;
/// And the RMS distance from it, in RMS radii of the patch, where none is exact.
constexpr double free_form_distance = 0.02;
/// A refined quadric stands for the moments' one where it is so many times nearer to the vertices: then they lie on it,
/// and the moments suffer from the facets' chords (MATH.md §3).
constexpr double exact_quadric_gain = 5;

double normal_deviation(const Surface& s, const PointSet& p) {
    double sum = 0;
    surface::SurfaceEvaluator(s).visit([&](const auto& e) {
        for (std::size_t i = 0; i < p.points.size(); ++i) sum += squared_norm(e.normal(p.points[i]) - p.normals[i]);
    });
    return sum / static_cast<double>(std::max<std::size_t>(p.points.size(), 1));
}

/// Among equals the normals decide, at a price for freedom (PROTOTYPE_TRUTH.md §1.5).
double preference(SurfaceType type) {
    switch (type) {
        case SurfaceType::plane:
        case SurfaceType::cylinder:
            return 1;
        case SurfaceType::cone:
            return 1.02;
        case SurfaceType::sphere:
            return 1.05;
        case SurfaceType::torus:
            return 1.15;
        default:
            return 1.3;
    }
}

bool is_special(SurfaceType type) {
    switch (type) {
        case SurfaceType::elliptic_cylinder:
        case SurfaceType::elliptic_cone:
        case SurfaceType::elliptic_paraboloid:
        case SurfaceType::hyperbolic_paraboloid:
        case SurfaceType::parabolic_cylinder:
        case SurfaceType::hyperbolic_cylinder:
            return true;
        default:
            return false;
    }
}

/// Chooses the type of one region's surface on a small sample.
class TypeChoice {
  public:
    TypeChoice(const PointSet& p, const Surface& start, double floor, bool torus, bool settle_early, int steps)
        : p_(p), start_(start), floor_(floor), torus_(torus), settle_early_(settle_early) {
        options_.iterations = steps;
        if (settle_early) options_.hopeless_after = energy_hopeless_after;
    }

    /// The simplest type that is not meaningfully worse than the best; ok is false where nothing can be fitted.
    SurfaceFit run() {
        consider(surface::fit(SurfaceType::plane, p_, options_));
        if (best_rms() <= floor_) return chosen();
        const SurfaceFit own = surface::measure(start_, p_);
        consider(own);
        // Types that stay far above what is reached already need no more than a few steps.
        for (const SurfaceType type : {SurfaceType::sphere, SurfaceType::cylinder, SurfaceType::cone}) {
            options_.hopeless = (settle_early_ ? 4 : 2) * limit();
            options_.wanted = settle_early_ ? most_median_of_rms * limit() : 0;
            const SurfaceFit fit = surface::fit(type, p_, options_);
            consider(fit);
            // A cylinder with every vertex on it is a cone that needs no angle.
            if (settle_early_ && type == SurfaceType::cylinder && fit.ok && exact_quadric_gain * fit.rms < own.rms)
                break;
        }
        options_.wanted = 0;
        // Where energy made the regions, a simple type that is nearer to the vertices than the quadric settles it.
        if (settle_early_ && best_rms() < own.rms) return chosen();
        options_.hopeless = settle_early_ ? 2 * own.rms / exact_quadric_gain : 2 * limit();
        consider_general(own);
        // A torus is no quadric: it has to be meaningfully better than all of them.
        const double better = std::max(floor_, best_rms() / equal_ratio);
        if (torus_ && best_rms() > floor_) {
            const SurfaceFit fit = torus(better);
            if (fit.rms <= better) consider(fit);
        }
        return chosen();
    }

    /// The same where the general quadric is known to fail: only a torus is left.
    SurfaceFit torus(double tolerance) {
        surface::FitOptions options;  // with time: the start of a torus is a rough one
        options.iterations = options_.iterations;
        options.hopeless = 2 * tolerance;
        return surface::fit(SurfaceType::torus, p_, options);
    }

  private:
    double best_rms() const {
        double best = std::numeric_limits<double>::infinity();
        for (const SurfaceFit& fit : candidates_) best = std::min(best, fit.rms);
        return best;
    }
    double limit() const { return std::max(floor_, equal_ratio * best_rms()); }
    void consider(const SurfaceFit& fit) {
        if (!fit.ok || !std::isfinite(fit.rms)) return;
        // A pair of planes that coincide has every vertex and no normal.
        if (!candidates_.empty() && !(normal_deviation(fit.surface, p_) <= 1)) return;
        candidates_.push_back(fit);
    }

    /// The refinement of the region's own quadric on the vertices, and the member of the family that its eigenvalues
    /// show.
    void consider_general(const SurfaceFit& own) {
        if (p_.points.size() < 10) return;
        const SurfaceFit general = surface::fit_type(SurfaceType::quadric, p_, start_.coefficients, options_);
        const Vec3 near = p_.points[p_.points.size() / 2];
        double radius = 0;
        for (const Vec3& x : p_.points) radius = std::max(radius, norm(x - near));
        // A quadric of no name is a pair of planes or nearly one: no surface of a region (MATH.md §4).
        const bool exact = general.ok && general.rms * exact_quadric_gain < own.rms &&
                           surface::classify(general.surface.coefficients, near, radius).type != SurfaceType::quadric;
        if (exact) consider(general);
        const Surface& shown = exact ? general.surface : start_;
        const SurfaceType family = surface::classify(shown.coefficients, near, radius, 0.02).type;
        if (is_special(family)) consider(surface::fit_type(family, p_, shown.coefficients, options_));
    }

    SurfaceFit chosen() const {
        const double most = limit();
        const SurfaceFit* best = nullptr;
        double best_score = 0;
        for (const SurfaceFit& fit : candidates_) {
            if (!(fit.rms <= most)) continue;
            const double score = (normal_deviation(fit.surface, p_) + 1e-7) * preference(fit.surface.type);
            if (best == nullptr || score < best_score) {
                best = &fit;
                best_score = score;
            }
        }
        return best != nullptr ? *best : SurfaceFit{};
    }

    const PointSet p_;
    const Surface& start_;
    double floor_;
    bool torus_, settle_early_;
    surface::FitOptions options_;
    std::vector<SurfaceFit> candidates_;
};

/// Faces that the surfaces of a stopped call are made of, all regions together; below so many a region, planes.
constexpr std::size_t least_rough_fit = 64, rough_faces = most_rough_fits * least_rough_fit;

class Finisher {
  public:
    Finisher(const FlowInput& input, const partition::RegionFaces& regions, const FlowResult& flow)
        : input_(input),
          mesh_(input.mesh),
          options_(input.options),
          regions_(regions),
          flow_(flow),
          paper_(options_.preset == Preset::paper),
          precision_(input.control.should_stop() ? 0 : exact::coordinate_precision(input.mesh)) {
        if (paper_) {
            policy_ = method_policy(options_);
        } else {
            fit_options_.weight = options_.weight;
            fit_options_.plane_tolerance = 1e-14;
            fit_options_.plane_tolerance_per_area = true;
        }
    }

    FinalSurface run(std::size_t r) const {
        if (input_.control.should_stop()) return roughly(r);
        FinalSurface result;
        const RegionSample sample =
            by_energy(r) ? sample_region(mesh_, flow_.labels, faces(r), regions_.size(r), energy_refinement_points,
                                         energy_choice_points)
                         : sample_region(mesh_, flow_.labels, faces(r), regions_.size(r), refinement_points,
                                         std::numeric_limits<std::size_t>::max(), flow_.on_facets);
        describe(sample, r, result);
        const bool known = r < flow_.surfaces.size() && flow_.surfaces[r].type != SurfaceType::freeform;
        if (known) {
            keep_verified(simplified(flow_.surfaces[r], sample, result.extent, regions_.size(r)), sample, result);
            if (!quadric_of(result.surface, result.centroid, result.quadric)) {
                fit_quadric(r, result);
                result.loop_energy = {};
            }
        } else {
            if (!take_fit(r, result)) fit_quadric(r, result);
            result.loop_proxy = result.quadric;
            choose(r, sample, result);
        }
        set_coefficients(result);
        if (!sample.points.empty())
            result.rms = surface::measure(result.surface, sample.thinned(general_points).all()).rms;
        return result;
    }

  private:
    /// Neither verified on its vertices nor to be judged by a known noise.
    bool by_energy(std::size_t r) const { return is_faceted(r) || (!(flow_.noise > 0) && r >= flow_.surfaces.size()); }
    bool is_faceted(std::size_t r) const { return r < flow_.faceted.size() && flow_.faceted[r] != 0; }

    const std::uint32_t* faces(std::size_t r) const { return regions_.face.data() + regions_.begin[r]; }

    void describe(const RegionSample& sample, std::size_t r, FinalSurface& result) const {
        result.evidence = sample.points.size();
        const RegionSample few = sample.thinned(kept_points);
        result.points = few.points;
        if (sample.points.empty()) {
            if (regions_.size(r) > 0) result.centroid = mesh_.centroid(*faces(r));
            return;
        }
        for (const Vec3& p : sample.points) result.centroid += p;
        result.centroid = result.centroid / static_cast<double>(sample.points.size());
        double sum = 0;
        for (const Vec3& p : sample.points) sum += squared_norm(p - result.centroid);
        result.extent = std::sqrt(sum / static_cast<double>(sample.points.size()));
    }

    /// Where few vertices tell, surfaces of more freedom than needed were verified as well: what is flat is a plane, a
    /// strip between two rims a cone or cylinder when the normals say so, a torus of no visible bend a cylinder.
    Surface simplified(const Surface& verified, const RegionSample& sample, double extent, std::size_t faces) const {
        if (verified.type == SurfaceType::plane || !sample.complete) return verified;
        const PointSet p = sample.all();
        const auto freedom = static_cast<std::size_t>(surface::degrees_of_freedom(verified.type));
        const double tolerance = std::max(exact_tolerance, noise_margin * flow_.noise);
        if (p.points.size() < 2 * freedom + 2) {
            const SurfaceFit plane = surface::fit(SurfaceType::plane, p);
            if (plane.ok && plane.max <= tolerance) return plane.surface;
        }
        // Trim curves bend cylinders: tori of hardly any bend, cones of hardly any opening.
        const bool nearly_cylinder = (verified.type == SurfaceType::torus && verified.radius > 10 * extent) ||
                                     (verified.type == SurfaceType::cone && verified.half_angle < 0.01);
        if (nearly_cylinder && p.points.size() >= 12) {
            const SurfaceFit cylinder = surface::fit(SurfaceType::cylinder, p);
            if (cylinder.ok && cylinder.median <= tolerance && cylinder.q97 <= 2 * trim_error) return cylinder.surface;
        }
        const bool strip = 5 * p.points.size() >= 4 * faces;
        if (!strip || (verified.type != SurfaceType::sphere && verified.type != SurfaceType::torus)) return verified;
        Surface best = verified;
        double best_score = (normal_deviation(verified, p) + 1e-7) * preference(verified.type);
        for (const SurfaceType type : {SurfaceType::cylinder, SurfaceType::cone}) {
            if (p.points.size() < 2 * static_cast<std::size_t>(surface::degrees_of_freedom(type))) continue;
            const SurfaceFit fit = surface::fit(type, p);
            if (!fit.ok || !(fit.q90 <= tolerance)) continue;
            const double score = (normal_deviation(fit.surface, p) + 1e-7) * preference(type);
            if (!(score < best_score)) continue;
            best_score = score;
            best = fit.surface;
        }
        return best;
    }

    void keep_verified(const Surface& verified, const RegionSample& sample, FinalSurface& result) const {
        result.surface = verified;
        if (verified.type > SurfaceType::torus) return;
        const auto freedom = static_cast<std::size_t>(surface::degrees_of_freedom(verified.type));
        if (sample.points.size() < 2 * freedom + 2) return;
        const SurfaceFit before = surface::measure(verified, sample.all());
        const SurfaceFit after = surface::refine(verified, sample.all());
        // Border vertices may be off by far more than the others (trim curves): the middle and the bulk decide.
        if (after.ok && after.median <= before.median && after.q90 <= 1.05 * before.q90) {
            result.surface = after.surface;
            result.surface.outward = verified.outward;
        }
    }

    /// The fit that the flow ended with; the default preset's planes are fitted again, to a tighter tolerance.
    bool take_fit(std::size_t r, FinalSurface& result) const {
        if (r >= flow_.fits.size() || !flow_.fits[r].valid || (!paper_ && flow_.fits[r].proxy.planar())) return false;
        result.quadric = flow_.fits[r].proxy;
        result.loop_energy = flow_.fits[r].energy;
        return true;
    }

    void fit_quadric(std::size_t r, FinalSurface& result) const {
        const std::size_t size = regions_.size(r);
        const std::size_t count = paper_ ? size : std::min(size, fit_faces);
        std::vector<std::uint32_t> chosen(count);
        for (std::size_t i = 0; i < count; ++i) chosen[i] = faces(r)[i * size / count];
        partition::GatheredRegion soup;
        partition::gather(mesh_, chosen.data(), count, soup);
        const quadric::RegionFit fit =
            paper_ ? policy_.fit(soup.soup()) : quadric::fit_region(soup.soup(), fit_options_);
        result.quadric = fit.proxy;
        result.one_sheet = fit.valid || quadric::is_valid(fit.proxy, soup.soup());
        if (!paper_ && count == size) result.loop_energy = fit.energy;
    }

    /// The proxy as a surface without a better name than its eigenvalues give.
    Surface named(const FinalSurface& result) const {
        const double radius = result.extent > 0 ? result.extent : 1;
        // Named in the region's own frame, where nothing cancels.
        Surface s = surface::classify(result.quadric.c, result.centroid - result.quadric.origin, radius);
        s = surface::transformed_back(s, result.quadric.origin, 1);
        s.coefficients = quadric::from_local(result.quadric.c, result.quadric.origin, 1);
        return s;
    }

    void choose(std::size_t r, const RegionSample& sample, FinalSurface& result) const {
        const Surface own = named(result);
        result.surface = own;
        if (paper_ && (options_.method != Method::quadric || result.quadric.planar())) return;
        const bool free_form = !paper_ && !flow_.scan && r < flow_.surfaces.size() && !by_energy(r);
        const RegionSample few = sample.thinned(by_energy(r) ? energy_choice_points : choice_points);
        const double rounding = 1e-12 * result.extent;
        const double floor = std::max({noise_margin * flow_.noise, rounding, 3 * precision_});
        const double tolerance = free_form ? std::max(floor, exact_tolerance) : floor;
        // The noise is known: what is farther off is free-form.
        const bool judged = free_form || (!paper_ && flow_.noise > 0 && !by_energy(r));
        // The paper's proxies are quadrics.
        TypeChoice choice(few.all(), own, floor, !paper_, !paper_ && !free_form,
                          by_energy(r) ? energy_choice_steps : choice_steps);
        const bool general_fails = judged && fails(own, few, 2 * tolerance);
        SurfaceFit fit = general_fails ? choice.torus(tolerance) : choice.run();
        const auto freedom = static_cast<std::size_t>(surface::degrees_of_freedom(fit.surface.type));
        const bool plane = fit.ok && fit.surface.type == SurfaceType::plane;
        // Noise turns the mesh's normals as far from the right surface as from the region's quadric.
        const double turned = judged && !free_form ? normal_deviation(own, few.all()) : 0;
        if (judged && (!fit.ok || !(fit.rms <= 2 * tolerance) ||
                       (!plane && (few.points.size() < 2 * freedom + 2 || wrong_normals(fit.surface, few, turned))))) {
            SurfaceFit trimmed = free_form ? mostly_exact(few, tolerance) : SurfaceFit{};
            if (free_form && !trimmed.ok) trimmed = nearly_exact(few, result.extent);
            if (trimmed.ok) {
                refine_choice(trimmed.surface, sample, own, {}, result);
                (void)quadric_of(result.surface, result.centroid, result.quadric);
            } else {
                describe_free_form(sample, result);
            }
            return;
        }
        surface::FitOptions options;
        if (by_energy(r)) options.iterations = energy_refinement_steps;
        if (fit.ok && by_energy(r) && few.points.size() == sample.points.size()) {
            result.surface = fit.surface;
        } else if (fit.ok) {
            refine_choice(fit.surface, sample, own, options, result);
        }
        if (is_faceted(r) && !explains(result.surface, few, result.extent)) {
            describe_free_form(sample, result);
            return;
        }
        (void)quadric_of(result.surface, result.centroid, result.quadric);
    }

    /// Near enough to be named where no vertex lies on a surface exactly.
    static bool explains(const Surface& s, const RegionSample& sample, double extent) {
        return surface::measure(s, sample.all()).rms <= free_form_distance * extent && !wrong_normals(s, sample);
    }

    /// A typed surface on which half of the vertices lie exactly and the others nearly: trim curves of CAD files are
    /// off by up to 2e-5 of the diagonal (PROTOTYPE_TRUTH.md §1.4).
    SurfaceFit mostly_exact(const RegionSample& few, double tolerance) const {
        SurfaceFit best;
        double best_score = 0;
        for (const SurfaceType type :
             {SurfaceType::plane, SurfaceType::cylinder, SurfaceType::cone, SurfaceType::sphere, SurfaceType::torus}) {
            if (few.points.size() < 2 * static_cast<std::size_t>(surface::degrees_of_freedom(type)) + 2) continue;
            surface::FitOptions options;
            options.hopeless = trim_error;
            const SurfaceFit fit = surface::fit(type, few.all(), options);
            if (!fit.ok || !(fit.median <= tolerance) || !(fit.q97 <= 2 * trim_error)) continue;
            if (wrong_normals(fit.surface, few)) continue;
            const double score = (normal_deviation(fit.surface, few.all()) + 1e-7) * preference(type);
            if (best.ok && !(score < best_score)) continue;
            best = fit;
            best_score = score;
        }
        return best;
    }

    /// A typed surface that accounts for nearly all of the patch's bend, no farther off than what CAD kernels sew
    /// together: an engineer's name for what no vertex verifies.
    SurfaceFit nearly_exact(const RegionSample& few, double extent) const {
        const PointSet p = few.all();
        const SurfaceFit plane = surface::fit(SurfaceType::plane, p);
        if (!plane.ok) return {};
        if (plane.q97 <= 2 * trim_error && plane.rms <= nearly_flat * extent) return plane;
        const double most = std::min(nearly_exact_distance, nearly_all_bend * plane.rms);
        std::vector<SurfaceFit> near;
        double least = most;
        for (const SurfaceType type :
             {SurfaceType::cylinder, SurfaceType::cone, SurfaceType::sphere, SurfaceType::torus}) {
            if (p.points.size() < 2 * static_cast<std::size_t>(surface::degrees_of_freedom(type)) + 2) continue;
            surface::FitOptions options;
            options.hopeless = 2 * most;
            const SurfaceFit fit = surface::fit(type, p, options);
            if (!fit.ok || !(fit.rms <= most) || wrong_normals(fit.surface, few)) continue;
            near.push_back(fit);
            least = std::min(least, fit.rms);
        }
        SurfaceFit best;
        double best_score = 0;
        for (const SurfaceFit& fit : near) {
            if (!(fit.rms <= std::max(trim_error, equal_ratio * least))) continue;
            const double score = (normal_deviation(fit.surface, p) + 1e-7) * preference(fit.surface.type);
            if (best.ok && !(score < best_score)) continue;
            best = fit;
            best_score = score;
        }
        return best;
    }

    /// Neither the region's quadric nor its refinement on vertices comes near them.
    static bool fails(const Surface& own, const RegionSample& few, double tolerance) {
        if (few.points.size() < 10 || surface::measure(own, few.all()).rms <= tolerance) return false;
        const SurfaceFit general = surface::fit_type(SurfaceType::quadric, few.all(), own.coefficients);
        return !general.ok || !(general.rms <= tolerance);
    }

    /// turned: mean squared deviation of the normals that is not the surface's doing.
    static bool wrong_normals(const Surface& s, const RegionSample& sample, double turned = 0) {
        constexpr double limit = free_form_angle * 3.14159265358979 / 180;
        return !(normal_deviation(s, sample.all()) <= limit * limit + turned);
    }

    void describe_free_form(const RegionSample& sample, FinalSurface& result) const {
        result.surface = {};
        result.surface.type = SurfaceType::freeform;
        result.surface.coefficients = quadric::from_local(result.quadric.c, result.quadric.origin, 1);
        const RegionSample some = sample.thinned(choice_points);
        if (some.points.size() < 12) return;
        const surface::BlendFit blend = surface::fit_blend(some.all());
        // A canal of one radius: the offset points draw a thin curve, every vertex shows the same radius, and the
        // section turns enough to tell.
        const bool explains = blend.ok && blend.radius > 0 && blend.radius < 2 * result.extent &&
                              blend.spine_residual <= 0.02 * blend.radius && blend.radius_spread <= 0.02 &&
                              blend.section_angle >= 0.05 && blend.spine_extent >= 0.5 * blend.radius;
        if (!explains) return;
        result.surface.type = SurfaceType::blend;
        result.surface.radius = blend.radius;
        result.surface.outward = blend.outward;
    }

    static void refine_choice(const Surface& chosen, const RegionSample& sample, const Surface& own,
                              const surface::FitOptions& options, FinalSurface& result) {
        result.surface = chosen;
        if (chosen.type <= SurfaceType::torus) {
            const SurfaceFit refined = surface::refine(chosen, sample.all(), options);
            if (refined.ok) result.surface = refined.surface;
            return;
        }
        if (chosen.coefficients == own.coefficients || sample.points.size() <= choice_points) return;
        const SurfaceFit refined =
            surface::fit_type(chosen.type, sample.thinned(general_points).all(), chosen.coefficients, options);
        if (refined.ok) result.surface = refined.surface;
    }

    static void set_coefficients(FinalSurface& result) {
        const SurfaceType type = result.surface.type;
        if (type <= SurfaceType::cone) {
            result.surface.coefficients = surface::to_coefficients(result.surface);
        } else if (type == SurfaceType::torus) {
            result.surface.coefficients = quadric::from_local(result.quadric.c, result.quadric.origin, 1);
        }
    }

    /// For a call that was stopped: what the flow found, or a surface from a few faces, so that all take milliseconds.
    FinalSurface roughly(std::size_t r) const {
        FinalSurface result = rough_fit(r);
        if (r >= flow_.surfaces.size() || flow_.surfaces[r].type == SurfaceType::freeform) return result;
        result.surface = flow_.surfaces[r];
        (void)quadric_of(result.surface, result.centroid, result.quadric);
        set_coefficients(result);
        return result;
    }

    FinalSurface rough_fit(std::size_t r) const {
        FinalSurface result;
        const std::size_t size = regions_.size(r);
        const std::size_t count = std::min(size, std::max<std::size_t>(2, rough_faces / regions_.count()));
        if (count < least_rough_fit) return rough_plane(r, count);
        std::vector<std::uint32_t> chosen(count);
        for (std::size_t i = 0; i < count; ++i) chosen[i] = faces(r)[i * size / count];
        partition::GatheredRegion soup;
        partition::gather(mesh_, chosen.data(), count, soup);
        for (const Vec3& p : soup.corners) result.centroid += p / static_cast<double>(soup.corners.size());
        double sum = 0;
        for (const Vec3& p : soup.corners) sum += squared_norm(p - result.centroid);
        result.extent = std::sqrt(sum / static_cast<double>(soup.corners.size()));
        result.quadric = (paper_ ? policy_.fit(soup.soup()) : quadric::fit_region(soup.soup(), fit_options_)).proxy;
        result.surface = named(result);
        set_coefficients(result);
        return result;
    }

    /// The plane of the mean normal: nothing is allocated, for there may be as many regions as leaves.
    FinalSurface rough_plane(std::size_t r, std::size_t count) const {
        FinalSurface result;
        const std::size_t size = regions_.size(r);
        Vec3 normal;
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint32_t f = faces(r)[i * size / count];
            result.centroid += mesh_.centroid(f) / static_cast<double>(count);
            normal += mesh_.normals[f] * mesh_.areas[f];
        }
        if (!(squared_norm(normal) > 0)) normal = {0, 0, 1};
        result.surface.type = SurfaceType::plane;
        result.surface.axis = to_array(normalized(normal));
        result.surface.point = to_array(result.centroid);
        result.surface.coefficients = surface::to_coefficients(result.surface);
        result.quadric.origin = result.centroid;
        result.quadric.c = result.surface.coefficients;
        result.quadric.c[0] = 0;
        result.quadric.gradient_floor = 0.05;
        return result;
    }

    const FlowInput& input_;
    const mesh::WorkMesh& mesh_;
    const Options& options_;
    const partition::RegionFaces& regions_;
    const FlowResult& flow_;
    bool paper_;
    double precision_;  ///< of the coordinates, unit frame
    MethodPolicy policy_;
    quadric::RegionFitOptions fit_options_;
};

}  // namespace

bool quadric_of(const Surface& s, const Vec3& origin, quadric::Proxy& proxy) {
    if (s.type == SurfaceType::torus || s.type == SurfaceType::blend || s.type == SurfaceType::freeform) return false;
    const Surface local = surface::transformed(s, origin, 1);
    proxy.origin = origin;
    proxy.c = local.type <= SurfaceType::cone ? surface::to_coefficients(local) : local.coefficients;
    // 5 % of the region's |∇f|, which is 1 but for cones.
    proxy.gradient_floor = s.type == SurfaceType::cone ? 0.05 * norm(origin - to_vec3(s.point)) : 0.05;
    if (!(proxy.gradient_floor > 1e-6)) proxy.gradient_floor = 1e-6;
    return true;
}

std::vector<FinalSurface> final_surfaces(const FlowInput& input, const partition::RegionFaces& regions,
                                         const FlowResult& flow) {
    const Finisher finisher(input, regions, flow);
    std::vector<FinalSurface> result(regions.count());
    // Large regions first: the last task to start should be a short one.
    std::vector<std::uint32_t> order(regions.count());
    for (std::size_t r = 0; r < order.size(); ++r) order[r] = static_cast<std::uint32_t>(r);
    const bool stopped = input.control.should_stop();  // then all are short, and memory is read in its order
    if (!stopped) {
        std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
            return regions.size(a) != regions.size(b) ? regions.size(a) > regions.size(b) : a < b;
        });
    }
    runtime::parallel_for(order.size(), stopped ? 256 : 1,
                          [&](std::size_t i) { result[order[i]] = finisher.run(order[i]); });
    return result;
}

}  // namespace quadseg::flow
