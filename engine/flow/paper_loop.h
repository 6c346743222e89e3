// The moves of the paper's section 4, one by one: what run_paper strings together and Segmenter offers to its user.
#pragma once

#include "flow/flow.h"
#include "flow/methods.h"
#include "partition/flood.h"
#include "partition/merge_candidates.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace quadseg::flow {

/// A partition with its proxies: everything that a step needs of the step before it. Copied for undo and "keep best".
struct LoopState {
    partition::Labels labels;
    std::vector<quadric::RegionFit> fits;
    std::vector<std::uint32_t> seeds;
    std::vector<std::uint64_t> stamps;  ///< of the fits, never used twice
    std::vector<double> density;        ///< E/area of every face with respect to its region's proxy
    double energy = 0;

    std::size_t regions() const noexcept { return fits.size(); }
};

/// Which regions a Lloyd run re-floods. `affected`: those whose proxy changed and their neighbours; faces between two
/// regions of unchanged proxies have no reason to move. `all`: the paper's step to the letter.
enum class FloodScope { affected, all };

class VariationalLoop {
  public:
    explicit VariationalLoop(const FlowInput& input);
    VariationalLoop(const VariationalLoop&) = delete;  // its fits ask its own control whether to go on
    VariationalLoop& operator=(const VariationalLoop&) = delete;

    /// Section 4.2: a seed in each component (feature group) and random ones up to `count`, each with the plane of its
    /// face; one flood and fit.
    void start_from_seeds(std::size_t count);
    /// Any labels 0 … n−1 without gaps, connected or not: fits them as they are. −1 is not allowed.
    void start_from_labels(const partition::Labels& labels);
    /// The partition into components (feature groups), fitted.
    void start_from_components();

    /// Watched from now on instead of FlowInput::control.
    void set_control(const runtime::RunControl& control) noexcept { control_ = &control; }

    const LoopState& state() const noexcept { return state_; }
    /// The last complete state: what is left after Stopped.
    const LoopState& kept() const noexcept { return kept_; }
    void restore(const LoopState& state);

    /// Lloyd iteration (section 4.3): regroup, fit and update seeds until the energy converges, at most `iterations`
    /// times. The best state is kept; the state at the start counts only with `start_counts`. Regions changed by
    /// insert() and merge() since the last run begin as affected. Returns the number of iterations.
    int lloyd(int iterations, FloodScope scope, bool start_counts);

    /// Section 4.3.3. All adjacent pairs, best first.
    std::vector<partition::MergeCandidate> merge_candidates();
    partition::MergeCandidate merge_candidate(std::uint32_t a, std::uint32_t b) const;
    /// Joins two adjacent regions and fits the union; the last region takes the free label max(a, b).
    void merge(std::uint32_t a, std::uint32_t b);
    /// Regions in the order in which they are to be split: invalid ones first, then by falling error density.
    std::vector<std::uint32_t> regions_to_split() const;
    /// New region with the plane of `face` as its proxy; it has no faces until the next Lloyd run. False when the
    /// face's region has no other face. With `restart` the split region starts over too, from the plane of its face
    /// that fits the new plane worst: both halves are then free of the old common surface.
    bool insert(std::uint32_t face, bool restart = false);
    /// Face where the region is worst: the paper's rule, or of densities smoothed `rounds` times. None: no face but the
    /// seed.
    std::optional<std::uint32_t> face_to_split(std::uint32_t region, int rounds = 0) const;

    std::size_t component_count() const noexcept { return component_count_; }
    const partition::Passage& passage() const noexcept { return passage_; }
    bool all_valid() const noexcept;
    /// Both terms of the energy, total as Options::weight has it whatever the method.
    Energy energy_terms() const;
    double area(std::size_t region) const { return areas_[region]; }
    std::size_t face_count(std::size_t region) const { return faces_[region].size(); }

    std::vector<double> energies;  ///< total energy after every Lloyd iteration
    double progress = 0.2;         ///< share of the call, for reports

  private:
    std::vector<std::uint32_t> affected_regions() const;
    void sort_faces(std::vector<std::uint32_t>& faces) const;
    void regroup(const std::vector<std::uint32_t>& regions);
    void fit_regions();
    void update_seeds();
    void list_faces();
    void add_up();
    partition::MergeableRegion mergeable(std::size_t region) const;

    const mesh::WorkMesh& mesh_;
    const Options& options_;
    const runtime::RunControl* control_;
    partition::Passage passage_;
    MethodPolicy policy_;
    partition::Flood flood_;
    partition::MergeCandidates candidates_;
    partition::Labels components_;
    std::size_t component_count_ = 0;

    LoopState state_, kept_;
    std::vector<std::vector<std::uint32_t>> faces_;  ///< of every region, ascending
    std::vector<double> areas_;
    std::vector<std::uint8_t> new_proxy_;  ///< by region: proxy or seed changed since its faces were flooded
    std::vector<std::uint8_t> new_faces_;  ///< by region: faces changed since it was fitted
    std::uint64_t next_stamp_ = 1;
};

}  // namespace quadseg::flow
