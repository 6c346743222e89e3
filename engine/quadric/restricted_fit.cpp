#include "quadric/restricted_fit.h"

#include "math/symmetric3.h"

#include <algorithm>
#include <cmath>

namespace quadseg::quadric {
namespace {

/// A P for one basis vector P, A given by its lower triangle.
Coefficients times(const Matrix<10>& a, const Coefficients& p) noexcept {
    Coefficients r{};
    for (std::size_t i = 0; i < 10; ++i) {
        r[i] += a[i][i] * p[i];
        for (std::size_t j = 0; j < i; ++j) {
            r[i] += a[i][j] * p[j];
            r[j] += a[i][j] * p[i];
        }
    }
    return r;
}

/// Minimises the quadratic energy over the span of `basis`.
template <std::size_t N>
QuadricFit solve_in_span(const NormalEquations& equations, const std::array<Coefficients, N>& basis) noexcept {
    Matrix<N> a;
    Vector<N> y;
    for (std::size_t j = 0; j < N; ++j) {
        const Coefficients column = times(equations.a, basis[j]);
        for (std::size_t i = j; i < N; ++i) a[i][j] = dot(column, basis[i]);
        y[j] = dot(equations.b, basis[j]);
    }
    const Vector<N> b = y;
    Cholesky<N> cholesky;
    const Stabilised state = factor_stabilised(cholesky, a);
    if (!state.usable) return {plane({0, 0, 1}, 0), equations.constant, true};
    cholesky.solve(y);
    QuadricFit fit;
    double sum = 0;
    for (std::size_t i = 0; i < N; ++i) {
        for (std::size_t k = 0; k < 10; ++k) fit.c[k] += y[i] * basis[i][k];
        sum += y[i] * b[i];
    }
    fit.regularised = state.regularised;
    const double energy = quadratic_form(a, y) - 2 * sum + equations.constant;
    if (!std::isfinite(energy)) return {plane({0, 0, 1}, 0), equations.constant, true};
    fit.energy = std::max(0.0, energy);
    return fit;
}

/// |x|² − (a·x)²
Coefficients squared_distance_to_axis(const Vec3& a) noexcept {
    return {0, 0, 0, 0, 1 - a.x * a.x, -2 * a.x * a.y, -2 * a.x * a.z, 1 - a.y * a.y, -2 * a.y * a.z, 1 - a.z * a.z};
}

Coefficients squared_height(const Vec3& a) noexcept {
    return {0, 0, 0, 0, a.x * a.x, 2 * a.x * a.y, 2 * a.x * a.z, a.y * a.y, 2 * a.y * a.z, a.z * a.z};
}

constexpr Coefficients unit(std::size_t i) noexcept {
    Coefficients c{};
    c[i] = 1;
    return c;
}

}  // namespace

QuadricFit restricted_sphere(const NormalEquations& equations) noexcept {
    const std::array<Coefficients, 5> basis = {unit(0), unit(1), unit(2), unit(3),
                                               Coefficients{0, 0, 0, 0, 1, 0, 0, 1, 0, 1}};
    return solve_in_span(equations, basis);
}

QuadricFit restricted_cylinder(const NormalEquations& equations, const Vec3& axis) noexcept {
    const Vec3 p = any_perpendicular(axis), q = cross(axis, p);
    const std::array<Coefficients, 4> basis = {unit(0), plane(p, 0), plane(q, 0), squared_distance_to_axis(axis)};
    return solve_in_span(equations, basis);
}

QuadricFit restricted_revolution(const NormalEquations& equations, const Vec3& axis) noexcept {
    const std::array<Coefficients, 6> basis = {
        unit(0), unit(1), unit(2), unit(3), squared_distance_to_axis(axis), squared_height(axis)};
    return solve_in_span(equations, basis);
}

Vec3 cylinder_direction(const Moments& m) noexcept {
    const auto& n = m.normal2;
    return eigen_decomposition({n[0], n[1], n[2], n[3], n[4], n[5]}).vectors[0];
}

Vec3 revolution_direction(const Moments& m) noexcept {
    const auto& n = m.normal2;
    const double area = m.normal_area;
    if (!(area > 0)) return {0, 0, 1};
    const Vec3 sum{m.normal[0], m.normal[4], m.normal[8]}, mean = sum / area;
    return eigen_decomposition({n[0] - sum.x * mean.x, n[1] - sum.x * mean.y, n[2] - sum.x * mean.z,
                                n[3] - sum.y * mean.y, n[4] - sum.y * mean.z, n[5] - sum.z * mean.z})
        .vectors[0];
}

Vec3 revolution_direction(const Coefficients& c) noexcept {
    const EigenSystem e = eigen_decomposition({c[4], c[5] / 2, c[6] / 2, c[7], c[8] / 2, c[9]});
    return e.values[1] - e.values[0] < e.values[2] - e.values[1] ? e.vectors[2] : e.vectors[0];
}

QuadricFit fit_sphere_linear(const Moments& m, double weight) noexcept {
    return restricted_sphere(NormalEquations(m, weight));
}

QuadricFit fit_cylinder_linear(const Moments& m, double weight) noexcept {
    return restricted_cylinder(NormalEquations(m, weight), cylinder_direction(m));
}

QuadricFit fit_revolution_linear(const Moments& m, double weight) noexcept {
    const NormalEquations equations(m, weight);
    const QuadricFit cone = restricted_revolution(equations, revolution_direction(m));
    const QuadricFit round = restricted_revolution(equations, revolution_direction(fit_least_squares(m, weight).c));
    return round.energy < cone.energy ? round : cone;
}

}  // namespace quadseg::quadric
