#include "flow/fast.h"

#include "partition/absorb.h"
#include "partition/leaves.h"
#include "partition/pair_merge.h"
#include "partition/relax.h"
#include "quadric/energy.h"
#include "quadric/ladder.h"
#include "runtime/parallel.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace quadseg::flow {
namespace {

using partition::Labels;
using partition::Passage;

/// Noise of the normals as energy a degree of freedom absorbs: median over faces of 3/4 ω |t| |n_t − mean n of its
/// neighbours|²; on clean meshes about 0.
double normal_noise(const mesh::WorkMesh& mesh, double weight) {
    constexpr std::size_t most_samples = 16384;
    const std::size_t stride = 1 + mesh.face_count() / most_samples;
    std::vector<double> samples;
    for (std::size_t f = 0; f < mesh.face_count(); f += stride) {
        Vec3 mean;
        for (const std::int32_t g : mesh.neighbors[f]) {
            if (g >= 0) mean += mesh.normals[static_cast<std::size_t>(g)];
        }
        if (!(mesh.areas[f] > 0) || !(squared_norm(mean) > 0)) continue;
        samples.push_back(mesh.areas[f] * squared_norm(mesh.normals[f] - normalized(mean)));
    }
    if (samples.empty()) return 0;
    const auto middle = samples.begin() + static_cast<std::ptrdiff_t>(samples.size() / 2);
    std::nth_element(samples.begin(), middle, samples.end());
    return 0.75 * weight * *middle;
}

constexpr std::size_t many_leaves = 64;
/// Share of the energy that a step of the relaxation must have won for another one, where a number of regions is asked
/// for.
constexpr double last_gain = 5e-3;
/// Likewise the share of a region's area that may change without another fit of its surface.
constexpr double settled_share = 0.03;

class FastFlow {
  public:
    FastFlow(const FlowInput& input, const FastOptions& fast)
        : mesh_(input.mesh),
          control_(input.control),
          fast_(fast),
          weight_(input.options.weight),
          passage_{&input.mesh, input.features, fast.active} {
        const double tolerance = fast.tolerance * mesh_.frame.diagonal;
        scorer_ = [weight = weight_, ladder = fast.ladder, tolerance](const quadric::Moments& m) {
            const quadric::LadderFit fit = quadric::fit_ladder(m, weight, ladder);
            partition::RegionScore score{fit.cost, fit.energy, fit.dof};
            if (tolerance > 0) score.distance = quadric::moment_energy(fit.c, m).distance;
            return score;
        };
    }

    FlowResult run() {
        return ended([&] {
            start();
            grow();
            merge_down();
            if (!result_.partial) improve();
        });
    }

    /// From labels found elsewhere.
    FlowResult refine(const Labels& initial) {
        return ended([&] {
            start();
            labels_ = initial;
            count_ = partition::connected_parts(passage_, labels_);
            merge_down();
            if (!result_.partial) improve();
        });
    }

  private:
    template <class Steps>
    FlowResult ended(const Steps& steps) {
        try {
            steps();
        } catch (const runtime::Stopped&) {
            result_.partial = true;
        }
        hand_over();
        if (result_.partial) {
            result_.stop = control_.cancelled() ? StopReason::cancelled : StopReason::deadline;
        } else if (fast_.regions > 0) {
            result_.stop = result_.regions == fast_.regions ? StopReason::regions : StopReason::converged;
        } else {
            result_.stop = fast_.tolerance > 0 ? StopReason::tolerance : StopReason::converged;
        }
        return std::move(result_);
    }

    /// Numbers the regions by their first face, their fits alike.
    void hand_over() {
        std::vector<std::int32_t> renumbered;
        result_.regions = partition::compact(labels_, renumbered);
        result_.labels = std::move(labels_);
        if (result_.partial || fits_.empty()) return;
        result_.fits.resize(result_.regions);
        for (std::size_t r = 0; r < renumbered.size(); ++r) {
            if (renumbered[r] >= 0) result_.fits[static_cast<std::size_t>(renumbered[r])] = std::move(fits_[r]);
        }
    }

    void start() {
        start_from_parts();
        if (fast_.regions > 0 && count_ > fast_.regions && passage_.barriers != nullptr) {
            // The number asked for weighs more than the features.
            passage_.barriers = nullptr;
            start_from_parts();
        }
    }

    /// The coarsest partition there is, so that a flow stopped early has a result.
    void start_from_parts() {
        if (passage_.barriers == nullptr && passage_.active.empty()) {
            labels_ = mesh_.components;
            count_ = mesh_.component_count;
            return;
        }
        labels_.assign(mesh_.face_count(), 0);
        for (std::size_t f = 0; f < labels_.size(); ++f) {
            if (!passage_.is_active(f)) labels_[f] = -1;
        }
        count_ = partition::connected_parts(passage_, labels_);
    }

