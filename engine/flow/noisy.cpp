#include "flow/noisy.h"

#include "flow/complete_merge.h"
#include "flow/denoised_mesh.h"
#include "flow/description_length.h"
#include "flow/evidence_areas.h"
#include "flow/filtered_normals.h"
#include "flow/softened_mesh.h"
#include "flow/torus_merge.h"
#include "partition/absorb.h"
#include "partition/leaves.h"
#include "partition/pair_merge.h"
#include "partition/relax.h"
#include "runtime/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace quadseg::flow {
namespace {

using partition::Labels;
using partition::Passage;

/// What description lengths charge. Under light noise wrong merges are rare and crumbs of chance the danger; strong
/// noise leaves true small surfaces little evidence: what asks for much more than chance would give loses them.
struct Prices {
    double moment = 4;           ///< of a parameter in units of the evidence, when merging on moments …
    double complete = 4;         ///< … and by complete fits
    double region = 1.5;         ///< of a region as such, times ln(faces)
    double border_share = 0.3;   ///< what removed border is worth in a merge, of its price in relaxation: all of it
                                 ///< would swallow small surfaces
    double relax_weight = 0.15;  ///< ω when faces move, of the ω of merging
    double weight = 0.75;        ///< ω of merging, in squared edges: less over-merges, more fragments
    double border = 2;           ///< χ² that an edge of mean length is worth
};
/// Noise as large as edges is estimated too small (flow/noise.h), and most of E_n is it: both ω and prices rise.
constexpr Prices light_prices, strong_prices{4, 1.5, 0.3, 0.2, 0.25}, utmost_prices{12, 4, 0.3, 0.2, 0.2, 3, 1.5};
constexpr double strong_from = NoiseEstimate::strong_from, all_strong = 0.35, utmost_from = 0.52,
                 all_utmost = 0.65;  ///< σ/h

Prices prices_at(double ratio) {
    const bool beyond = ratio > all_strong;
    const double from = beyond ? utmost_from : strong_from, to = beyond ? all_utmost : all_strong;
    const double s = std::clamp((ratio - from) / (to - from), 0.0, 1.0);
    const auto between = [s](double a, double b) { return a + (b - a) * s; };
    const Prices &a = beyond ? strong_prices : light_prices, &b = beyond ? utmost_prices : strong_prices;
    return {between(a.moment, b.moment),
            between(a.complete, b.complete),
            between(a.region, b.region),
            between(a.border_share, b.border_share),
            between(a.relax_weight, b.relax_weight),
            between(a.weight, b.weight),
            between(a.border, b.border)};
}

/// Borders are drawn after the noise. What that gains grows with their length in edges: on finer meshes of the same
/// shape pieces of a surface look more worth keeping, and the prices of merging have to follow.
double merging_factor(std::size_t faces) {
    constexpr double usual_faces = 50000, largest = 2;
    return std::clamp(std::sqrt(static_cast<double>(faces) / usual_faces), 1.0, largest);
}

/// Least squares miss the best surface by a share of the energy, which on a large one is more than any price: two
/// surfaces that are √.1 σ apart (RMS) are one, where they have many more than so many vertices.
constexpr double blur = 0.1, blur_vertices = 500;

/// Surfaces that are two σ apart where a border runs double its price: fits of small regions are not surer than that.
constexpr double gap_price = 0.25;
/// Ratio of a torus's radii: strong noise rounds steps and chamfers, which short tori follow.
constexpr double least_torus = 1.5, least_torus_strong = 6;
constexpr int relax_steps = 2;
constexpr int cut_rings = 4;
constexpr std::size_t smallest_region = 8;

class NoisyFlow {
  public:
    /// `whole`: its result is final, not a start for refine() on a finer mesh, where all surfaces are quadrics.
    NoisyFlow(const FlowInput& input, const NoiseEstimate& noise, double merging_factor, bool whole)
        : mesh_(input.mesh),
          control_(input.control),
          noise_(noise),
          whole_(whole),
          passage_{&input.mesh, input.features, {}} {
        const double h = noise.edge;
        const double mean_area = mesh_.total_area / static_cast<double>(std::max<std::size_t>(1, mesh_.face_count()));
        ratio_ = noise.sigma / h;
        noise_square_ = noise.sigma * noise.sigma;
        prices_ = prices_at(ratio_);
        for (double* price : {&prices_.moment, &prices_.complete, &prices_.region, &prices_.border_share}) {
            *price *= merging_factor;
        }
        evidence_ = noise_square_ * 2 * mean_area / input.options.detail;
        // Where faces move it is the likelihood of independent vertices that counts: h²/8, with which E_d + ω E_n of a
        // triangle is ∝ Σ d² over its vertices.
        weight_ = prices_.weight * h * h;
        border_price_ = prices_.border * evidence_ / h;
        const double angle = misfit_angle(noise) * std::numbers::pi / 180;
        misfit_ = angle * angle * weight_ / input.options.detail;
        blur_ = blur * noise_square_ / input.options.detail;
        blur_area_ = blur_vertices * 2 * mean_area;
        result_.noise = noise.sigma;
    }

