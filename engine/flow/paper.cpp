#include "flow/paper.h"

#include "flow/methods.h"
#include "flow/paper_loop.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <utility>

namespace quadseg::flow {

namespace {

/// An insertion that saves less than this share of the energy of the region that it splits has failed: a single odd
/// face was the worst, and the new region did not grow.
constexpr double least_gain = 0.02;
/// Rounds of smoothing of the error densities by which the seed of a new region is sought, one attempt after another.
constexpr std::array<int, 3> smoothing_rounds{0, 8, 64};
/// Lloyd iterations on the fine mesh after a coarse one: the labels are nearly right already (section 5.2).
constexpr int refinement_iterations = 6;
/// A merge, or a teleportation, must pay by this share of the energy: else the loop could merge and insert for ever.
constexpr double least_progress = 1e-3;
/// Teleportation pays off, as a rule of thumb of VSA, if the merge costs less than half of what splitting can save.
constexpr double teleport_share = 0.5;
/// A merge that costs more than this share of what the last insertion saved would have to be paid back.
constexpr double worthwhile_share = 0.5;
/// A teleportation is tried against the surface of the region that it splits, then with that region starting over.
constexpr std::size_t teleport_attempts = 2;
constexpr std::size_t teleport_regions_considered = 16;
/// Iterations of a Lloyd run after which a teleportation that is still worse by this factor is given up.
constexpr int trial_iterations = 6;
constexpr double hopeless_factor = 1.5;

/// Smallest energy seen with each number of regions. A merge is redundant only when it leads to a better partition than
/// the one that the region was inserted into; this also makes the loop end.
class BestEnergies {
  public:
    void note(const LoopState& state) {
        const auto [entry, fresh] = best_.emplace(state.regions(), state.energy);
        if (!fresh) entry->second = std::min(entry->second, state.energy);
    }
    bool is_progress(std::size_t regions, double energy) const {
        const auto found = best_.find(regions);
        return found == best_.end() || energy < found->second * (1 - least_progress);
    }

  private:
    std::map<std::size_t, double> best_;
};

/// The flowchart of Fig. 2.
class PaperFlow {
  public:
    explicit PaperFlow(const FlowInput& input)
        : paper_(input.options.paper), wanted_(input.options.regions), control_(input.control), loop_(input) {}

    StopReason optimise() {
        initialise();
        lloyd(FloodScope::all);
        return finish_number();
    }
    StopReason refine(const partition::Labels& initial) {
        loop_.start_from_labels(initial);
        loop_.lloyd(std::min(refinement_iterations, paper_.lloyd_iterations), FloodScope::all, true);
        best_.note(loop_.state());
        if (loop_.state().regions() == wanted_) return StopReason::regions;
        return wanted_ == 0 ? StopReason::converged : finish_number();
    }
    VariationalLoop& loop() noexcept { return loop_; }

  private:
    /// Section 4.2; with features, at least their groups (section 5.1).
    void initialise() {
        const std::size_t seeds = paper_.initial_regions > 0 ? paper_.initial_regions : wanted_;
        if (seeds <= loop_.component_count()) {
            loop_.start_from_components();
        } else {
            loop_.start_from_seeds(seeds);
        }
    }

    /// Merging and insertion (section 4.3.3) until a stop rule holds.
    StopReason finish_number() {
        StopReason reason = StopReason::converged;
        // Merges and insertions can undo each other for ever: twice as many insertions as there can be regions.
        const std::size_t bound = 2 * (wanted_ > 0 ? wanted_ : paper_.maximum_regions) + 16;
        for (std::size_t insertions = 0;; ++insertions) {
            merge_redundant();
            const std::size_t count = loop_.state().regions();
            if (wanted_ > 0 && count > wanted_) {
                if (!merge_cheapest()) break;  // every component, every feature group keeps a region
                --insertions;
                continue;
            }
            if (wanted_ > 0 ? count == wanted_ : well_approximated()) {
                reason = wanted_ > 0 ? StopReason::regions : StopReason::tolerance;
                break;
            }
            if (count >= paper_.maximum_regions) {
                reason = StopReason::maximum;
                break;
            }
            if (insertions >= bound || !insert_region()) break;
        }
        if (reason == StopReason::regions && paper_.teleportation) teleport_regions();
        lloyd_again();
        return reason;
    }

    bool well_approximated() const { return loop_.all_valid() && loop_.state().energy <= paper_.energy_threshold; }

    void lloyd(FloodScope scope) {
        loop_.progress = progress();
        loop_.lloyd(paper_.lloyd_iterations, scope, false);
        best_.note(loop_.state());
    }
    void lloyd_again() {
        loop_.lloyd(paper_.lloyd_iterations, FloodScope::all, true);
        best_.note(loop_.state());
    }

