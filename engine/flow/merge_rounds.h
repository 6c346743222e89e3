// Merging in rounds: pairs of adjacent regions are measured by all threads, then each region takes part in one merge a
// round, with its best partner. What two ways of measuring them have in common.
#pragma once

#include "partition/border_price.h"
#include "partition/leaves.h"
#include "partition/regions.h"
#include "runtime/parallel.h"
#include "runtime/run_control.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace quadseg::flow {

/// Two adjacent regions, a < b.
struct MergePair {
    std::uint32_t a = 0, b = 0;
    double border = 0;  ///< shared length
    double rise = 0;    ///< of the description length, when they become one
    bool measured = false;
};

/// Sums the borders of equal pairs in the order they stand in. Pairs become equal only by a merge, and those are to be
/// measured again anyway.
template <class Pair>
void unite_equal_pairs(std::vector<Pair>& pairs) {
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const Pair& x, const Pair& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (kept > 0 && pairs[kept - 1].a == pairs[i].a && pairs[kept - 1].b == pairs[i].b) {
            pairs[kept - 1].border += pairs[i].border;
        } else {
            pairs[kept++] = pairs[i];
        }
    }
    pairs.resize(kept);
}

/// All pairs of labels ≥ 0 that meet where the passage lets pass, in ascending order. Throws Stopped.
template <class Pair>
std::vector<Pair> merge_pairs_of(const partition::Passage& passage, const partition::Labels& labels,
                                 const runtime::RunControl& control) {
    constexpr std::size_t face_grain = 16384;
    const auto find = [&](std::size_t begin, std::size_t end, std::vector<Pair>& found) {
        control.check();
        for (std::size_t f = begin; f < end; ++f) {
            for (std::size_t k = 0; k < 3; ++k) {
                const std::int32_t g = passage.across(f, k);
                if (g < 0) continue;
                const std::int32_t a = labels[f], b = labels[static_cast<std::size_t>(g)];
                if (a < 0 || b <= a) continue;
                Pair pair;
                pair.a = static_cast<std::uint32_t>(a);
                pair.b = static_cast<std::uint32_t>(b);
                pair.border = partition::edge_length(*passage.mesh, f, k);
                found.push_back(pair);
            }
        }
    };
    std::vector<Pair> pairs = runtime::collect_blocks<Pair>(labels.size(), face_grain, find);
    unite_equal_pairs(pairs);
    return pairs;
}

/// Calls measure(pair), at once for several, for those that are not measured. Throws Stopped.
template <class Pair, class Measure>
void measure_pairs(std::vector<Pair>& pairs, const Measure& measure, const runtime::RunControl& control) {
    std::vector<std::uint32_t> unknown;
    for (std::uint32_t i = 0; i < pairs.size(); ++i) {
        if (!pairs[i].measured) unknown.push_back(i);
    }
    runtime::parallel_for(unknown.size(), 1, [&](std::size_t i) {
        control.check();
        measure(pairs[unknown[i]]);
        pairs[unknown[i]].measured = true;
    });
}

/// The merges of a round among the pairs that are acceptable(pair), the smallest merit(pair) first; ties by regions.
template <class Pair, class Acceptable, class Merit>
std::vector<Pair> best_merges(const std::vector<Pair>& pairs, std::size_t regions, const Acceptable& acceptable,
                              const Merit& merit) {
    std::vector<std::pair<double, std::uint32_t>> order;
    for (std::uint32_t i = 0; i < pairs.size(); ++i) {
        if (acceptable(pairs[i])) order.emplace_back(merit(pairs[i]), i);
    }
    std::sort(order.begin(), order.end());
    std::vector<std::uint8_t> taken(regions, 0);
    std::vector<Pair> merges;
    for (const auto& [unused, i] : order) {
        const Pair& p = pairs[i];
        if (taken[p.a] == 0 && taken[p.b] == 0) merges.push_back(p);
        taken[p.a] = taken[p.b] = 1;
    }
    return merges;
}

/// Region b of each merge goes by the name of a from now on; pairs of both are to be measured again.
template <class Pair>
void rename_merged(std::vector<Pair>& pairs, std::size_t regions, const std::vector<Pair>& merges) {
    std::vector<std::uint32_t> into(regions);
    for (std::uint32_t r = 0; r < into.size(); ++r) into[r] = r;
    std::vector<std::uint8_t> changed(regions, 0);
    for (const Pair& p : merges) {
        into[p.b] = p.a;
        changed[p.a] = changed[p.b] = 1;
    }
    for (Pair& p : pairs) {
        if (changed[p.a] != 0 || changed[p.b] != 0) p.measured = false;
        const std::uint32_t a = into[p.a], b = into[p.b];
        p.a = std::min(a, b);
        p.b = std::max(a, b);
    }
    std::erase_if(pairs, [](const Pair& p) { return p.a == p.b; });
    unite_equal_pairs(pairs);
}

}  // namespace quadseg::flow
