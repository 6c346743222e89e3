// Edge-connected sets of faces, found by all threads at once.
#pragma once

#include "mesh/work_mesh.h"
#include "runtime/parallel.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace quadseg::mesh {

/// Union-find whose root is the smallest member: the result does not depend on the order of the unions, so they may run
/// at once (a root is only ever linked to a smaller one). Members come in blocks: first each block is joined in itself,
/// in ascending order and by one thread, which needs no care; then what lies in different blocks.
class SmallestRoot {
  public:
    explicit SmallestRoot(std::size_t size) : parent_(std::make_unique_for_overwrite<std::uint32_t[]>(size)) {}

    /// Adds member i and unites it with the sets of three members of its block, each earlier or i itself. As much as
    /// can be is done without branches: which neighbours come earlier is anybody's guess.
    void add(std::uint32_t i, const std::array<std::uint32_t, 3>& with) noexcept {
        parent_[i] = i;
        const std::uint32_t a = find_alone(with[0]), b = find_alone(with[1]), c = find_alone(with[2]);
        const std::uint32_t root = std::min({a, b, c});
        parent_[a] = parent_[b] = parent_[c] = parent_[i] = root;
    }

    /// After the last member of a block: all of them point to their root.
    void flatten(std::size_t begin, std::size_t end) noexcept {
        for (std::size_t i = begin; i < end; ++i) parent_[i] = parent_[parent_[i]];  // parents come earlier: done
    }

    bool is_root(std::size_t i) noexcept { return load(static_cast<std::uint32_t>(i)) == i; }

    std::uint32_t find(std::uint32_t i) noexcept {
        for (;;) {
            const std::uint32_t p = load(i);
            if (p == i) return i;
            const std::uint32_t grandparent = load(p);
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

  private:
    std::uint32_t find_alone(std::uint32_t i) noexcept {
        std::uint32_t root = parent_[parent_[i]];
        while (parent_[root] != root) {
            parent_[i] = root;
            i = root;
            root = parent_[parent_[i]];
        }
        return root;
    }
    std::atomic_ref<std::uint32_t> at(std::uint32_t i) noexcept { return std::atomic_ref<std::uint32_t>(parent_[i]); }
    std::uint32_t load(std::uint32_t i) noexcept { return at(i).load(std::memory_order_relaxed); }
    std::unique_ptr<std::uint32_t[]> parent_;  // not a vector: all threads touch it first
};

/// Sets of the wanted faces that edges connect across which together(f, k, g) holds; numbered by first face in `part`,
/// −1 for the others. Returns their number. `together` is asked about two wanted faces only and must not depend on the
/// side from which it is asked; poll() is called now and then and may throw.
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
        for (std::size_t f = begin; f < end; ++f) {
            const auto own = static_cast<std::uint32_t>(f);
            std::array<std::uint32_t, 3> with{own, own, own};
            const std::size_t sides = wanted(f) ? 3 : 0;
            for (std::size_t k = 0; k < sides; ++k) {
                const auto g = static_cast<std::uint32_t>(mesh.neighbors[f][k]);
                const std::uint32_t other = g < own ? g : own;  // no_face is above all of them
                const bool joined = other != own && wanted(other) && together(f, k, other);
                with[k] = joined && other >= begin ? other : own;
                if (other < begin && joined) outward[begin / block].emplace_back(own, other);
            }
            sets.add(own, with);
        }
        sets.flatten(begin, end);
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
