#include "surface/median.h"

#include "quadric/pack.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace quadseg::surface {

namespace {

using quadric::load_part, quadric::Part, quadric::part_size, quadric::store_part;

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Up to so many values are ranked by counting, each against all, which takes no branches that depend on them.
constexpr std::size_t few = 32;
/// Of n values, 0 < n <= few, none of them NaN or negative, the one of that rank (from 0, ascending).
double ranked_by_counting(const double* values, std::size_t n, std::size_t rank) {
    Part padded[few / part_size];
    const std::size_t count = (n + part_size - 1) / part_size;
    padded[count - 1] = Part{} + infinity;
    std::memcpy(padded, values, n * sizeof *values);
    // The largest of those with no more than `rank` values below them.
    Part largest{};
    for (std::size_t p = 0; p < count; ++p) {
        const Part own = padded[p];
        Part below{}, low;
        for (std::size_t i = 0; i < n; ++i) quadric::count_below(Part{} + values[i], own, below);
        quadric::where_positive(static_cast<double>(rank) + 0.5 - below, own, low);
        quadric::maximum(low, largest, largest);
    }
    double all[part_size];
    store_part(all, largest);
    return *std::max_element(all, all + part_size);
}

/// Written to an array of their number, and looked at in parts.
class Magnitudes {
  public:
    Magnitudes(const double* values, std::size_t n, double* out) : n_(n), first_(out), tail_(Part{} + infinity) {
        Part sum{};
        for_parts(values, [&](const Part& own, std::size_t at, std::size_t count) {
            Part magnitude;
            quadric::maximum(own, Part{} - own, magnitude);
            if (count == part_size) {
                sum += magnitude;
                store_part(out + at, magnitude);
            } else {
                std::memcpy(out + at, &magnitude, count * sizeof *out);
                std::memcpy(&tail_, &magnitude, count * sizeof *out);
            }
        });
        double all[part_size];
        store_part(all, sum);
        for (const double v : all) sum_ += v;
        for (std::size_t i = n - n % part_size; i < n; ++i) sum_ += out[i];
    }
    double sum() const { return sum_; }

    /// That of a rank (from 0, ascending): how many lie below a bound is counted for bounds that close in on it, until
    /// it is the first above one or the last below. NaN: they do not get there soon.
    double ranked_by_probing(std::size_t rank) const {
        constexpr int most_probes = 12;
        const double wanted = static_cast<double>(rank) + 0.5;
        // For distances of a smooth misfit the median is near this.
        double low = 0, high = infinity, at = 0.8 * sum_ / static_cast<double>(n_);
        double below_low = 0, below_high = static_cast<double>(n_);
        bool was_low = false;
        for (int probe = 0; probe < most_probes && low < at && at < high; ++probe) {
            const double below = count_below(at);
            const bool is_low = below <= wanted;
            if (is_low) {
                low = at;
                below_low = below;
            } else {
                high = at;
                below_high = below;
            }
            if (below_low == wanted - 0.5) return least_from(low);
            if (below_high == wanted + 0.5) return largest_below(high);
            if (high < infinity) {
                double share = (wanted - below_low) / (below_high - below_low);
                // Far values bend the curve: one bound alone would creep.
                if (probe > 0 && is_low == was_low) share = 0.5 * share + (is_low ? 0.375 : 0.125);
                at = low + (high - low) * share;
            } else {
                at = low * (wanted / below_low);
            }
            was_low = is_low;
        }
        return std::numeric_limits<double>::quiet_NaN();
    }

  private:
    template <class Look>
    [[gnu::always_inline]] void for_parts(const double* from, const Look& look) const {
        std::size_t i = 0;
        for (; i + part_size <= n_; i += part_size) look(load_part(from + i), i, part_size);
        if (i == n_) return;
        Part own = Part{} + infinity;
        std::memcpy(&own, from + i, (n_ - i) * sizeof *from);
        look(own, i, n_ - i);
    }
    /// Those at the end that fill no part, and infinity.
    template <class Look>
    [[gnu::always_inline]] void for_parts(const Look& look) const {
        for (std::size_t i = 0; i + part_size <= n_; i += part_size) look(load_part(first_ + i));
        look(tail_);
    }
    double count_below(double bound) const {
        Part count{};
        for_parts([&](const Part& own) { quadric::count_below(own, Part{} + bound, count); });
        double all[part_size], sum = 0;
        store_part(all, count);
        for (const double v : all) sum += v;
        return sum;
    }
    double largest_below(double bound) const {
        Part largest{};
        for_parts([&](const Part& own) {
            Part below;
            quadric::where_positive(bound - own, own, below);
            quadric::maximum(below, largest, largest);
        });
        double all[part_size];
        store_part(all, largest);
        return *std::max_element(all, all + part_size);
    }
    double least_from(double bound) const {
        Part least = Part{} + infinity;
        for_parts([&](const Part& own) {
            Part below;
            quadric::where_positive(bound - own, Part{} + infinity, below);
            quadric::minimum(own + below, least, least);
        });
        double all[part_size];
        store_part(all, least);
        return *std::min_element(all, all + part_size);
    }

    std::size_t n_;
    const double* first_;
    Part tail_;
    double sum_ = 0;
};

}  // namespace

double median_magnitude(const double* values, std::size_t n, double* scratch) {
    if (n == 0) return 0;
    const Magnitudes magnitudes(values, n, scratch);
    if (std::isnan(magnitudes.sum())) return infinity;
    const std::size_t rank = n / 2;
    if (n <= few) return ranked_by_counting(scratch, n, rank);
    const double median = magnitudes.ranked_by_probing(rank);
    if (!std::isnan(median)) return median;
    std::nth_element(scratch, scratch + rank, scratch + n);
    return scratch[rank];
}

}  // namespace quadseg::surface
