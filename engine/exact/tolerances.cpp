#include "exact/tolerances.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace quadseg::exact {

namespace {

constexpr int most_digits = 15;
/// Fewer digits than this are round numbers that a modeller typed (a unit cube), not the rounding of a file.
constexpr int least_digits = 5;
/// Half a unit in the last place of a float32, relative to the number, at most.
constexpr double float_rounding = 6e-8;
/// Relative to the largest extent; coarser files are no longer clean meshes.
constexpr double worst_precision = 2e-6;

/// std::pow(10, exponent), most of which are asked for very often.
class PowersOfTen {
  public:
    PowersOfTen() {
        for (std::size_t k = 0; k < known_.size(); ++k) known_[k] = std::pow(10.0, static_cast<int>(k) - largest);
    }
    double operator()(int exponent) const {
        return std::abs(exponent) <= largest ? known_[static_cast<std::size_t>(std::ptrdiff_t{exponent} + largest)]
                                             : std::pow(10.0, exponent);
    }

  private:
    static constexpr int largest = 24;
    std::array<double, 2 * largest + 1> known_;
};

/// Smallest number of significant decimal digits that represents x, of the magnitude 10^exponent, up to the rounding of
/// the unit frame's round trip.
int significant_digits(double x, int exponent, double slack, const PowersOfTen& power) {
    for (int n = 1; n < most_digits; ++n) {
        const double quantum = power(exponent - n + 1);
        if (std::abs(x - std::round(x / quantum) * quantum) <= slack) return n;
    }
    return most_digits;
}

double quantile(std::vector<double>& values, double share) {
    const auto k = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + k, values.end());
    return values[static_cast<std::size_t>(k)];
}

/// Floats may have been read from a text file. Then most of them (the others were computed since) are what a number of
/// so many decimals, or digits, is rounded to, which chance does to few.
class DecimalsBehindFloats {
  public:
    void look_at(double x, int exponent) {
        const double rounding = float_rounding * std::abs(x);
        const auto fits = [&](int last) {
            const double quantum = power_(last);
            return std::abs(x - std::round(x / quantum) * quantum) <= rounding * (1 + 1e-6);
        };
        for (int i = 0; i < kinds; ++i) {
            if (!fits(-i)) ++unlike_decimals_[static_cast<std::size_t>(i)];
            if (!fits(exponent - i)) ++unlike_digits_[static_cast<std::size_t>(i)];
        }
        ++total_;
        exponents_.push_back(exponent);
    }

    /// The step of the coarsest such numbers; 0: none.
    double step() {
        if (total_ == 0) return 0;
        const double middle = power_(static_cast<int>(quantile(exponents_, 0.5)));
        return std::max(first_that_fits(unlike_decimals_, 1, middle), first_that_fits(unlike_digits_, middle, middle));
    }

  private:
    static constexpr int kinds = 12;
    static constexpr double least_odds = 8;
    using Counts = std::array<std::size_t, kinds>;
    /// Of the steps unit, unit / 10 …; 0: none, or only what chance fits, or round numbers that somebody typed.
    double first_that_fits(const Counts& unlike, double unit, double middle) const {
        for (int i = 0; i < kinds; ++i) {
            const double step = unit * power_(-i);
            if (step <= least_odds * float_rounding * middle) return 0;
            if (4 * unlike[static_cast<std::size_t>(i)] > total_) continue;
            return step < middle * power_(2 - least_digits) ? step : 0;
        }
        return 0;
    }

    Counts unlike_decimals_{}, unlike_digits_{};
    std::size_t total_ = 0;
    std::vector<double> exponents_;
    PowersOfTen power_;
};

}  // namespace

double coordinate_precision(const mesh::WorkMesh& mesh) {
    const std::size_t stride = std::max<std::size_t>(1, mesh.vertex_count() / 4096);
    const double extent = 1 / mesh.frame.scale;
    // The coordinates come back from the unit frame with an error of a few units in the last place.
    const double magnitude =
        std::max({std::abs(mesh.frame.centre.x), std::abs(mesh.frame.centre.y), std::abs(mesh.frame.centre.z), extent});
    const double slack = 4e-16 * magnitude;
    std::vector<double> digits, quanta, float_quanta;
    std::size_t floats = 0, total = 0;
    const PowersOfTen power;
    std::vector<double> values, exponents;
    for (std::size_t v = 0; v < mesh.vertex_count(); v += stride) {
        const Vec3 p = mesh.frame.to_input(mesh.positions[v]);
        for (int k = 0; k < 3; ++k) {
            const double x = p[k];
            if (std::abs(x) < 1e-6 * extent) continue;
            ++total;
            if (std::abs(x - static_cast<double>(static_cast<float>(x))) <= slack) ++floats;
            float_quanta.push_back(float_rounding * std::abs(x));
            const int exponent = static_cast<int>(std::floor(std::log10(std::abs(x))));
            values.push_back(x);
            exponents.push_back(exponent);
            const int shown = significant_digits(x, exponent, slack, power);
            digits.push_back(shown);
            quanta.push_back(power(exponent + 1 - shown));
        }
    }
    if (total == 0) return 1e-16;
    double precision = 1e-16 * magnitude;
    if (floats * 100 >= total * 99) {
        DecimalsBehindFloats decimals;
        for (std::size_t i = 0; i < values.size(); ++i) decimals.look_at(values[i], static_cast<int>(exponents[i]));
        precision = std::max({precision, 0.29 * quantile(float_quanta, 0.5), 0.29 * decimals.step()});
    }
    // Full doubles show most_digits; a text file shows the digits that it was printed with, or its decimals.
    const double most = quantile(digits, 0.9);
    if (most >= least_digits && most < most_digits - 1) {
        precision = std::max(precision, 0.29 * quantile(quanta, 0.5));
    }
    return std::min(precision * mesh.frame.scale, worst_precision);
}

Tolerances choose_tolerances(const mesh::WorkMesh& mesh) {
    Tolerances t;
    t.diagonal = mesh.frame.diagonal;
    const double d = t.diagonal;
    t.precision = coordinate_precision(mesh);
    const double s = t.precision;
    // On very dense meshes neighbouring triangles of a curved surface are coplanar within 3e-7: a facet must be flatter
    // than that.
    const double mean_edge =
        std::sqrt(2.3 * mesh.total_area / static_cast<double>(std::max<std::size_t>(1, mesh.face_count())));
    t.facet = std::max(8 * s, std::min(3e-7 * d, 3e-3 * mean_edge * mean_edge / d));
    t.fit = std::max(1e-8 * d, 10 * s);
    t.loose_fit = std::max(5e-7 * d, 20 * s);
    t.trim = std::max(1e-5 * d, 40 * s);
    t.gap = 8 * t.trim;
    t.border = 4 * t.trim;
    return t;
}

}  // namespace quadseg::exact
