// Edges by the cost of their collapse, cheapest first to within a quarter of an octave: constant time where a heap
// takes its logarithm, and which of two edges of about the same cost goes first matters to nobody.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace quadseg::simplify {

struct QueuedEdge {
    std::uint32_t v, w;
    std::uint32_t stamp;  ///< of both ends when it was rated: anything else says that it is out of date
};

class BucketQueue {
  public:
    BucketQueue() { clear(); }

    void clear() {
        heads_.fill(end);
        entries_.clear();
        lowest_ = buckets;
    }
    /// cost: not negative, not NaN.
    void push(float cost, const QueuedEdge& edge) {
        const std::size_t b = std::bit_cast<std::uint32_t>(cost) >> shift;
        entries_.push_back({edge, heads_[b]});
        heads_[b] = static_cast<std::uint32_t>(entries_.size() - 1);
        lowest_ = std::min(lowest_, b);
    }
    bool pop(QueuedEdge& edge) {
        while (lowest_ < buckets && heads_[lowest_] == end) ++lowest_;
        if (lowest_ == buckets) return false;
        const Entry& entry = entries_[heads_[lowest_]];
        heads_[lowest_] = entry.next;
        edge = entry.edge;
        return true;
    }

  private:
    struct Entry {
        QueuedEdge edge;
        std::uint32_t next;
    };
    static constexpr int shift = 21;  ///< sign, exponent and two bits remain
    static constexpr std::size_t buckets = std::size_t{1} << (31 - shift);
    static constexpr std::uint32_t end = 0xffffffffU;
    std::array<std::uint32_t, buckets> heads_;
    std::vector<Entry> entries_;
    std::size_t lowest_ = buckets;
};

}  // namespace quadseg::simplify
