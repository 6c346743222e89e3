// The matrices of the appendix, assembled from moments: ∫FFᵀ, ∫(FxFxᵀ+FyFyᵀ+FzFzᵀ) and ∫(n·(Fx,Fy,Fz)).
#pragma once

#include "quadric/cholesky.h"
#include "quadric/moments.h"
#include "quadric/triangle_moments.h"

namespace quadseg::quadric {

/// Index of the moment of F_i F_j.
constexpr std::size_t product_index(std::size_t i, std::size_t j) noexcept {
    constexpr std::array<std::array<int, 3>, 10> e = {
        {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {2, 0, 0}, {1, 1, 0}, {1, 0, 1}, {0, 2, 0}, {0, 1, 1}, {0, 0, 2}}};
    return moment_index(e[i][0] + e[j][0], e[i][1] + e[j][1], e[i][2] + e[j][2]);
}

namespace detail {
template <std::size_t row, std::size_t... Column>
inline void distance_row(const Moments& m, Vector<10>& out, std::index_sequence<Column...> /*columns*/) noexcept {
    ((out[row + Column] = m.area[product_index(row, row + Column)]), ...);
}
template <std::size_t... Row>
inline void distance_rows(const Moments& m, Matrix<10>& out, std::index_sequence<Row...> /*rows*/) noexcept {
    (distance_row<Row>(m, out[Row], std::make_index_sequence<10 - Row>{}), ...);
}
}  // namespace detail

/// Upper triangle of ∫FFᵀ.
inline void distance_matrix(const Moments& m, Matrix<10>& out) noexcept {
    detail::distance_rows(m, out, std::make_index_sequence<10>{});
}

/// Adds w ∫(FxFxᵀ + FyFyᵀ + FzFzᵀ) to the upper triangle.
inline void add_normal_matrix(const Moments& m, double w, Matrix<10>& a) noexcept {
    const auto& v = m.area;
    const double m0 = w * v[0], x = w * v[1], y = w * v[2], z = w * v[3];
    const double xx = w * v[4], xy = w * v[5], xz = w * v[6], yy = w * v[7], yz = w * v[8], zz = w * v[9];
    a[1][1] += m0;
    a[2][2] += m0;
    a[3][3] += m0;
    a[1][4] += 2 * x;
    a[1][5] += y;
    a[1][6] += z;
    a[2][5] += x;
    a[2][7] += 2 * y;
    a[2][8] += z;
    a[3][6] += x;
    a[3][8] += y;
    a[3][9] += 2 * z;
    a[4][4] += 4 * xx;
    a[4][5] += 2 * xy;
    a[4][6] += 2 * xz;
    a[5][5] += xx + yy;
    a[5][6] += yz;
    a[5][7] += 2 * xy;
    a[5][8] += xz;
    a[6][6] += xx + zz;
    a[6][8] += xy;
    a[6][9] += 2 * xz;
    a[7][7] += 4 * yy;
    a[7][8] += 2 * yz;
    a[8][8] += yy + zz;
    a[8][9] += 2 * yz;
    a[9][9] += 4 * zz;
}

/// ∫ n · (Fx, Fy, Fz).
inline Vector<10> normal_vector(const Moments& m) noexcept {
    const auto& v = m.normal;
    return {0, v[0], v[4], v[8], 2 * v[1], v[2] + v[5], v[3] + v[9], 2 * v[6], v[7] + v[10], 2 * v[11]};
}

inline double dot(const Coefficients& a, const Coefficients& b) noexcept {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

/// xᵀ A x from the upper triangle.
template <std::size_t N>
inline double quadratic_form(const Matrix<N>& a, const Vector<N>& x) noexcept {
    double sum = 0;
    for (std::size_t i = 0; i < N; ++i) {
        double off_diagonal = 0;
        for (std::size_t j = i + 1; j < N; ++j) off_diagonal += a[i][j] * x[j];
        sum += x[i] * (2 * off_diagonal + a[i][i] * x[i]);
    }
    return sum;
}

/// (A_d + ω A_n) C = ω B_n with the constant ω c_n of the energy.
struct NormalEquations {
    Matrix<10> a;         ///< upper triangle
    Vector<10> b;         ///< ω B_n
    double constant = 0;  ///< ω c_n

    NormalEquations(const Moments& m, double weight) noexcept : b(normal_vector(m)), constant(weight * m.normal_area) {
        distance_matrix(m, a);
        add_normal_matrix(m, weight, a);
        for (double& v : b) v *= weight;
    }
    /// A p.
    Vector<10> times(const Coefficients& p) const noexcept {
        Vector<10> r{};
        for (std::size_t i = 0; i < 10; ++i) {
            r[i] += a[i][i] * p[i];
            for (std::size_t j = i + 1; j < 10; ++j) {
                r[i] += a[i][j] * p[j];
                r[j] += a[i][j] * p[i];
            }
        }
        return r;
    }
    /// Cᵀ A C − 2 Cᵀ b + constant, rounding below 0 cut off.
    double energy(const Coefficients& c) const noexcept {
        const double e = quadratic_form(a, c) - 2 * dot(c, b) + constant;
        return e > 0 ? e : 0;
    }
};

}  // namespace quadseg::quadric
