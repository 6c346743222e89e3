// Parallel loops whose results do not depend on the number of threads. The only room that names TBB.
//
// Work is cut into blocks of a fixed grain, so that what a block computes never depends on scheduling; reductions
// combine the blocks' results in block order.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_sort.h>
#include <tbb/task_arena.h>
#include <utility>
#include <vector>

namespace quadseg::runtime {

/// body(begin, end) on blocks [k·grain, (k+1)·grain) of [0, count), in any order, possibly at once. Exceptions
/// propagate.
template <class Body>
void parallel_blocks(std::size_t count, std::size_t grain, const Body& body) {
    if (count == 0) return;
    const std::size_t blocks = (count + grain - 1) / grain;
    if (blocks == 1) {
        body(std::size_t{0}, count);
        return;
    }
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, blocks, 1), [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t b = range.begin(); b != range.end(); ++b) {
            body(b * grain, std::min(count, (b + 1) * grain));
        }
    });
}

/// body(i) for every i in [0, count), blocks of `grain`.
template <class Body>
void parallel_for(std::size_t count, std::size_t grain, const Body& body) {
    parallel_blocks(count, grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) body(i);
    });
}

/// result = join(join(identity, body(block 0)), body(block 1)) …: the same bits at any thread count.
template <class T, class Body, class Join>
T reduce_blocks(std::size_t count, std::size_t grain, T identity, const Body& body, const Join& join) {
    if (count == 0) return identity;
    std::vector<T> partial((count + grain - 1) / grain, identity);
    parallel_blocks(count, grain,
                    [&](std::size_t begin, std::size_t end) { partial[begin / grain] = body(begin, end); });
    T result = std::move(identity);
    for (const T& p : partial) result = join(std::move(result), p);
    return result;
}

/// What body(begin, end, out) appends to `out`, a block's beside the next one's: the same at any thread count.
template <class T, class Body>
std::vector<T> collect_blocks(std::size_t count, std::size_t grain, const Body& body) {
    std::vector<std::vector<T>> parts((count + grain - 1) / grain);
    parallel_blocks(count, grain, [&](std::size_t begin, std::size_t end) { body(begin, end, parts[begin / grain]); });
    if (parts.size() == 1) return std::move(parts.front());
    std::vector<T> all;
    std::size_t size = 0;
    for (const std::vector<T>& part : parts) size += part.size();
    all.reserve(size);
    for (const std::vector<T>& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}

/// In place, each element replaced by the sum of those before it; returns the total.
template <class T>
T exclusive_scan(std::vector<T>& values) {
    T sum{};
    for (T& v : values) {
        const T next = sum + v;
        v = sum;
        sum = next;
    }
    return sum;
}

/// `less` must be a strict total order (break ties by index): then the result is unique.
template <class Iterator, class Less>
void parallel_sort(Iterator begin, Iterator end, const Less& less) {
    if (end - begin < 8192) {
        std::sort(begin, end, less);
    } else {
        tbb::parallel_sort(begin, end, less);
    }
}

template <class A, class B>
void parallel_invoke(const A& a, const B& b) {
    tbb::parallel_invoke(a, b);
}

/// Runs body in an arena of at most `threads` threads (0: the caller's arena as it is). Never more than the process
/// allows (one a core, or the caller's tbb::global_control): TBB writes a warning to stderr when it is asked for more.
template <class Body>
void in_arena(int threads, const Body& body) {
    if (threads <= 0) {
        body();
    } else {
        const std::size_t allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
        tbb::task_arena arena(static_cast<int>(std::min(static_cast<std::size_t>(threads), allowed)));
        arena.execute(body);
    }
}

/// Threads that may take part in a loop started here.
inline int arena_threads() {
    return tbb::this_task_arena::max_concurrency();
}

}  // namespace quadseg::runtime
