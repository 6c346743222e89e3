// Greedy merging of adjacent regions on additive moments: no face is visited again.
#pragma once

#include <quadseg/segmentation.h>

#include "partition/leaves.h"
#include "partition/regions.h"
#include "quadric/moments.h"
#include "runtime/run_control.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace quadseg::partition {

/// What a region costs: the number that merging keeps small, the plain energy in it, the parameters of its surface.
struct RegionScore {
    double cost = 0;
    double energy = 0;
    int dof = 3;
    double distance = 0;  ///< ∫ d², where MergeRules::tolerance asks for it
};
/// Pure and callable from several threads at once.
using Scorer = std::function<RegionScore(const quadric::Moments&)>;

/// Moments about the region's own centroid (MATH.md §3: in one global frame they are numerically dead).
struct MergeRegion {
    Vec3 origin;
    quadric::Moments moments;
    RegionScore score;
};

/// One a label 0 … count−1, in parallel. Faces of label −1 are left out.
std::vector<MergeRegion> measure_regions(const mesh::WorkMesh& mesh, const Labels& labels, std::size_t count,
                                         const Scorer& scorer, const runtime::RunControl& control);

/// Adjacent regions a < b, ascending.
struct RegionPair {
    std::uint32_t a = 0, b = 0;
};
std::vector<RegionPair> region_pairs(const Passage& passage, const Labels& labels, const runtime::RunControl& control);

/// Allowance for what noise hides: of large areas a share of their energy, of areas far below blur_area nothing.
inline double blurred(double blur, double blur_area, double area) noexcept {
    return blur > 0 ? blur * area * area / (area + blur_area) : 0;
}

struct MergeRules {
    bool only_acceptable = false;  ///< the rule below holds on the way to the target as well
    std::size_t target = 0;  ///< merge down to this many regions, whatever it costs; 0: as long as a pair is acceptable
    /// Acceptable: cost(ij) − cost(i) − cost(j) ≤ misfit · min(area) + blurred(min(area)) + noise · (dof(i) + dof(j) −
    /// dof(ij)).
    double misfit = 0;
    double blur = 0, blur_area = 0;
    double noise = 0;
    /// When > 0 instead of those: the RMS distance of the union, sqrt(distance / area), is at most this.
    double tolerance = 0;
    bool labels_only = false;  ///< Merging::regions stays empty: of a million regions it is half a gigabyte to move
    int passes = 8;            ///< rejected pairs are looked at again so often, while anything merges
};

struct Merging {
    std::vector<std::int32_t> region_of;  ///< fragment → region 0 … n−1, by first fragment
    std::vector<MergeRegion> regions;
    std::vector<MergeStep> history;  ///< energies: sums of RegionScore::energy
    bool stopped = false;            ///< by control: the merges made so far stand
};

/// Lazy: one heap of pairs keyed by the rise in cost; a stale pair is measured again only when it comes up. Ties by
/// ids, so the result does not depend on the number of threads.
Merging merge_pairs(std::vector<MergeRegion> fragments, std::vector<RegionPair> pairs, const MergeRules& rules,
                    const Scorer& scorer, const runtime::RunControl& control);

}  // namespace quadseg::partition
