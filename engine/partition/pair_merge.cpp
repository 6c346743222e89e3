#include "partition/pair_merge.h"

#include "quadric/ladder.h"
#include "quadric/moment_accumulator.h"
#include "runtime/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace quadseg::partition {
namespace {

constexpr std::size_t face_grain = 16384;
constexpr std::size_t region_grain = 64;
constexpr std::size_t pair_grain = 256;
constexpr std::size_t least_packed = 8;  ///< faces of a region from which on moments on packs are cheaper

std::uint64_t pair_key(std::uint32_t a, std::uint32_t b) noexcept {
    return std::uint64_t{a} << 32U | b;
}

/// Remembers for a pair of regions at which state of theirs it was measured last.
class MeasuredPairs {
  public:
    explicit MeasuredPairs(std::size_t expected) {
        std::size_t size = 64;
        while (size < 2 * expected) size *= 2;
        slots_.resize(size);
    }
    /// True when (pair, stamp) is new; then it is remembered.
    bool insert(std::uint64_t key, std::uint32_t stamp) {
        if (2 * (used_ + 1) > slots_.size()) grow();
        Slot& slot = find(key);
        if (slot.key == key && slot.stamp == stamp) return false;
        if (slot.key == empty) ++used_;
        slot = {key, stamp};
        return true;
    }

  private:
    static constexpr std::uint64_t empty = std::numeric_limits<std::uint64_t>::max();
    struct Slot {
        std::uint64_t key = empty;
        std::uint32_t stamp = 0;
    };
    Slot& find(std::uint64_t key) noexcept {
        std::uint64_t h = (key ^ key >> 29U) * 0x9e3779b97f4a7c15ULL;
        h ^= h >> 32U;
        const std::size_t mask = slots_.size() - 1;
        std::size_t i = static_cast<std::size_t>(h) & mask;
        while (slots_[i].key != empty && slots_[i].key != key) i = (i + 1) & mask;
        return slots_[i];
    }
    void grow() {
        std::vector<Slot> old(2 * slots_.size());
        old.swap(slots_);
        for (const Slot& slot : old) {
            if (slot.key != empty) find(slot.key) = slot;
        }
    }
    std::vector<Slot> slots_;
    std::size_t used_ = 0;
};

class Merger {
  public:
    Merger(std::vector<MergeRegion>&& fragments, const MergeRules& rules, const Scorer& scorer,
           const runtime::RunControl& control)
        : regions_(std::move(fragments)),
          rules_(rules),
          scorer_(scorer),
          control_(control),
          parent_(regions_.size()),
          version_(regions_.size(), 0),
          alive_(regions_.size()) {
        std::iota(parent_.begin(), parent_.end(), 0U);
        for (const MergeRegion& r : regions_) energy_ += r.score.energy;
    }

    Merging run(std::vector<RegionPair>&& pairs) {
        Merging result;
        const int passes = rules_.target > 0 ? 1 : std::max(1, rules_.passes);
        for (int pass = 0; pass < passes && !pairs.empty() && alive_ > rules_.target; ++pass) {
            const std::size_t before = alive_;
            merge_pass(pairs, result);
            if (result.stopped || alive_ == before) break;
            pairs = root_pairs(pairs);
        }
        collect(result);
        return result;
    }

  private:
    struct Entry {
        double rise;
        std::uint32_t a, b, stamp;
        /// std heaps keep the largest on top: the smallest rise, then the smallest ids.
        friend bool operator<(const Entry& x, const Entry& y) noexcept {
            if (x.rise != y.rise) return x.rise > y.rise;
            if (x.a != y.a) return x.a > y.a;
            if (x.b != y.b) return x.b > y.b;
            return x.stamp > y.stamp;
        }
    };

    std::uint32_t root(std::uint32_t i) noexcept {
        while (parent_[i] != i) {
            parent_[i] = parent_[parent_[i]];
            i = parent_[i];
        }
        return i;
    }
    std::uint32_t stamp_of(std::uint32_t a, std::uint32_t b) const noexcept {
        return std::max(version_[a], version_[b]);
    }

