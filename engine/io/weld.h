// Equal positions become one vertex, numbered by first occurrence: the same at any number of threads.
#pragma once

#include "io/polled_resize.h"
#include "runtime/parallel.h"
#include "runtime/run_control.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <vector>

namespace quadseg::io {

/// Bits of a position. Negative zero must have been made positive.
template <class Word>
using PositionKey = std::array<Word, 3>;

template <class Real>
auto position_key(const Real* position) noexcept {
    using Word = std::conditional_t<sizeof(Real) == 4, std::uint32_t, std::uint64_t>;
    // x + 0 turns −0 into +0 and changes nothing else.
    return PositionKey<Word>{std::bit_cast<Word>(position[0] + Real{0}), std::bit_cast<Word>(position[1] + Real{0}),
                             std::bit_cast<Word>(position[2] + Real{0})};
}

template <class Word>
std::uint64_t hash(const PositionKey<Word>& key) noexcept {
    std::uint64_t h = 0;
    for (const Word word : key) {
        h = (h ^ word) * 0x9E3779B97F4A7C15U;
        h ^= h >> 32U;
    }
    h *= 0xD6E8FEB86659FD93U;
    return h ^ (h >> 32U);
}

struct Weld {
    std::vector<std::uint32_t> vertex_of;     ///< a corner
    std::vector<std::uint32_t> first_corner;  ///< a vertex; ascending
};

/// Corners that repeat one of a little earlier are found at once; the rest is dealt out by hash into parts whose tables
/// fit the cache and are filled at the same time.
template <class KeyOf>
class Welder {
  public:
    Welder(std::size_t corners, const KeyOf& key_of, const runtime::RunControl& control)
        : count_(corners), key_of_(key_of), control_(control) {
        while ((count_ >> part_bits_) > largest_part && part_bits_ < largest_part_bits) ++part_bits_;
    }

    Weld weld() {
        std::vector<std::uint32_t> first_of;
        polled_resize(first_of, count_, control_);
        deal_out(first_of);
        runtime::parallel_for(parts(), 1, [&](std::size_t p) {
            control_.check();
            find_first(part_begin_[p], part_begin_[p + 1], first_of);
        });
        entries_.reset();
        return number(first_of);
    }

  private:
    using Key = std::invoke_result_t<KeyOf, std::size_t>;
    struct Entry {
        Key key;
        std::uint32_t corner;
    };

    static constexpr std::size_t largest_part = 16384;
    static constexpr unsigned largest_part_bits = 11;
    static constexpr std::size_t grain = 65536;
    static constexpr std::size_t recent_slots = 4096;
    static constexpr auto nothing = static_cast<std::uint32_t>(-1);

    std::size_t parts() const noexcept { return std::size_t{1} << part_bits_; }
    std::size_t part_of(std::uint64_t h) const noexcept {
        return part_bits_ == 0 ? 0 : static_cast<std::size_t>(h >> (64U - part_bits_));
    }

    /// first_of[c] = an earlier corner of the block at the same position if it is recent, else c. Counts the latter.
    void find_recent(std::size_t begin, std::size_t end, std::vector<std::uint32_t>& first_of,
                     std::size_t* counts) const {
        std::array<std::uint32_t, recent_slots> recent;
        recent.fill(nothing);
        for (std::size_t c = begin; c < end; ++c) {
            const Key key = key_of_(c);
            const std::uint64_t h = hash(key);
            std::uint32_t& slot = recent[h % recent_slots];
            if (slot == nothing || key_of_(slot) != key) {
                slot = static_cast<std::uint32_t>(c);
                ++counts[part_of(h)];
            }
            first_of[c] = slot;
        }
    }

