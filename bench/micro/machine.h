// What this machine can do at best, measured in the same program, and how near a kernel comes to it.
#pragma once

#include <benchmark/benchmark.h>

namespace quadseg::bench {

/// Of one thread.
struct Machine {
    double bytes_per_second = 0;       ///< triad over arrays far larger than the caches: bytes read and written
    double operations_per_second = 0;  ///< independent multiply-adds in double in registers, two operations each
};

/// Measured once, at the first call (about half a second).
const Machine& machine();

/// Counters of a kernel that handles `items` (faces, calls, points) an iteration: time, bytes that must move and
/// floating-point operations an item, and the share of the machine's bandwidth and peak that this makes. 0 operations
/// or bytes: not counted. Shares are of CPU time, or of wall time with UseRealTime(); several threads can pass 1.
inline void report(benchmark::State& state, double items, double bytes, double operations = 0) {
    using benchmark::Counter;
    const double all = items * static_cast<double>(state.iterations());
    state.counters["time/item"] = Counter(all, Counter::kIsRate | Counter::kInvert);
    if (bytes > 0) {
        state.counters["bytes/item"] = bytes;
        state.counters["of_bandwidth"] = Counter(all * bytes / machine().bytes_per_second, Counter::kIsRate);
    }
    if (operations > 0) {
        state.counters["flop/item"] = operations;
        state.counters["of_peak"] = Counter(all * operations / machine().operations_per_second, Counter::kIsRate);
    }
}

}  // namespace quadseg::bench