    FlowResult run() {
        labels_ = mesh_.components;
        count_ = mesh_.component_count;
        return finished([&] {
            grow();
            if (!result_.partial) merge_on_moments();
            if (!result_.partial) judge_by_softened_mesh();
            if (!result_.partial) relax();
            for (int round = 0; round < 2 && !result_.partial; ++round) {
                merge_completely();
                relax();
            }
        });
    }

    FlowResult refine(const Labels& labels, std::vector<Vec3>&& normals) {
        labels_ = labels;
        count_ = 1 + static_cast<std::size_t>(*std::max_element(labels.begin(), labels.end()));
        return finished([&] {
            normals_ = normals.empty() ? softening_normals(mesh_, noise_, control_) : std::move(normals);
            judge_by_softened_mesh();
            relax();
            if (result_.partial) return;
            merge_completely();
            relax();
        });
    }

  private:
    /// What is there when `find_regions` is done or stopped.
    template <class FindRegions>
    FlowResult finished(const FindRegions& find_regions) {
        try {
            find_regions();
            if (!result_.partial) clean_up();
            if (!result_.partial) measure_noise();
            if (!result_.partial && whole_) merge_tori();
        } catch (const runtime::Stopped&) {
            result_.partial = true;
        }
        std::vector<std::int32_t> renumbered;
        result_.regions = partition::compact(labels_, renumbered);
        result_.labels = std::move(labels_);
        result_.scan = true;
        if (!result_.partial && !tori_.empty()) {
            result_.surfaces.resize(result_.regions);
            for (std::size_t r = 0; r < renumbered.size(); ++r) {
                if (renumbered[r] >= 0) result_.surfaces[static_cast<std::size_t>(renumbered[r])] = tori_[r];
            }
        }
        if (result_.partial) result_.stop = control_.cancelled() ? StopReason::cancelled : StopReason::deadline;
        return std::move(result_);
    }

    /// How much the filtered normals turn about each face. Leaves grow from the flattest faces on.
    std::vector<double> bends() const {
        std::vector<double> bend(mesh_.face_count(), 0);
        runtime::parallel_blocks(bend.size(), 16384, [&](std::size_t begin, std::size_t end) {
            control_.check();
            for (std::size_t f = begin; f < end; ++f) {
                for (const std::int32_t g : mesh_.neighbors[f]) {
                    if (g >= 0) bend[f] += squared_norm(normals_[f] - normals_[static_cast<std::size_t>(g)]);
                }
            }
        });
        return bend;
    }

