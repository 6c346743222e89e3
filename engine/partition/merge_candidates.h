// Pairs of adjacent regions and what their merging would cost (section 4.3.3).
#pragma once

#include "partition/pair_merge.h"
#include "partition/regions.h"
#include "runtime/run_control.h"

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace quadseg::partition {

/// How the method in use fits a region.
using FitFunction = std::function<quadric::RegionFit(const quadric::TriangleSoup&)>;

struct MergeCandidate {
    RegionPair pair;
    double increase = 0;  ///< E_ij − (E_i + E_j), signed: neither fits nor floods are exact minima, it may be negative
    bool valid = false;   ///< the common fit is an appropriate representation
};

/// What is known of a region.
struct MergeableRegion {
    std::span<const std::uint32_t> faces;
    double energy = 0;
    std::uint64_t stamp = 0;  ///< changes with every refit and is never used twice
};

/// Fits the union of two regions.
quadric::RegionFit fit_union(const mesh::WorkMesh& mesh, const MergeableRegion& a, const MergeableRegion& b,
                             const FitFunction& fit, const runtime::RunControl& control);

/// Evaluates pairs in parallel and remembers them by the stamps of their regions, so that only pairs of changed regions
/// are fitted again.
class MergeCandidates {
  public:
    /// All adjacent pairs by falling merit: valid first, then smallest increase, then pair.
    std::vector<MergeCandidate> evaluate(const mesh::WorkMesh& mesh, std::span<const RegionPair> pairs,
                                         std::span<const MergeableRegion> regions, const FitFunction& fit,
                                         const runtime::RunControl& control);

  private:
    struct Known {
        double increase;
        bool valid;
    };
    std::map<std::pair<std::uint64_t, std::uint64_t>, Known> known_;
};

}  // namespace quadseg::partition
