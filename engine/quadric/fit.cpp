#include "quadric/fit.h"

#include "quadric/normal_equations.h"

#include <algorithm>
#include <cmath>

namespace quadseg::quadric {
namespace {

/// Taubin's quotient without the constant (MATH.md §3): S = Mr − m mᵀ/m00 and Nr, unknowns c1 … c9.
struct ReducedPencil {
    Matrix<9> s{}, n{};
    Vector<9> mean{};  // m / m00
    double s_trace = 0, n_trace = 0;

    explicit ReducedPencil(const Moments& m) noexcept {
        Matrix<10> distance, normal{};
        distance_matrix(m, distance);
        add_normal_matrix(m, 1, normal);
        const double inverse = 1 / distance[0][0];
        for (std::size_t i = 0; i < 9; ++i) {
            mean[i] = distance[0][i + 1] * inverse;
            for (std::size_t j = i; j < 9; ++j) {
                s[i][j] = distance[i + 1][j + 1] - mean[i] * distance[0][j + 1];
                n[i][j] = normal[i + 1][j + 1];
            }
            s_trace += s[i][i];
            n_trace += n[i][i];
        }
    }
    Vector<9> times_n(const Vector<9>& y) const noexcept {
        Vector<9> r{};
        for (std::size_t i = 0; i < 9; ++i) {
            r[i] += n[i][i] * y[i];
            for (std::size_t j = i + 1; j < 9; ++j) {
                r[i] += n[i][j] * y[j];
                r[j] += n[i][j] * y[i];
            }
        }
        return r;
    }
};

double dot(const Vector<9>& a, const Vector<9>& b) noexcept {
    double sum = 0;
    for (std::size_t i = 0; i < 9; ++i) sum += a[i] * b[i];
    return sum;
}

bool finite(const Coefficients& c) noexcept {
    double sum = 0;
    for (const double v : c) sum += std::abs(v);
    return std::isfinite(sum);
}

}  // namespace

QuadricFit fit_taubin(const Moments& m) noexcept {
    QuadricFit fit;
    if (!(m.area[0] > 0)) return {plane({0, 0, 1}, 0), 0, true};
    const ReducedPencil pencil(m);
    if (!(pencil.n_trace > 0) || !std::isfinite(pencil.s_trace)) return {plane({0, 0, 1}, 0), 0, true};

    // The shift of S by a multiple of N leaves the eigenvectors as they are and makes exact quadrics factorable; S and
    // N share a null vector on planes, for which the stabilised factorisation stands in.
    const double shift = 1e-13 * pencil.s_trace / pencil.n_trace;
    Matrix<9> shifted_s = pencil.s;
    for (std::size_t i = 0; i < 9; ++i) {
        for (std::size_t j = i; j < 9; ++j) shifted_s[i][j] += shift * pencil.n[i][j];
    }
    Cholesky<9> cholesky;
    // Tiny pivots are what makes inverse iteration converge: only those at rounding level count as singular.
    if (!cholesky.factor(shifted_s, {}, 1e-16)) {
        fit.regularised = true;
        bool usable = false;
        double ridge = 1e-15;
        for (int attempt = 0; !usable && attempt < 15; ++attempt) {
            usable = cholesky.factor(shifted_s, {}, 1e-16, ridge);
            ridge *= 10;
        }
        if (!usable) return {plane({0, 0, 1}, 0), 0, true};
    }

    const Vector<10> b = normal_vector(m);
    Vector<9> y{}, rhs{};
    std::copy(b.begin() + 1, b.end(), rhs.begin());  // N c of the surface sought, were ∇f = n everywhere
    if (!(dot(rhs, rhs) > 0)) rhs.fill(1);
    constexpr int most_iterations = 20;
    constexpr double settled = 1e-20;  // squared change of the vector
    bool found = false;
    for (int k = 0; k < most_iterations; ++k) {
        Vector<9> next = rhs;
        cholesky.solve(next);
        const Vector<9> n_next = pencil.times_n(next);
        const double gradient_square = dot(next, n_next);
        if (!(gradient_square > 0) || !std::isfinite(gradient_square)) break;
        const double r = 1 / std::sqrt(gradient_square);
        double change = 0, length = 0;
        for (std::size_t i = 0; i < 9; ++i) {
            const double v = next[i] * r;
            change += (v - y[i]) * (v - y[i]);
            length += v * v;
            y[i] = v;
            rhs[i] = n_next[i] * r;
        }
        found = true;
        if (!(change > settled * length)) break;
    }
    if (!found) return {plane({0, 0, 1}, 0), 0, true};
    const double lambda = std::max(0.0, quadratic_form(pencil.s, y));
    std::copy(y.begin(), y.end(), fit.c.begin() + 1);
    fit.c[0] = -dot(y, pencil.mean);
    if (!finite(fit.c)) return {plane({0, 0, 1}, 0), 0, true};

    // ∫|∇f|² = 1 so far. Mean |∇f| 1 in the root-mean-square sense: one number for what varies over the region.
    const double orientation = quadric::dot(fit.c, b);
    const double scale = std::copysign(std::sqrt(m.area[0]), orientation);
    for (double& v : fit.c) v *= scale;
    fit.energy = m.area[0] * lambda;
    return fit;
}

QuadricFit fit_least_squares(const Moments& weighted, double weight) noexcept {
    const NormalEquations equations(weighted, weight);
    Cholesky<10> cholesky;
    const auto state = cholesky.factor_stabilised(equations.a, equations.b);
    if (!state.usable) return {plane({0, 0, 1}, 0), 0, true};
    QuadricFit fit;
    fit.c = cholesky.solution();
    fit.regularised = state.regularised;
    if (!finite(fit.c)) return {plane({0, 0, 1}, 0), 0, true};
    fit.energy = equations.energy(fit.c);
    return fit;
}

}  // namespace quadseg::quadric
