// Cholesky factorisation of small symmetric matrices of a size known at compile time.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace quadseg::quadric {

template <std::size_t N>
using Matrix = std::array<std::array<double, N>, N>;
template <std::size_t N>
using Vector = std::array<double, N>;

/// A = D L Lᵀ D with D = sqrt(diag A): scaling by the diagonal makes the pivots comparable, so that one relative
/// threshold tells a singular matrix. Reads the lower triangle only.
template <std::size_t N>
class Cholesky {
  public:
    /// False when a relative pivot is not above `threshold` (singular, indefinite or not finite); then unusable.
    bool factor(const Matrix<N>& a, double threshold, double ridge = 0) noexcept {
        for (std::size_t i = 0; i < N; ++i) scale_[i] = a[i][i] > 0 ? 1 / std::sqrt(a[i][i]) : 1;
        for (std::size_t i = 0; i < N; ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                double sum = a[i][j] * (scale_[i] * scale_[j]);
                for (std::size_t k = 0; k < j; ++k) sum -= l_[i][k] * l_[j][k];
                l_[i][j] = sum * inverse_[j];
            }
            double pivot = a[i][i] * (scale_[i] * scale_[i]) + ridge;
            for (std::size_t k = 0; k < i; ++k) pivot -= l_[i][k] * l_[i][k];
            if (!(pivot > threshold)) return false;
            inverse_[i] = 1 / std::sqrt(pivot);
        }
        return true;
    }

    void solve(Vector<N>& x) const noexcept {
        for (std::size_t i = 0; i < N; ++i) {
            double sum = x[i] * scale_[i];
            for (std::size_t k = 0; k < i; ++k) sum -= l_[i][k] * x[k];
            x[i] = sum * inverse_[i];
        }
        for (std::size_t i = N; i-- > 0;) {
            double sum = x[i];
            for (std::size_t k = i + 1; k < N; ++k) sum -= l_[k][i] * x[k];
            x[i] = sum * inverse_[i];
        }
        for (std::size_t i = 0; i < N; ++i) x[i] *= scale_[i];
    }

  private:
    Matrix<N> l_;        // strictly below the diagonal
    Vector<N> inverse_;  // 1 / diagonal of L
    Vector<N> scale_;
};

/// Pivots at or below this, relative to the diagonal, are rounding.
inline constexpr double singular_pivot = 1e-13;

/// Factors A, with a ridge of singular_pivot · trace when A is singular to rounding; tells whether that was needed.
/// False in `usable` only for matrices that are not finite.
struct Stabilised {
    bool usable = false, regularised = false;
};
template <std::size_t N>
Stabilised factor_stabilised(Cholesky<N>& cholesky, const Matrix<N>& a) noexcept {
    if (cholesky.factor(a, singular_pivot)) return {true, false};
    for (double ridge = singular_pivot * static_cast<double>(N); ridge < 1; ridge *= 1e3) {
        if (cholesky.factor(a, singular_pivot, ridge)) return {true, true};
    }
    return {false, true};
}

}  // namespace quadseg::quadric