    static Vec3 joint_origin(const MergeRegion& a, const MergeRegion& b) noexcept {
        const double area = a.moments.total_area + b.moments.total_area;
        if (!(area > 0)) return a.origin;
        return a.origin + (b.origin - a.origin) * (b.moments.total_area / area);
    }
    MergeRegion join(const MergeRegion& a, const MergeRegion& b) const {
        MergeRegion r;
        r.origin = joint_origin(a, b);
        r.moments = quadric::joined(a.moments, a.origin, b.moments, b.origin, r.origin);
        r.score = scorer_(r.moments);
        return r;
    }
    double rise_of(std::uint32_t a, std::uint32_t b) const {
        const double rise = join(regions_[a], regions_[b]).score.cost - regions_[a].score.cost - regions_[b].score.cost;
        return std::isnan(rise) ? std::numeric_limits<double>::max() : rise;
    }
    bool acceptable(const Entry& e, const MergeRegion& joint) const noexcept {
        if (rules_.tolerance > 0) {
            return joint.score.distance <= rules_.tolerance * rules_.tolerance * joint.moments.total_area;
        }
        const MergeRegion &a = regions_[e.a], &b = regions_[e.b];
        const double saved = a.score.dof + b.score.dof - joint.score.dof;
        const double smaller = std::min(a.moments.total_area, b.moments.total_area);
        return e.rise <=
               rules_.misfit * smaller + blurred(rules_.blur, rules_.blur_area, smaller) + rules_.noise * saved;
    }

    std::vector<RegionPair> root_pairs(const std::vector<RegionPair>& pairs) {
        std::vector<std::uint64_t> keys;
        keys.reserve(pairs.size());
        for (const RegionPair& p : pairs) {
            const std::uint32_t a = root(p.a), b = root(p.b);
            if (a != b) keys.push_back(pair_key(std::min(a, b), std::max(a, b)));
        }
        std::sort(keys.begin(), keys.end());
        keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
        std::vector<RegionPair> roots;
        roots.reserve(keys.size());
        for (const std::uint64_t k : keys) {
            roots.push_back({static_cast<std::uint32_t>(k >> 32U), static_cast<std::uint32_t>(k)});
        }
        return roots;
    }

    std::vector<Entry> measure(const std::vector<RegionPair>& pairs, bool& stopped) const {
        std::vector<Entry> heap(pairs.size());
        runtime::parallel_blocks(pairs.size(), pair_grain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                // The score of a pair takes a third of a millisecond where quadrics are fitted.
                if ((i & 7U) == 0 && control_.should_stop()) return;
                const auto [a, b] = pairs[i];
                heap[i] = {rise_of(a, b), a, b, stamp_of(a, b)};
            }
        });
        stopped = control_.should_stop();
        return heap;
    }

    void merge_pass(const std::vector<RegionPair>& pairs, Merging& result) {
        std::vector<Entry> heap = measure(pairs, result.stopped);
        if (result.stopped) return;
        MeasuredPairs measured(pairs.size());
        for (std::size_t i = 0; i < heap.size(); ++i) {
            if ((i & 16383U) == 0 && control_.should_stop()) {
                result.stopped = true;
                return;
            }
            measured.insert(pair_key(heap[i].a, heap[i].b), heap[i].stamp);
        }
        std::make_heap(heap.begin(), heap.end());
        for (std::size_t count = 0; !heap.empty() && alive_ > rules_.target; ++count) {
            if ((count & 7U) == 0 && control_.should_stop()) {
                result.stopped = true;
                return;
            }
            std::pop_heap(heap.begin(), heap.end());
            Entry e = heap.back();
            heap.pop_back();
            const std::uint32_t ra = root(e.a), rb = root(e.b);
            if (ra == rb) continue;
            const std::uint32_t a = std::min(ra, rb), b = std::max(ra, rb), stamp = stamp_of(a, b);
            if (e.a != a || e.b != b || e.stamp != stamp) {
                if (!measured.insert(pair_key(a, b), stamp)) continue;
                e = {rise_of(a, b), a, b, stamp};
                if (!heap.empty() && e < heap.front()) {
                    heap.push_back(e);
                    std::push_heap(heap.begin(), heap.end());
                    continue;
                }
            }
            const MergeRegion joint = join(regions_[a], regions_[b]);
            if ((rules_.target == 0 || rules_.only_acceptable) && !acceptable(e, joint)) continue;
            merge(a, b, joint, result);
        }
    }

    void merge(std::uint32_t a, std::uint32_t b, const MergeRegion& joint, Merging& result) {
        energy_ += joint.score.energy - regions_[a].score.energy - regions_[b].score.energy;
        regions_[a] = joint;
        parent_[b] = a;
        version_[a] = ++merges_;
        --alive_;
        result.history.push_back({static_cast<std::uint32_t>(alive_), energy_});
    }

    void collect(Merging& result) {
        result.region_of.resize(parent_.size());
        std::uint32_t next = 0;
        for (std::uint32_t i = 0; i < parent_.size(); ++i) {
            const std::uint32_t r = root(i);  // the first fragment of its region
            if (r == i) {
                if (next != i && !rules_.labels_only) regions_[next] = regions_[i];
                result.region_of[i] = static_cast<std::int32_t>(next++);
            } else {
                result.region_of[i] = result.region_of[r];
            }
        }
        if (rules_.labels_only) return;
        regions_.resize(next);
        result.regions = std::move(regions_);  // in its place: where little has merged, a copy takes long
    }

    std::vector<MergeRegion> regions_;
    const MergeRules& rules_;
    const Scorer& scorer_;
    const runtime::RunControl& control_;
    std::vector<std::uint32_t> parent_;
    std::vector<std::uint32_t> version_;  ///< number of the merge that made the region: unique, so it stamps its pairs
    std::size_t alive_;
    std::uint32_t merges_ = 0;
    double energy_ = 0;
};

}  // namespace

