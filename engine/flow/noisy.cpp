#include "flow/noisy.h"

#include "flow/complete_merge.h"
#include "flow/description_length.h"
#include "flow/filtered_normals.h"
#include "partition/absorb.h"
#include "partition/leaves.h"
#include "partition/pair_merge.h"
#include "partition/relax.h"
#include "runtime/parallel.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>

namespace quadseg::flow {
namespace {

using partition::Labels;
using partition::Passage;

double knob(const char* name, double value) {
    const char* s = std::getenv(name);
    return s ? std::atof(s) : value;
}

class NoisyFlow {
  public:
    NoisyFlow(const FlowInput& input, const NoiseEstimate& noise)
        : mesh_(input.mesh), control_(input.control), passage_{&input.mesh, input.features, {}} {
        const double h = noise.edge;
        const double mean_area = mesh_.total_area / static_cast<double>(std::max<std::size_t>(1, mesh_.face_count()));
        ratio_ = noise.sigma / h;
        evidence_ = noise.sigma * noise.sigma * 2 * mean_area / input.options.detail;
        // Maximum likelihood says h²/2 (MATH.md §3); .5 to 1 are all fine, less over-merges, more fragments.
        weight_ = knob("OM", .75) * h * h;
        border_price_ = knob("BETA", 2) * evidence_ / h;
        const double angle = 8 * std::numbers::pi / 180;
        const double fading = std::min(1.0, 0.03 / ratio_);
        misfit_ = angle * angle * weight_ * fading * fading;
        result_.noise = noise.sigma;
    }

    FlowResult run() {
        labels_ = mesh_.components;
        count_ = mesh_.component_count;
        try {
            grow();
            const int levels = static_cast<int>(knob("LEVELS", 2));
            const double shrink = knob("SHRINK", 4);
            for (int level = 0; level < levels && !result_.partial; ++level) {
                merge(static_cast<std::size_t>(static_cast<double>(count_) / shrink), knob("KAPPA", 4));
                if (!result_.partial) relax_on_moments(1);
            }
            if (!result_.partial) merge(0, knob("KAPPA", 4));
            const int steps = static_cast<int>(knob("STEPS", 2));
            if (!result_.partial) relax(steps);
            for (int round = 0; round < static_cast<int>(knob("EXACT", 2)) && !result_.partial; ++round) {
                merge_completely(knob("KEXACT", 6));
                relax(steps);
            }
            if (!result_.partial) clean_up();
        } catch (const runtime::Stopped&) {
            result_.partial = true;
        }
        result_.regions = partition::compact(labels_);
        result_.labels = std::move(labels_);
        if (result_.partial) result_.stop = control_.should_stop() ? StopReason::cancelled : StopReason::deadline;
        return std::move(result_);
    }

  private:
    void grow() {
        const bool light = ratio_ < 0.25;
        partition::LeafOptions options;
        options.largest = static_cast<std::size_t>(knob("LEAF", light ? 24 : 48));
        options.smallest_coplanar = 0;
        const std::vector<Vec3> normals =
            filtered_normals(mesh_, light ? 1 : 2, static_cast<int>(knob("BIL", light ? 3 : 10)), control_);
        options.normals = normals;
        partition::Leaves leaves = partition::grow_leaves(passage_, options, control_);
        labels_ = std::move(leaves.labels);
        count_ = leaves.count;
        measure();
        partition::RelaxOptions relax = relax_options();
        relax.moment_steps = 3;
        relax.steps = -1;
        relax.moment_fit = [this](const quadric::Moments& m) {
            const PricedFit fit = plane_priced(m, weight_, 0);
            return partition::MomentFit{fit.c, fit.energy};
        };
        run_relax(relax);
        control_.report(Phase::fine, 0.3, count_);
    }

    partition::Scorer scorer(double kappa) const {
        return [weight = weight_, price = kappa * evidence_](const quadric::Moments& m) {
            const PricedFit fit = fit_priced(m, weight, price);
            return partition::RegionScore{fit.length, fit.energy, fit.parameters};
        };
    }

    void measure() {
        regions_ = partition::measure_regions(
            mesh_, labels_, count_, [](const quadric::Moments&) { return partition::RegionScore{}; }, control_);
    }

