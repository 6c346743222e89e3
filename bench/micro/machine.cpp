#include "bench/micro/machine.h"

#include <algorithm>
#include <cstddef>
#include <ctime>
#include <limits>
#include <string>
#include <vector>

namespace quadseg::bench {
namespace {

/// Time of this thread, so that other work on the machine counts less.
double thread_seconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

template <class Kernel>
double best_seconds(int repetitions, const Kernel& kernel) {
    double best = std::numeric_limits<double>::max();
    for (int r = 0; r < repetitions; ++r) {
        const double start = thread_seconds();
        kernel();
        best = std::min(best, thread_seconds() - start);
    }
    return best;
}

double stream_bandwidth() {
    constexpr std::size_t n = std::size_t{1} << 23;  // 64 MiB each
    std::vector<double> a(n, 0), b(n, 1), c(n, 2);
    const double seconds = best_seconds(8, [&] {
        for (std::size_t i = 0; i < n; ++i) a[i] = b[i] + 3 * c[i];
        benchmark::DoNotOptimize(a.data());
        benchmark::ClobberMemory();
    });
    return 3 * static_cast<double>(n * sizeof(double)) / seconds;
}

/// As wide as the instruction set the program is built for.
#if defined(__AVX512F__)
using Lanes = double __attribute__((vector_size(64)));
#elif defined(__AVX__)
using Lanes = double __attribute__((vector_size(32)));
#else
using Lanes = double __attribute__((vector_size(16)));
#endif

/// Ten independent chains: more than latency times units. This file alone is built with contraction to fused
/// multiply-adds; the kernels are not (results must not depend on it) and reach half of this at most.
double peak_operations() {
    constexpr int rounds = 2'000'000;
    constexpr std::size_t chains = 10;
    Lanes sums[chains];
    for (std::size_t k = 0; k < chains; ++k) sums[k] = Lanes{} + static_cast<double>(k + 1);
    Lanes factor = Lanes{} + 0.999999, term = Lanes{} + 1e-6;
    benchmark::DoNotOptimize(factor);
    benchmark::DoNotOptimize(term);
    const double seconds = best_seconds(8, [&] {
        for (int r = 0; r < rounds; ++r) {
            for (Lanes& sum : sums) sum = sum * factor + term;
        }
        for (Lanes& sum : sums) benchmark::DoNotOptimize(sum);
    });
    constexpr std::size_t lanes = sizeof(Lanes) / sizeof(double);
    return 2.0 * rounds * static_cast<double>(chains * lanes) / seconds;
}

Machine measure() {
    return {stream_bandwidth(), peak_operations()};
}

}  // namespace

const Machine& machine() {
    static const Machine measured = measure();
    return measured;
}

}  // namespace quadseg::bench

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
    const quadseg::bench::Machine& machine = quadseg::bench::machine();
    benchmark::AddCustomContext("stream GB/s, one thread", std::to_string(machine.bytes_per_second / 1e9));
    benchmark::AddCustomContext("peak GFLOP/s, one thread", std::to_string(machine.operations_per_second / 1e9));
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}
