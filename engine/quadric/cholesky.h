// Root-free Cholesky factorisation of small symmetric matrices of a size known at compile time, with a right-hand side
// carried along: A = Uᵀ D⁻¹ U with U upper triangular and D its diagonal.
#pragma once

#include <array>
#include <cstddef>
#include <utility>

namespace quadseg::quadric {

/// Row-major; of symmetric matrices the upper triangle a[i][j], j ≥ i, counts.
template <std::size_t N>
using Matrix = std::array<std::array<double, N>, N>;
template <std::size_t N>
using Vector = std::array<double, N>;

/// Pivots at or below this, relative to the diagonal, are rounding.
inline constexpr double singular_pivot = 1e-13;

template <std::size_t N>
class Cholesky {
  public:
    /// False when a pivot is not above `threshold` relative to its diagonal entry (singular, indefinite or not finite).
    /// `ridge`, relative to the diagonal too, is added to it.
    bool factor(const Matrix<N>& a, const Vector<N>& b, double threshold, double ridge = 0) noexcept {
        for (std::size_t i = 0; i < N; ++i) {
            for (std::size_t j = 0; j < i; ++j) row_[i][j] = 0;
            for (std::size_t j = i; j < N; ++j) row_[i][j] = a[i][j];
            row_[i][N] = b[i];
            for (std::size_t j = N + 1; j < width; ++j) row_[i][j] = 0;
        }
        for (std::size_t i = 0; i < N; ++i) row_[i][i] += ridge * a[i][i];
        return eliminate(a, threshold, std::make_index_sequence<N>{});
    }
    /// The same with a ridge of singular_pivot · N where the matrix is singular to rounding.
    /// usable = false only for matrices that are not finite.
    struct State {
        bool usable = false, regularised = false;
    };
    State factor_stabilised(const Matrix<N>& a, const Vector<N>& b) noexcept {
        if (factor(a, b, singular_pivot)) return {true, false};
        double ridge = singular_pivot * static_cast<double>(N);
        for (int attempt = 0; attempt < 4; ++attempt) {
            if (factor(a, b, singular_pivot, ridge)) return {true, true};
            ridge *= 1e3;
        }
        return {false, true};
    }

    Vector<N> solution() const noexcept {
        Vector<N> x;
        for (std::size_t i = 0; i < N; ++i) x[i] = row_[i][N];
        back_substitute(x);
        return x;
    }
    /// Solution for the right-hand side given, in the span of the first `count` unknowns (the others 0).
    Vector<N> solution(std::size_t count) const noexcept {
        Vector<N> x{};
        for (std::size_t i = 0; i < count; ++i) x[i] = row_[i][N];
        back_substitute(x, count);
        return x;
    }
    /// bᵀ A⁻¹ b over the first `count` unknowns: what they lower xᵀAx − 2bᵀx by.
    double reduction(std::size_t count = N) const noexcept {
        double sum = 0;
        for (std::size_t i = 0; i < count; ++i) sum += row_[i][N] * row_[i][N] * inverse_[i];
        return sum;
    }

    void solve(Vector<N>& x) const noexcept {
        forward_substitute(x, N);
        back_substitute(x);
    }
    void back_substitute(Vector<N>& x) const noexcept { substitute_rows(x, std::make_index_sequence<N>{}); }
    /// x becomes U⁻ᵀ D x over the first `count` unknowns, which is what factor() made of b.
    void forward_substitute(Vector<N>& x, std::size_t count) const noexcept {
        for (std::size_t i = 0; i < count; ++i) {
            const double factor = x[i] * inverse_[i];
            for (std::size_t k = i + 1; k < count; ++k) x[k] -= factor * row_[i][k];
        }
    }
    void back_substitute(Vector<N>& x, std::size_t count) const noexcept {
        for (std::size_t i = count; i-- > 0;) {
            double sum = x[i];
            for (std::size_t k = i + 1; k < count; ++k) sum -= row_[i][k] * x[k];
            x[i] = sum * inverse_[i];
        }
    }
    double inverse_pivot(std::size_t i) const noexcept { return inverse_[i]; }
    double reduced_rhs(std::size_t i) const noexcept { return row_[i][N]; }

  private:
    static constexpr std::size_t width = (N + 1 + 3) / 4 * 4;

    template <std::size_t... I>
    void substitute_rows(Vector<N>& x, std::index_sequence<I...> /*rows*/) const noexcept {
        (substitute_row<N - 1 - I>(x, std::make_index_sequence<I>{}), ...);
    }
    template <std::size_t I, std::size_t... K>
    void substitute_row(Vector<N>& x, std::index_sequence<K...> /*unknowns after it*/) const noexcept {
        double sum = x[I];
        ((sum -= row_[I][I + 1 + K] * x[I + 1 + K]), ...);
        x[I] = sum * inverse_[I];
    }

    template <std::size_t... I>
    bool eliminate(const Matrix<N>& a, double threshold, std::index_sequence<I...> /*rows*/) noexcept {
        return (eliminate_row<I>(threshold * a[I][I], std::make_index_sequence<N - 1 - I>{}) && ...);
    }
    template <std::size_t I, std::size_t... K>
    bool eliminate_row(double least, std::index_sequence<K...> /*rows below*/) noexcept {
        const double pivot = row_[I][I];
        if (!(pivot > least) || !(pivot > 0)) return false;
        inverse_[I] = 1 / pivot;
        (subtract_row<I, I + 1 + K>(row_[I][I + 1 + K] * inverse_[I]), ...);
        return true;
    }
    /// From the fours on in which the diagonal is: what lies left of it is never read, and lengths are fixed.
    template <std::size_t From, std::size_t Row>
    void subtract_row(double factor) noexcept {
        for (std::size_t j = Row / 4 * 4; j < width; ++j) row_[Row][j] -= factor * row_[From][j];
    }

    std::array<std::array<double, width>, N> row_;
    Vector<N> inverse_;
};

}  // namespace quadseg::quadric
