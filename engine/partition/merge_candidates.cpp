#include "partition/merge_candidates.h"

#include "runtime/parallel.h"

#include <algorithm>
#include <limits>

namespace quadseg::partition {

quadric::RegionFit fit_union(const mesh::WorkMesh& mesh, const MergeableRegion& a, const MergeableRegion& b,
                             const FitFunction& fit, const runtime::RunControl& control) {
    std::vector<std::uint32_t> faces(a.faces.size() + b.faces.size());
    std::merge(a.faces.begin(), a.faces.end(), b.faces.begin(), b.faces.end(), faces.begin());
    GatheredRegion gathered;
    gather(mesh, faces.data(), faces.size(), gathered, &control);
    return fit(gathered.soup());
}

std::vector<MergeCandidate> MergeCandidates::evaluate(const mesh::WorkMesh& mesh, std::span<const RegionPair> pairs,
                                                      std::span<const MergeableRegion> regions, const FitFunction& fit,
                                                      const runtime::RunControl& control) {
    const auto region = [&](std::uint32_t r) -> const MergeableRegion& { return regions[r]; };
    const auto stamps = [&](const RegionPair& p) {
        const auto [low, high] = std::minmax(region(p.a).stamp, region(p.b).stamp);
        return std::pair{low, high};
    };
    std::vector<MergeCandidate> candidates(pairs.size());
    std::vector<std::size_t> unknown;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        candidates[i].pair = pairs[i];
        const auto found = known_.find(stamps(pairs[i]));
        if (found == known_.end()) {
            unknown.push_back(i);
        } else {
            candidates[i].increase = found->second.increase;
            candidates[i].valid = found->second.valid;
        }
    }
    runtime::parallel_for(unknown.size(), 1, [&](std::size_t i) {
        control.check();
        MergeCandidate& c = candidates[unknown[i]];
        const MergeableRegion &a = region(c.pair.a), &b = region(c.pair.b);
        const quadric::RegionFit common = fit_union(mesh, a, b, fit, control);
        c.increase = common.total - (a.energy + b.energy);
        c.valid = common.valid;
        if (!(c.increase < std::numeric_limits<double>::max())) {  // also NaN
            c.increase = std::numeric_limits<double>::max();
            c.valid = false;
        }
    });
    known_.clear();
    for (const MergeCandidate& c : candidates) known_[stamps(c.pair)] = {c.increase, c.valid};
    std::sort(candidates.begin(), candidates.end(), [](const MergeCandidate& x, const MergeCandidate& y) {
        if (x.valid != y.valid) return x.valid;
        if (x.increase != y.increase) return x.increase < y.increase;
        return x.pair.a != y.pair.a ? x.pair.a < y.pair.a : x.pair.b < y.pair.b;
    });
    return candidates;
}

}  // namespace quadseg::partition