std::vector<MergeRegion> measure_regions(const mesh::WorkMesh& mesh, const Labels& labels, std::size_t count,
                                         const Scorer& scorer, const runtime::RunControl& control) {
    control.check();
    const RegionFaces faces = region_faces(labels, count);
    control.check();
    std::vector<MergeRegion> regions(count);
    runtime::parallel_blocks(count, region_grain, [&](std::size_t begin, std::size_t end) {
        std::size_t polled = 0;
        for (std::size_t r = begin; r < end; ++r) {
            Vec3 weighted, plain;
            double area = 0;
            for (std::size_t i = faces.begin[r]; i < faces.begin[r + 1]; ++i) {
                const std::size_t f = faces.face[i];
                const Vec3 c = mesh.centroid(f);
                weighted += c * mesh.areas[f];
                plain += c;
                area += mesh.areas[f];
            }
            MergeRegion& region = regions[r];
            if (faces.size(r) == 0) continue;
            region.origin = area > 0 ? weighted / area : plain / static_cast<double>(faces.size(r));
            const auto for_each_face = [&](const auto& add) {
                for (std::size_t i = faces.begin[r]; i < faces.begin[r + 1]; ++i) {
                    if ((++polled & 4095U) == 0) control.check();
                    const std::size_t f = faces.face[i];
                    add(mesh.corner(f, 0) - region.origin, mesh.corner(f, 1) - region.origin,
                        mesh.corner(f, 2) - region.origin, mesh.normals[f], mesh.areas[f]);
                }
            };
            if (faces.size(r) < least_packed) {
                for_each_face([&](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& n, double face_area) {
                    quadric::accumulate(region.moments, a, b, c, n, face_area);
                });
            } else {
                quadric::MomentAccumulator sum;
                for_each_face([&](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& n, double face_area) {
                    sum.add(a, b, c, n, face_area);
                });
                region.moments = sum.moments();
            }
            region.score = scorer(region.moments);
            control.check();
        }
    });
    return regions;
}

std::vector<RegionPair> region_pairs(const Passage& passage, const Labels& labels, const runtime::RunControl& control) {
    const auto find = [&](std::size_t begin, std::size_t end, std::vector<std::uint64_t>& keys) {
        control.check();
        for (std::size_t f = begin; f < end; ++f) {
            if (labels[f] < 0) continue;
            const auto a = static_cast<std::uint32_t>(labels[f]);
            for (std::size_t k = 0; k < 3; ++k) {
                const std::int32_t g = passage.across(f, k);
                if (g < 0 || labels[static_cast<std::size_t>(g)] < 0) continue;
                const auto b = static_cast<std::uint32_t>(labels[static_cast<std::size_t>(g)]);
                if (a < b) keys.push_back(pair_key(a, b));
            }
        }
        std::sort(keys.begin(), keys.end());
        keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    };
    std::vector<std::uint64_t> all = runtime::collect_blocks<std::uint64_t>(labels.size(), face_grain, find);
    if (labels.size() > face_grain) {
        runtime::parallel_sort(all.begin(), all.end(), std::less<>());
        all.erase(std::unique(all.begin(), all.end()), all.end());
    }
    std::vector<RegionPair> pairs;
    pairs.reserve(all.size());
    for (const std::uint64_t k : all) {
        pairs.push_back({static_cast<std::uint32_t>(k >> 32U), static_cast<std::uint32_t>(k)});
    }
    return pairs;
}

Merging merge_pairs(std::vector<MergeRegion> fragments, std::vector<RegionPair> pairs, const MergeRules& rules,
                    const Scorer& scorer, const runtime::RunControl& control) {
    return Merger(std::move(fragments), rules, scorer, control).run(std::move(pairs));
}

}  // namespace quadseg::partition
