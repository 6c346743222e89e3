// What several runs of one job say, and how time grows with size.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace quadseg::bench {

struct Spread {
    double median = 0, min = 0, max = 0;
};

/// Of an even number of values the mean of the two in the middle; all zero for none.
inline Spread spread(std::vector<double> values) {
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    const double median = values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
    return {median, values.front(), values.back()};
}

struct PowerLaw {
    double factor = 0, exponent = 0;  ///< y ≈ factor · x^exponent
};

/// Least squares on logarithms; pairs that are not both positive are left out. All zero below two different x.
inline PowerLaw power_law(std::span<const double> x, std::span<const double> y) {
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
        if (!(x[i] > 0 && y[i] > 0)) continue;
        const double u = std::log(x[i]), v = std::log(y[i]);
        n += 1;
        sx += u;
        sy += v;
        sxx += u * u;
        sxy += u * v;
    }
    const double determinant = n * sxx - sx * sx;
    if (!(determinant > 1e-12 * n * sxx)) return {};
    const double exponent = (n * sxy - sx * sy) / determinant;
    return {std::exp((sy - exponent * sx) / n), exponent};
}

}  // namespace quadseg::bench