    void merge(std::size_t target, double kappa) {
        const partition::Scorer score = scorer(kappa);
        runtime::parallel_for(regions_.size(), 64,
                              [&](std::size_t r) { regions_[r].score = score(regions_[r].moments); });
        partition::MergeRules rules;
        rules.target = target;
        rules.only_acceptable = true;
        rules.misfit = misfit_;
        partition::Merging merging = partition::merge_pairs(
            std::move(regions_), partition::region_pairs(passage_, labels_, control_), rules, score, control_);
        for (std::int32_t& label : labels_) label = merging.region_of[static_cast<std::size_t>(label)];
        regions_ = std::move(merging.regions);
        count_ = regions_.size();
        result_.history.insert(result_.history.end(), merging.history.begin(), merging.history.end());
        result_.partial = merging.stopped;
    }

    partition::RelaxOptions relax_options() const {
        partition::RelaxOptions options;
        options.border_price = border_price_;
        options.fit.weight = weight_;
        options.fit.plane_tolerance = 0;
        return options;
    }

    void relax_on_moments(int steps) {
        partition::RelaxOptions options = relax_options();
        options.moment_steps = steps;
        options.steps = -1;
        options.moment_fit = [this](const quadric::Moments& m) {
            const PricedFit fit = fit_priced(m, weight_, 4 * evidence_);
            return partition::MomentFit{fit.c, fit.energy};
        };
        run_relax(options);
    }

    void relax(int steps) {
        partition::RelaxOptions options = relax_options();
        options.moment_steps = 0;
        options.steps = steps;
        run_relax(options);
    }

    void merge_completely(double kappa) {
        CompleteMergeRules rules;
        rules.weight = weight_;
        rules.price = kappa * evidence_;
        rules.border_reward = knob("REWARD", 0.3) * border_price_;
        rules.misfit = misfit_;
        count_ = merge_by_complete_fits(passage_, labels_, std::move(fits_), std::move(regions_), rules, control_);
        measure();
    }

    void clean_up() {
        partition::AbsorbOptions options;
        options.smallest_region = static_cast<std::size_t>(knob("SMALL", 8));
        options.tolerance = std::numeric_limits<double>::infinity();
        options.weight = weight_;
        const std::size_t before = count_;
        count_ = partition::absorb_small(passage_, labels_, count_, fits_, options, control_);
        if (count_ == before) return;
        measure();
        relax(static_cast<int>(knob("LAST", 2)));
    }

    void run_relax(const partition::RelaxOptions& options) {
        partition::Relaxed relaxed = partition::relax(passage_, labels_, std::move(regions_), options, control_);
        result_.partial = relaxed.stopped;
        if (result_.partial) return;
        fits_ = std::move(relaxed.fits);
        drop_empty();
        measure();
    }

    /// Labels without faces go; fits stay with their labels.
    void drop_empty() {
        std::vector<std::int32_t> renumbered(count_, -1);
        std::vector<quadric::RegionFit> fits;
        std::int32_t next = 0;
        for (std::int32_t& label : labels_) {
            std::int32_t& r = renumbered[static_cast<std::size_t>(label)];
            if (r < 0) {
                r = next++;
                fits.push_back(fits_[static_cast<std::size_t>(label)]);
            }
            label = r;
        }
        fits_ = std::move(fits);
        count_ = static_cast<std::size_t>(next);
    }

    const mesh::WorkMesh& mesh_;
    const runtime::RunControl& control_;
    Passage passage_;
    double ratio_ = 0;
    double evidence_ = 0;  ///< what one parameter takes from ∫d² on pure noise: σ² times the area of a vertex
    double weight_ = 0, border_price_ = 0, misfit_ = 0;
    Labels labels_;
    std::size_t count_ = 0;
    std::vector<partition::MergeRegion> regions_;
    std::vector<quadric::RegionFit> fits_;
    FlowResult result_;
};

}  // namespace

FlowResult run_noisy(const FlowInput& input, const NoiseEstimate& noise) {
    return NoisyFlow(input, noise).run();
}

}  // namespace quadseg::flow