    void grow() {
        control_.check();
        partition::LeafOptions options;
        options.angle = fast_.leaf_angle;
        partition::Leaves leaves = partition::grow_leaves(passage_, options, control_);
        // Merging needs something to choose from.
        const std::size_t wanted = std::min(2 * fast_.regions, mesh_.face_count());
        if (leaves.count < wanted) {
            options.smallest_coplanar = 0;
            options.largest = std::max<std::size_t>(1, mesh_.face_count() / (2 * wanted));
            leaves = partition::grow_leaves(passage_, options, control_);
        }
        if (fast_.regions > 0 && leaves.count > many_leaves * fast_.regions) {
            // So many leaves a region leave nothing to gain from small ones.
            options.angle = 1.5 * fast_.leaf_angle;
            leaves = partition::grow_leaves(passage_, options, control_);
        }
        if (leaves.count < fast_.regions) {
            options.largest = 1;
            leaves = partition::grow_leaves(passage_, options, control_);
        }
        while (fast_.tolerance > 0 && options.largest > 1 && exceeds_tolerance(leaves)) {
            options.angle /= 2;
            options.largest /= 4;
            leaves = partition::grow_leaves(passage_, options, control_);
        }
        leaves_ = std::move(leaves.labels);
        labels_ = leaves_;
        count_ = leaves.count;
    }

    /// More than a hundredth of the area lies in leaves that miss the tolerance already.
    bool exceeds_tolerance(const partition::Leaves& leaves) const {
        const double tolerance = fast_.tolerance * mesh_.frame.diagonal;
        double outside = 0;
        for (const partition::MergeRegion& leaf :
             partition::measure_regions(mesh_, leaves.labels, leaves.count, scorer_, control_)) {
            const double area = leaf.moments.total_area;
            if (leaf.score.distance > tolerance * tolerance * area) outside += area;
        }
        return outside > 0.01 * mesh_.total_area;
    }

    partition::MergeRules rules() const {
        partition::MergeRules rules;
        rules.target = fast_.regions;
        const double angle = fast_.misfit_angle * std::numbers::pi / 180;
        rules.misfit = weight_ * angle * angle;
        rules.noise = fast_.noise_factor * normal_noise(mesh_, weight_);
        rules.tolerance = fast_.tolerance * mesh_.frame.diagonal;
        return rules;
    }

    /// Merges the present regions.
    void merge_down() {
        control_.report(Phase::fine, 0.3, count_);
        partition::Merging merging =
            partition::merge_pairs(partition::measure_regions(mesh_, labels_, count_, scorer_, control_),
                                   partition::region_pairs(passage_, labels_, control_), rules(), scorer_, control_);
        for (std::int32_t& label : labels_) {
            if (label >= 0) label = merging.region_of[static_cast<std::size_t>(label)];
        }
        regions_ = std::move(merging.regions);
        count_ = regions_.size();
        if (result_.history.empty()) result_.history = std::move(merging.history);
        result_.partial = merging.stopped;
        control_.report(Phase::fine, 0.6, count_);
    }

    partition::Relaxed relax() {
        partition::RelaxOptions options;
        options.moment_steps = fast_.moment_steps;
        options.steps = fast_.relax_steps;
        if (fast_.regions > 0) {
            options.stop = last_gain;
            options.settled = settled_share;
        }
        options.fit.weight = weight_;
        options.fit.plane_tolerance_per_area = true;
        partition::Relaxed relaxed = partition::relax(passage_, labels_, std::move(regions_), options, control_);
        result_.partial = relaxed.stopped;
        result_.energies.push_back(relaxed.energy);
        return relaxed;
    }

    void improve() {
        partition::Relaxed relaxed = relax();
        for (int round = 0; round < fast_.split_rounds && !result_.partial && is_organic(relaxed.energy); ++round) {
            const Labels labels = labels_;
            const std::size_t count = count_;
            dissolve_worst(relaxed.fits);
            merge_down();
            partition::Relaxed again;
            if (!result_.partial) again = relax();
            if (result_.partial || !(again.energy < relaxed.energy)) {
                labels_ = labels;
                count_ = count;
                break;
            }
            relaxed = std::move(again);
        }
        if (result_.partial) return;
        control_.report(Phase::fine, 0.8, count_, relaxed.energy);
        if (fast_.regions > 0) {
            if (!restore_count(relaxed.fits)) fits_ = std::move(relaxed.fits);
        } else if (fast_.smallest_region > 1) {
            absorb(relaxed.fits);
        }
    }

    bool is_organic(double energy) const {
        constexpr double least_angle = 4 * std::numbers::pi / 180;
        return energy > weight_ * least_angle * least_angle * mesh_.total_area;
    }