    /// Pairs whose common surface is as good as their own.
    void merge_redundant() {
        while (paper_.merging && (wanted_ == 0 || loop_.state().regions() < wanted_)) {
            const auto candidates = loop_.merge_candidates();
            if (candidates.empty() || !candidates[0].valid) return;
            const partition::MergeCandidate& best = candidates[0];
            const LoopState& state = loop_.state();
            if (!(best.increase < std::min(paper_.merge_tolerance, most_expensive_merge_))) return;
            if (!best_.is_progress(state.regions() - 1, state.energy + best.increase)) return;
            merge(best.pair);
        }
    }
    bool merge_cheapest() {
        const auto candidates = loop_.merge_candidates();
        if (candidates.empty()) return false;
        merge(candidates[0].pair);
        return true;
    }
    void merge(const partition::RegionPair& pair) {
        loop_.merge(pair.a, pair.b);
        best_.note(loop_.state());
        loop_.lloyd(paper_.lloyd_iterations, FloodScope::affected, true);
        best_.note(loop_.state());
    }

    /// Splits the first region of the paper's order in which the new region grows. Where none does, a wanted number of
    /// regions is reached by the insertion that saves most; without one, the loop has converged. False: no insertion.
    bool insert_region() {
        const LoopState before = loop_.state();
        const std::vector<std::uint32_t> order = loop_.regions_to_split();
        for (const std::uint32_t r : order) {
            if (fruitless_.contains(before.stamps[r])) continue;
            Attempt best;
            for (const int rounds : smoothing_rounds) {
                if (!insert_and_relax(r, rounds)) break;
                const double gain = before.energy - loop_.state().energy;
                if (is_worthwhile(before, r, gain)) {
                    most_expensive_merge_ = worthwhile_share * gain;
                    return true;
                }
                if (gain > best.gain) best = {gain, rounds};
                loop_.restore(before);
            }
            fruitless_[before.stamps[r]] = best;
        }
        if (wanted_ == 0 && paper_.merging) return false;
        const auto gain = [&](std::uint32_t r) { return fruitless_[before.stamps[r]].gain; };
        const auto most = std::max_element(order.begin(), order.end(),
                                           [&](std::uint32_t a, std::uint32_t b) { return gain(a) < gain(b); });
        if (most == order.end()) return false;
        most_expensive_merge_ = 0;
        return insert_and_relax(*most, fruitless_[before.stamps[*most]].rounds);
    }
    /// A region that saves less than ε is one that merging calls redundant.
    bool is_worthwhile(const LoopState& before, std::uint32_t split, double gain) const {
        if (gain < least_gain * before.fits[split].total) return false;
        if (wanted_ > 0 || !paper_.merging || gain >= paper_.merge_tolerance) return true;
        const auto invalid = [](const LoopState& state) {
            return std::count_if(state.fits.begin(), state.fits.end(), [](const auto& fit) { return !fit.valid; });
        };
        return invalid(loop_.state()) < invalid(before);
    }
    bool insert_and_relax(std::uint32_t region, int rounds) {
        const auto face = loop_.face_to_split(region, rounds);
        if (!face || !loop_.insert(*face)) return false;
        lloyd(FloodScope::affected);
        return true;
    }

    /// Region teleportation: a merge and an insertion elsewhere, kept when the energy falls. Where no pair promises to
    /// pay, the order is turned round: an insertion and the merge that it makes possible.
    void teleport_regions() {
        Failures failed;
        for (int i = 0; i < paper_.teleportations; ++i) {
            const LoopState before = loop_.state();
            const auto move = next_teleportation(failed);
            if (!move) return;
            try {
                const bool done = move->merge_first ? merge_and_insert(*move) : insert_and_merge(*move);
                if (done && loop_.state().energy < before.energy * (1 - least_progress)) {
                    best_.note(loop_.state());
                    continue;
                }
            } catch (const runtime::Stopped&) {
                loop_.restore(before);
                throw;
            }
            loop_.restore(before);
            ++failed[move->stamps];
        }
    }

    using Stamps = std::array<std::uint64_t, 3>;
    using Failures = std::map<Stamps, std::size_t>;  ///< how many attempts have failed
    struct Teleportation {
        std::uint32_t split = 0;
        bool merge_first = false;
        partition::RegionPair merge;
        bool restart = false;
        Stamps stamps{};  ///< of the region to split and of the pair: no region has stamp 0
    };