    /// entries_: part after part, corners ascending in each.
    void deal_out(std::vector<std::uint32_t>& first_of) {
        const std::size_t blocks = (count_ + grain - 1) / grain;
        std::vector<std::size_t> place(blocks * parts());
        runtime::parallel_blocks(count_, grain, [&](std::size_t begin, std::size_t end) {
            control_.check();
            find_recent(begin, end, first_of, &place[begin / grain * parts()]);
        });
        std::size_t sum = 0;
        part_begin_.resize(parts() + 1);
        for (std::size_t p = 0; p < parts(); ++p) {
            part_begin_[p] = sum;
            for (std::size_t b = 0; b < blocks; ++b) {
                const std::size_t size = place[b * parts() + p];
                place[b * parts() + p] = sum;
                sum += size;
            }
        }
        part_begin_[parts()] = sum;
        entries_.reset(new Entry[sum]);  // not initialised: each is written below
        runtime::parallel_blocks(count_, grain, [&](std::size_t begin, std::size_t end) {
            control_.check();
            std::size_t* places = &place[begin / grain * parts()];
            for (std::size_t c = begin; c < end; ++c) {
                if (first_of[c] != c) continue;
                const Key key = key_of_(c);
                entries_[places[part_of(hash(key))]++] = {key, static_cast<std::uint32_t>(c)};
            }
        });
    }

    void find_first(std::size_t begin, std::size_t end, std::vector<std::uint32_t>& first_of) const {
        const std::size_t slots = std::bit_ceil(2 * (end - begin) + 1);
        std::vector<std::uint32_t> table(slots, nothing);
        for (std::size_t e = begin; e < end; ++e) {
            const Entry& entry = entries_[e];
            std::size_t slot = hash(entry.key) & (slots - 1);
            while (table[slot] != nothing && entries_[begin + table[slot]].key != entry.key) {
                slot = (slot + 1) & (slots - 1);
            }
            if (table[slot] == nothing) table[slot] = static_cast<std::uint32_t>(e - begin);
            first_of[entry.corner] = entries_[begin + table[slot]].corner;
        }
    }

    Weld number(const std::vector<std::uint32_t>& first_of) const {
        std::vector<std::size_t> first_vertex((count_ + grain - 1) / grain);
        runtime::parallel_blocks(count_, grain, [&](std::size_t begin, std::size_t end) {
            control_.check();
            std::size_t vertices = 0;
            for (std::size_t c = begin; c < end; ++c) vertices += first_of[c] == c;
            first_vertex[begin / grain] = vertices;
        });
        Weld result;
        polled_resize(result.first_corner, runtime::exclusive_scan(first_vertex), control_);
        polled_resize(result.vertex_of, count_, control_);
        runtime::parallel_blocks(count_, grain, [&](std::size_t begin, std::size_t end) {
            control_.check();
            std::size_t vertex = first_vertex[begin / grain];
            for (std::size_t c = begin; c < end; ++c) {
                if (first_of[c] != c) continue;
                result.first_corner[vertex] = static_cast<std::uint32_t>(c);
                result.vertex_of[c] = static_cast<std::uint32_t>(vertex++);
            }
        });
        runtime::parallel_blocks(count_, grain, [&](std::size_t begin, std::size_t end) {
            control_.check();
            for (std::size_t c = begin; c < end; ++c) {
                // A recent corner may itself repeat one further back, which is the first of all.
                if (first_of[c] != c) result.vertex_of[c] = result.vertex_of[first_of[first_of[c]]];
            }
        });
        return result;
    }

    std::size_t count_;
    const KeyOf& key_of_;
    const runtime::RunControl& control_;
    unsigned part_bits_ = 0;
    std::unique_ptr<Entry[]> entries_;
    std::vector<std::size_t> part_begin_;
};

/// key_of(corner) gives the PositionKey of a corner. At most 2³²−1 corners.
template <class KeyOf>
Weld weld(std::size_t corners, const KeyOf& key_of, const runtime::RunControl& control) {
    return Welder<KeyOf>(corners, key_of, control).weld();
}

}  // namespace quadseg::io