    void grow() {
        normals_ = noise_.strong() ? filtered_normals(mesh_, 2, 10, control_) : filtered_normals(mesh_, 1, 3, control_);
        weighed_ = denoised_mesh(mesh_, normals_, control_);
        weighed_.areas = evidence_areas(weighed_, mesh_.total_area, control_);
        passage_.mesh = &weighed_;
        partition::LeafOptions options;
        options.largest = noise_.strong() ? 48 : 24;
        options.smallest_coplanar = 0;
        options.normals = normals_;
        const std::vector<double> order = bends();
        options.order = order;
        partition::Leaves leaves = partition::grow_leaves(passage_, options, control_);
        labels_ = std::move(leaves.labels);
        count_ = leaves.count;
        measure();
        partition::RelaxOptions straighten;
        straighten.fit.weight = weight_;
        straighten.border.length = border_price_;
        straighten.moment_steps = 3;
        straighten.steps = -1;
        straighten.moment_fit = [weight = weight_](const quadric::Moments& m) {
            const PricedFit plane = plane_priced(m, weight, 0);
            return partition::MomentFit{plane.c, plane.energy};
        };
        relax(straighten);
        control_.report(Phase::fine, 0.3, count_);
    }

    /// Regions have been found on the denoised mesh; whether they are right, and where they end, another one says.
    void judge_by_softened_mesh() {
        weighed_ = {};  // two at once would be the job's peak of memory
        weighed_ = softened_mesh(mesh_, normals_, noise_, control_);
        normals_ = {};
        weighed_.areas = evidence_areas(weighed_, mesh_.total_area, control_);
        passage_.mesh = &weighed_;
        measure();
    }

    void measure() {
        regions_ = partition::measure_regions(
            *passage_.mesh, labels_, count_, [](const quadric::Moments&) { return partition::RegionScore{}; },
            control_);
    }

    void merge_on_moments() {
        const partition::Scorer score = [weight = weight_,
                                         price = prices_.moment * evidence_](const quadric::Moments& m) {
            const PricedFit fit = fit_priced(m, weight, price);
            return partition::RegionScore{fit.length, fit.energy, fit.parameters};
        };
        runtime::parallel_blocks(regions_.size(), 64, [&](std::size_t begin, std::size_t end) {
            control_.check();
            for (std::size_t r = begin; r < end; ++r) regions_[r].score = score(regions_[r].moments);
        });
        partition::MergeRules rules;
        rules.misfit = misfit_;
        rules.blur = blur_;
        rules.blur_area = blur_area_;
        partition::Merging merging = partition::merge_pairs(
            std::move(regions_), partition::region_pairs(passage_, labels_, control_), rules, score, control_);
        for (std::int32_t& label : labels_) label = merging.region_of[static_cast<std::size_t>(label)];
        regions_ = std::move(merging.regions);
        count_ = regions_.size();
        result_.history = std::move(merging.history);
        result_.partial = merging.stopped;
        control_.report(Phase::fine, 0.5, count_);
    }

    CompleteMergeRules complete_rules() const {
        CompleteMergeRules rules;
        rules.weight = weight_;
        rules.price = prices_.complete * evidence_;
        // Chance has a place for a crumb at every face; under strong noise true small surfaces look no different.
        rules.region_price = prices_.region * std::min(1.0, std::pow(0.16 / ratio_, 1.5)) * evidence_ *
                             std::log(static_cast<double>(mesh_.face_count()));
        rules.border_reward = prices_.border_share * border_price_;
        rules.misfit = misfit_;
        rules.blur = blur_;
        rules.blur_area = blur_area_;
        return rules;
    }

    void merge_completely() {
        count_ = merge_by_complete_fits(passage_, labels_, std::move(fits_), std::move(regions_), complete_rules(),
                                        control_);
        control_.report(Phase::fine, 0.7, count_);
    }

    void merge_tori() {
        const TorusMergeRules rules{complete_rules(), prices_.relax_weight * weight_, border_price_,
                                    noise_.strong() ? least_torus_strong : least_torus};
        tori_ = merge_into_tori(passage_, labels_, fits_, regions_, rules, control_);
    }

    void clean_up() {
        partition::AbsorbOptions options;
        options.smallest_region = smallest_region;
        options.tolerance = std::numeric_limits<double>::infinity();
        options.weight = weight_;
        const std::size_t before = count_;
        count_ = partition::absorb_small(passage_, labels_, count_, fits_, options, control_);
        if (count_ != before) relax();
    }