    /// The move of the largest promise: a split can save at most the energy of its region, so only the regions of
    /// largest energy are looked at.
    std::optional<Teleportation> next_teleportation(const Failures& failed) {
        const auto candidates = loop_.merge_candidates();
        const LoopState& state = loop_.state();
        std::vector<std::uint32_t> costly;
        for (std::uint32_t r = 0; r < state.regions(); ++r) {
            if (loop_.face_count(r) > 1 && state.fits[r].total > least_progress * state.energy) costly.push_back(r);
        }
        std::sort(costly.begin(), costly.end(), [&](std::uint32_t a, std::uint32_t b) {
            return state.fits[a].total != state.fits[b].total ? state.fits[a].total > state.fits[b].total : a < b;
        });
        if (costly.size() > teleport_regions_considered) costly.resize(teleport_regions_considered);
        const auto attempts = [&](const Stamps& stamps) {
            const auto found = failed.find(stamps);
            return found == failed.end() ? std::size_t{0} : found->second;
        };
        std::optional<Teleportation> best;
        double best_gain = 0;
        for (const partition::MergeCandidate& c : candidates) {
            if (!c.valid) break;
            for (const std::uint32_t r : costly) {
                if (r == c.pair.a || r == c.pair.b) continue;
                const Stamps stamps{state.stamps[r], state.stamps[c.pair.a], state.stamps[c.pair.b]};
                const double gain = teleport_share * state.fits[r].total - c.increase;
                if (!(gain > best_gain) || attempts(stamps) >= teleport_attempts) continue;
                best_gain = gain;
                best = Teleportation{r, true, c.pair, attempts(stamps) > 0, stamps};
            }
        }
        for (const std::uint32_t r : costly) {
            const Stamps stamps{state.stamps[r], 0, 0};
            if (best || attempts(stamps) >= teleport_attempts) continue;
            best = Teleportation{r, false, {}, attempts(stamps) > 0, stamps};
        }
        return best;
    }

    bool merge_and_insert(const Teleportation& move) {
        // merge() moves the last region to the larger label of the pair.
        const auto last = static_cast<std::uint32_t>(loop_.state().regions() - 1);
        const std::uint32_t split = move.split == last ? move.merge.b : move.split;
        const double before = loop_.state().energy;
        loop_.merge(move.merge.a, move.merge.b);
        const auto face = loop_.face_to_split(split);
        if (!face || !loop_.insert(*face, move.restart)) return false;
        return settle(before, false);
    }
    bool insert_and_merge(const Teleportation& move) {
        const double before = loop_.state().energy;
        const auto face = loop_.face_to_split(move.split);
        if (!face || !loop_.insert(*face, move.restart)) return false;
        loop_.lloyd(paper_.lloyd_iterations, FloodScope::affected, false);
        const auto candidates = loop_.merge_candidates();
        if (candidates.empty() || !candidates[0].valid) return false;
        if (loop_.state().energy + candidates[0].increase > hopeless_factor * before) return false;
        loop_.merge(candidates[0].pair.a, candidates[0].pair.b);
        return settle(before, true);
    }
    /// Lloyd iterations after a teleportation, few when they lead nowhere.
    bool settle(double before, bool start_counts) {
        loop_.lloyd(std::min(trial_iterations, paper_.lloyd_iterations), FloodScope::affected, start_counts);
        if (loop_.state().energy > hopeless_factor * before) return false;
        loop_.lloyd(paper_.lloyd_iterations, FloodScope::all, true);
        return true;
    }

    /// Share of the call: the flow has 0.2 to 0.9 of it.
    double progress() const {
        const auto count = static_cast<double>(loop_.state().regions());
        const double share = wanted_ > 0 ? count / static_cast<double>(wanted_) : count / (count + 20);
        return 0.2 + 0.6 * std::min(share, 1.0);
    }

    const PaperOptions& paper_;
    std::size_t wanted_;
    const runtime::RunControl& control_;
    VariationalLoop loop_;
    BestEnergies best_;
    struct Attempt {
        double gain = -std::numeric_limits<double>::max();
        int rounds = 0;
    };
    std::map<std::uint64_t, Attempt> fruitless_;  ///< best insertion into regions (by stamp) in which none grew
    /// While regions are still being inserted, a merge must cost less than what an insertion saves.
    double most_expensive_merge_ = std::numeric_limits<double>::max();
};

}  // namespace

FlowResult run_paper(const FlowInput& input, const partition::Labels* initial) {
    if (input.options.method == Method::hierarchical) return run_hierarchical(input);
    PaperFlow flow(input);
    FlowResult result;
    try {
        result.stop = initial != nullptr ? flow.refine(*initial) : flow.optimise();
        result.labels = flow.loop().state().labels;
    } catch (const runtime::Stopped& stopped) {
        result.partial = true;
        result.stop = stopped.deadline ? StopReason::deadline : StopReason::cancelled;
        result.labels = flow.loop().kept().labels;
    }
    std::vector<std::int32_t> renumbered;
    result.regions = partition::compact(result.labels, renumbered);
    if (!result.partial && input.options.method == Method::quadric) {
        const LoopState& state = flow.loop().state();
        result.fits.resize(result.regions);
        for (std::size_t r = 0; r < renumbered.size(); ++r) {
            if (renumbered[r] >= 0) result.fits[static_cast<std::size_t>(renumbered[r])] = state.fits[r];
        }
    }
    result.energies = std::move(flow.loop().energies);
    return result;
}

}  // namespace quadseg::flow
