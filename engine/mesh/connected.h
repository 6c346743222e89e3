// Edge-connected sets of faces, found by all threads at once.
#pragma once

#include "mesh/work_mesh.h"
#include "runtime/parallel.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace quadseg::mesh {

/// Union-find whose root is the smallest member: the result does not depend on the order of the unions, so they may run
/// at once (a root is only ever linked to a smaller one).
class SmallestRoot {
  public:
    /// start() comes first.
    explicit SmallestRoot(std::size_t size) : parent_(std::make_unique_for_overwrite<std::uint32_t[]>(size)) {}

    void start(std::size_t begin, std::size_t end) noexcept {
        for (std::size_t i = begin; i < end; ++i) parent_[i] = static_cast<std::uint32_t>(i);
    }

    bool is_root(std::size_t i) noexcept {
        return at(static_cast<std::uint32_t>(i)).load(std::memory_order_relaxed) == i;
    }

    std::uint32_t find(std::uint32_t i) noexcept {
        for (;;) {
            const std::uint32_t p = at(i).load(std::memory_order_relaxed);
            if (p == i) return i;
            const std::uint32_t grandparent = at(p).load(std::memory_order_relaxed);
            if (grandparent != p) at(i).store(grandparent, std::memory_order_relaxed);
            i = p;
        }
    }

    void join(std::uint32_t a, std::uint32_t b) noexcept {
        for (;;) {
            a = find(a);
            b = find(b);
            if (a == b) return;
            if (a < b) std::swap(a, b);
            std::uint32_t expected = a;
            if (at(a).compare_exchange_strong(expected, b, std::memory_order_relaxed)) return;
        }
    }

    /// The same where no other thread knows of the two sets yet.
    void join_alone(std::uint32_t a, std::uint32_t b) noexcept {
        a = find(a);
        b = find(b);
        at(std::max(a, b)).store(std::min(a, b), std::memory_order_relaxed);
    }

  private:
    std::atomic_ref<std::uint32_t> at(std::uint32_t i) noexcept { return std::atomic_ref<std::uint32_t>(parent_[i]); }
    std::unique_ptr<std::uint32_t[]> parent_;  // not a vector: all threads touch it first
};

/// Sets of the wanted faces that edges connect across which together(f, k, g) holds; numbered by first face in `part`,
/// −1 for the others. Returns their number. `together` must not depend on the side from which it is asked; poll() is
/// called now and then and may throw.
template <class Wanted, class Together, class Poll>
std::size_t connected_faces(const WorkMesh& mesh, const Wanted& wanted, const Together& together, const Poll& poll,
                            std::vector<std::int32_t>& part) {
    constexpr std::size_t block = 8192;
    const std::size_t faces = mesh.face_count();
    const std::size_t blocks = (faces + block - 1) / block;
    SmallestRoot sets(faces);
    // Faces are numbered along a curve: few edges lead out of a block, and only those concern other threads.
    std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>> outward(blocks);
    runtime::parallel_blocks(faces, block, [&](std::size_t begin, std::size_t end) {
        poll();
        sets.start(begin, end);
        for (std::size_t f = begin; f < end; ++f) {
            if (!wanted(f)) continue;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::int32_t g = mesh.neighbors[f][k];
                if (g < 0 || static_cast<std::size_t>(g) >= f) continue;
                const auto other = static_cast<std::uint32_t>(g);
                if (!wanted(other) || !together(f, k, other)) continue;
                const auto own = static_cast<std::uint32_t>(f);
                if (other >= begin) {
                    sets.join_alone(own, other);
                } else {
                    outward[begin / block].emplace_back(own, other);
                }
            }
        }
    });
    runtime::parallel_for(blocks, 1, [&](std::size_t b) {
        for (const auto& [f, g] : outward[b]) sets.join(f, g);
    });
    // A root is the first face of its set: numbering the roots in order numbers the sets by first face.
    const auto is_root = [&](std::size_t f) { return sets.is_root(f) && wanted(f); };
    std::vector<std::size_t> roots_before(blocks, 0);
    runtime::parallel_blocks(faces, block, [&](std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f) roots_before[begin / block] += is_root(f) ? 1 : 0;
    });
    const std::size_t count = runtime::exclusive_scan(roots_before);
    poll();
    std::vector<std::int32_t> result(faces);
    runtime::parallel_blocks(faces, block, [&](std::size_t begin, std::size_t end) {
        std::size_t next = roots_before[begin / block];
        for (std::size_t f = begin; f < end; ++f) result[f] = is_root(f) ? static_cast<std::int32_t>(next++) : -1;
    });
    poll();
    runtime::parallel_for(faces, block, [&](std::size_t f) {
        if (!wanted(f)) return;
        const std::uint32_t root = sets.find(static_cast<std::uint32_t>(f));
        if (root != f) result[f] = result[root];
    });
    part = std::move(result);  // only now: wanted and together may look at it
    return count;
}

}  // namespace quadseg::mesh