    void absorb(const std::vector<quadric::RegionFit>& fits) {
        constexpr double least_share = 1e-6;
        constexpr double explained = 20 * std::numbers::pi / 180;
        partition::AbsorbOptions options;
        options.smallest_region = fast_.smallest_region;
        options.tolerance = weight_ * explained * explained;
        options.smallest_area = least_share * mesh_.total_area;
        options.weight = weight_;
        count_ = partition::absorb_small(passage_, labels_, count_, fits, options, control_);
    }

    std::vector<std::uint32_t> by_falling_energy(const std::vector<quadric::RegionFit>& fits) const {
        std::vector<std::uint32_t> order(fits.size());
        std::iota(order.begin(), order.end(), 0U);
        std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
            return fits[a].total != fits[b].total ? fits[a].total > fits[b].total : a < b;
        });
        return order;
    }

    /// Relaxation may leave labels without faces: as many regions as are missing are won by cutting the worst ones up
    /// finely enough and merging again. False: none is missing.
    bool restore_count(const std::vector<quadric::RegionFit>& fits) {
        std::vector<std::size_t> size(count_, 0);
        for (const std::int32_t label : labels_) {
            if (label >= 0) ++size[static_cast<std::size_t>(label)];
        }
        const auto present =
            static_cast<std::size_t>(std::count_if(size.begin(), size.end(), [](std::size_t s) { return s > 0; }));
        if (present >= fast_.regions) return false;
        const std::size_t missing = fast_.regions - present;
        constexpr std::size_t choice = 4;  // fragments for each region wanted of them
        std::vector<std::uint8_t> cut(count_, 0);
        std::size_t regions = 0, faces = 0;
        for (const std::uint32_t r : by_falling_energy(fits)) {
            if (regions >= missing && faces >= choice * (regions + missing)) break;
            if (size[r] < 2) continue;
            cut[r] = 1;
            ++regions;
            faces += size[r];
        }
        std::vector<std::uint8_t> active(labels_.size(), 0);
        for (std::size_t f = 0; f < labels_.size(); ++f) {
            if (labels_[f] >= 0) active[f] = cut[static_cast<std::size_t>(labels_[f])];
        }
        Passage inside = passage_;
        inside.active = active;
        partition::LeafOptions options;
        options.smallest_coplanar = 0;
        options.largest = std::max<std::size_t>(1, faces / (choice * (regions + missing)));
        const partition::Leaves pieces = partition::grow_leaves(inside, options, control_);
        for (std::size_t f = 0; f < labels_.size(); ++f) {
            if (active[f] != 0) labels_[f] = static_cast<std::int32_t>(count_) + pieces.labels[f];
        }
        count_ = partition::connected_parts(passage_, labels_);
        merge_down();
        return true;
    }

    /// Regions that their surface explains worst fall apart into their leaves, to be merged in another way.
    void dissolve_worst(const std::vector<quadric::RegionFit>& fits) {
        constexpr std::size_t share = 10;
        const std::vector<std::uint32_t> order = by_falling_energy(fits);
        std::vector<std::uint8_t> dissolved(count_, 0);
        for (std::size_t i = 0; i < (count_ + share - 1) / share; ++i) dissolved[order[i]] = 1;
        const auto first_leaf = static_cast<std::int32_t>(count_);
        for (std::size_t f = 0; f < labels_.size(); ++f) {
            if (labels_[f] >= 0 && dissolved[static_cast<std::size_t>(labels_[f])] != 0)
                labels_[f] = first_leaf + leaves_[f];
        }
        count_ = partition::connected_parts(passage_, labels_);
    }

    const mesh::WorkMesh& mesh_;
    const runtime::RunControl& control_;
    const FastOptions& fast_;
    double weight_;
    Passage passage_;
    partition::Scorer scorer_;
    Labels leaves_, labels_;
    std::size_t count_ = 0;
    std::vector<partition::MergeRegion> regions_;
    std::vector<quadric::RegionFit> fits_;  ///< of labels_ as they are
    FlowResult result_;
};

}  // namespace

FastOptions fast_options(const Options& options) {
    FastOptions fast;
    fast.regions = options.regions;
    fast.tolerance = options.tolerance;
    fast.ladder = options.regions == 0;
    // misfit is an angle squared; detail divides the energy.
    fast.misfit_angle /= std::sqrt(options.detail);
    fast.noise_factor /= options.detail;
    return fast;
}

FlowResult run_fast(const FlowInput& input, const FastOptions& fast) {
    return FastFlow(input, fast).run();
}

FlowResult refine_fast(const FlowInput& input, const FastOptions& fast, const partition::Labels& initial) {
    FastOptions options = fast;
    options.split_rounds = 0;  // there are no leaves to dissolve regions into
    return FastFlow(input, options).refine(initial);
}

}  // namespace quadseg::flow
