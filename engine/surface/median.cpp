#include "surface/median.h"

#include "quadric/pack.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace quadseg::surface {

namespace {

using quadric::Part;

constexpr std::size_t part_size = sizeof(Part) / sizeof(double);
constexpr double infinity = std::numeric_limits<double>::infinity();
/// Up to so many values are ranked by counting, each against all, which takes no branches that depend on them.
constexpr std::size_t few = 32;
/// Of a sample, and the ranks by which it misses those of all: two standard deviations.
constexpr std::size_t sampled = 24, sampling_error = 5;

struct Pair {
    double first, second;
};

/// Of n values, 0 < n <= few, none of them NaN or negative, those of two ranks (from 0, ascending).
[[gnu::always_inline]] inline Pair ranked_by_counting(const double* values, std::size_t n, std::size_t first,
                                                      std::size_t second) {
    Part padded[few / part_size];
    const std::size_t count = (n + part_size - 1) / part_size;
    padded[count - 1] = Part{} + infinity;
    std::memcpy(padded, values, n * sizeof *values);
    // The largest of those with no more than so many values below them.
    Part largest_first{}, largest_second{};
    for (std::size_t p = 0; p < count; ++p) {
        const Part own = padded[p];
        Part below{}, low;
        for (std::size_t i = 0; i < n; ++i) quadric::count_below(Part{} + values[i], own, below);
        quadric::where_positive(static_cast<double>(first) + 0.5 - below, own, low);
        quadric::maximum(low, largest_first, largest_first);
        quadric::where_positive(static_cast<double>(second) + 0.5 - below, own, low);
        quadric::maximum(low, largest_second, largest_second);
    }
    double all[part_size];
    const auto maximum = [&](const Part& part) {
        std::memcpy(all, &part, sizeof part);
        return *std::max_element(all, all + part_size);
    };
    return {maximum(largest_first), maximum(largest_second)};
}

/// Of n values in place, none of them NaN or negative: a sample says between which bounds the wanted one lies, and only
/// those there are looked at again. NaN: the sample was wrong, and the values are lost.
double ranked(double* values, std::size_t n, std::size_t rank) {
    while (n > few) {
        double sample[sampled];
        for (std::size_t i = 0; i < sampled; ++i) sample[i] = values[i * n / sampled];
        const std::size_t expected = rank * sampled / n;
        const std::size_t least = std::max(expected, sampling_error) - sampling_error;
        const std::size_t most = std::min(expected + sampling_error, sampled - 1);
        Pair bounds = ranked_by_counting(sample, sampled, least, most);
        if (expected < sampling_error) bounds.first = 0;
        if (expected + sampling_error >= sampled) bounds.second = infinity;
        // Bits of numbers that are not negative rise with them.
        const auto low = std::bit_cast<std::uint64_t>(bounds.first);
        const std::uint64_t range = std::bit_cast<std::uint64_t>(bounds.second) - low;
        std::size_t below = 0, within = 0;
        for (std::size_t i = 0; i < n; ++i) below += values[i] < bounds.first ? 1 : 0;
        for (std::size_t i = 0; i < n; ++i) {
            const double value = values[i];
            values[within] = value;
            within += static_cast<std::size_t>(std::bit_cast<std::uint64_t>(value) - low <= range);
        }
        if (rank < below || rank >= below + within || within == n) return std::numeric_limits<double>::quiet_NaN();
        rank -= below;
        n = within;
    }
    return ranked_by_counting(values, n, rank, rank).first;
}

}  // namespace

double median_magnitude(const double* values, std::size_t n, double* scratch) {
    if (n == 0) return 0;
    std::int64_t numbers = 0;
    for (std::size_t i = 0; i < n; ++i) {
        scratch[i] = std::abs(values[i]);
        numbers += scratch[i] <= infinity ? 1 : 0;
    }
    if (numbers < static_cast<std::int64_t>(n)) return infinity;
    const double median = ranked(scratch, n, n / 2);
    if (!std::isnan(median)) return median;
    for (std::size_t i = 0; i < n; ++i) scratch[i] = std::abs(values[i]);
    std::nth_element(scratch, scratch + n / 2, scratch + n);
    return scratch[n / 2];
}

}  // namespace quadseg::surface