    /// The distances that large regions leave tell the noise more truly than the raw mesh did: they do not saturate.
    /// (The prices stay with the first estimate: raised by this one they cost small regions and win nothing.)
    void measure_noise() {
        const double large_area = 128 * mesh_.total_area / static_cast<double>(mesh_.face_count());
        std::vector<std::uint32_t> large;
        for (std::uint32_t r = 0; r < count_; ++r) {
            if (regions_[r].moments.total_area >= large_area) large.push_back(r);
        }
        if (large.empty()) return;
        const partition::RegionFaces faces = partition::region_faces(labels_, count_);
        std::vector<double> mean_squares(large.size());
        runtime::parallel_for(large.size(), 1, [&](std::size_t i) {
            control_.check();
            const std::uint32_t r = large[i];
            double distance = 0;
            for (std::uint32_t k = faces.begin[r]; k < faces.begin[r + 1]; ++k) {
                const std::uint32_t f = faces.face[k];
                distance += quadric::triangle_energy(fits_[r].proxy, mesh_.corner(f, 0), mesh_.corner(f, 1),
                                                     mesh_.corner(f, 2), mesh_.normals[f], weighed_.areas[f])
                                .distance;
            }
            mean_squares[i] = distance / regions_[r].moments.total_area;
        });
        const auto middle = mean_squares.begin() + static_cast<std::ptrdiff_t>(mean_squares.size() / 2);
        std::nth_element(mean_squares.begin(), middle, mean_squares.end());
        // ∫d² over triangles of independent vertices is half of what the vertices have.
        result_.noise = std::sqrt(2 * *middle);
    }

    void relax() {
        partition::RelaxOptions options;
        options.fit.weight = prices_.relax_weight * weight_;
        options.fit.plane_tolerance = 0;
        options.border = {border_price_, gap_price / noise_square_};
        options.cut_rings = cut_rings;
        options.moment_steps = 0;
        options.steps = relax_steps;
        regions_.resize(count_);
        relax(options);
    }

    /// Leaves labels without gaps, with their fits and moments.
    void relax(const partition::RelaxOptions& options) {
        partition::Relaxed relaxed = partition::relax(passage_, labels_, std::move(regions_), options, control_);
        result_.partial = relaxed.stopped;
        if (result_.partial) return;
        fits_ = std::move(relaxed.fits);
        drop_empty();
        measure();
    }

    /// Labels without faces go; fits stay with their labels.
    void drop_empty() {
        std::vector<std::int32_t> renumbered;
        count_ = partition::close_gaps(labels_, renumbered);
        std::vector<quadric::RegionFit> fits(count_);
        for (std::size_t r = 0; r < renumbered.size(); ++r) {
            if (renumbered[r] >= 0) fits[static_cast<std::size_t>(renumbered[r])] = fits_[r];
        }
        fits_ = std::move(fits);
    }

    const mesh::WorkMesh& mesh_;
    mesh::WorkMesh weighed_;     ///< first denoised, then softened; its areas are evidence (flow/evidence_areas.h)
    std::vector<Vec3> normals_;  ///< filtered
    const runtime::RunControl& control_;
    const NoiseEstimate noise_;
    const bool whole_;
    Passage passage_;
    double ratio_ = 0, noise_square_ = 0;
    double evidence_ = 0;  ///< what one parameter takes from ∫d² on pure noise: σ² times the area of a vertex
    Prices prices_;
    double weight_ = 0, border_price_ = 0, misfit_ = 0, blur_ = 0, blur_area_ = 0;
    Labels labels_;
    std::size_t count_ = 0;
    std::vector<partition::MergeRegion> regions_;
    std::vector<quadric::RegionFit> fits_;
    std::vector<Surface> tori_;  ///< of the regions
    FlowResult result_;
};

}  // namespace

FlowResult run_noisy(const FlowInput& input, const NoiseEstimate& noise, Scan scan) {
    const bool raw = scan == Scan::raw;
    return NoisyFlow(input, noise, raw ? merging_factor(input.mesh.face_count()) : 1, raw).run();
}

FlowResult refine_noisy(const FlowInput& input, const NoiseEstimate& noise, const Labels& labels,
                        std::vector<Vec3> normals) {
    return NoisyFlow(input, noise, 1, true).refine(labels, std::move(normals));
}

}  // namespace quadseg::flow
