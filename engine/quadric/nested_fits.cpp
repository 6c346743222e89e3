#include "quadric/nested_fits.h"

#include "quadric/axis.h"

#include <algorithm>
#include <cmath>

namespace quadseg::quadric {
namespace {

Coefficients with_sphere_term(Coefficients y) noexcept {
    y[7] += y[4];
    y[9] += y[4];
    return y;
}

bool finite(const QuadricFit& fit) noexcept {
    double sum = fit.energy;
    for (const double v : fit.c) sum += std::abs(v);
    return std::isfinite(sum);
}

}  // namespace

NestedFits::NestedFits(const Moments& m, double weight) noexcept : equations_(m, weight) {
    auto& a = equations_.a;
    // Fourth row and column: x² → |x|², the sum of those of x², y², z².
    for (std::size_t i = 0; i < 4; ++i) a[i][4] += a[i][7] + a[i][9];
    a[4][4] += 2 * (a[4][7] + a[4][9] + a[7][9]) + a[7][7] + a[9][9];
    for (std::size_t j = 5; j < 10; ++j) {
        a[4][j] += (j < 7 ? a[j][7] : a[7][j]) + a[j][9];
    }
    equations_.b[4] += equations_.b[7] + equations_.b[9];
    state_ = cholesky_.factor_stabilised(a, equations_.b);
}

double NestedFits::energy_without(double reduction) const noexcept {
    const double e = equations_.constant - reduction;
    return e > 0 ? e : 0;
}

QuadricFit NestedFits::sphere() const noexcept {
    return {with_sphere_term(cholesky_.solution(5)), sphere_energy(), state_.regularised};
}

QuadricFit NestedFits::quadric() const noexcept {
    return {with_sphere_term(cholesky_.solution()), quadric_energy(), state_.regularised};
}

QuadricFit NestedFits::revolution(const Vec3& axis) const noexcept {
    // (a·x)² = ax²|x|² + … in the basis with |x|².
    const double x2 = axis.x * axis.x;
    const Coefficients height = {0,
                                 0,
                                 0,
                                 0,
                                 x2,
                                 2 * axis.x * axis.y,
                                 2 * axis.x * axis.z,
                                 axis.y * axis.y - x2,
                                 2 * axis.y * axis.z,
                                 axis.z * axis.z - x2};
    Vector<10> column = equations_.times(height);
    const double diagonal = dot(column, height);
    cholesky_.forward_substitute(column, 5);
    double pivot = diagonal, rhs = dot(equations_.b, height);
    for (std::size_t i = 0; i < 5; ++i) {
        const double w = column[i] * cholesky_.inverse_pivot(i);
        pivot -= w * column[i];
        rhs -= w * cholesky_.reduced_rhs(i);
    }
    if (!(pivot > singular_pivot * diagonal)) return sphere();
    const double amount = rhs / pivot;
    Vector<10> y{};
    for (std::size_t i = 0; i < 5; ++i) y[i] = cholesky_.reduced_rhs(i) - amount * column[i];
    cholesky_.back_substitute(y, 5);
    for (std::size_t i = 4; i < 10; ++i) y[i] += amount * height[i];
    QuadricFit fit{with_sphere_term(y), energy_without(cholesky_.reduction(5) + amount * rhs), state_.regularised};
    return finite(fit) ? fit : sphere();
}

QuadricFit NestedFits::cylinder(const Vec3& axis) const noexcept {
    const Vec3 p = any_perpendicular(axis), q = cross(axis, p);
    const double x2 = axis.x * axis.x;
    // |x|² − (a·x)² in the basis with |x|².
    const Coefficients squared_radius = {0,
                                         0,
                                         0,
                                         0,
                                         1 - x2,
                                         -2 * axis.x * axis.y,
                                         -2 * axis.x * axis.z,
                                         x2 - axis.y * axis.y,
                                         -2 * axis.y * axis.z,
                                         x2 - axis.z * axis.z};
    const auto& a = equations_.a;
    const auto& b = equations_.b;
    const Vector<10> column = equations_.times(squared_radius);
    const Symmetric3 linear{a[1][1], a[1][2], a[1][3], a[2][2], a[2][3], a[3][3]};
    const Vec3 mean{a[0][1], a[0][2], a[0][3]}, bent{column[1], column[2], column[3]}, pull{b[1], b[2], b[3]};
    const Vec3 linear_p = linear * p, linear_q = linear * q;
    const Matrix<4> small = {{{a[0][0], dot(mean, p), dot(mean, q), column[0]},
                              {0, dot(linear_p, p), dot(linear_p, q), dot(bent, p)},
                              {0, 0, dot(linear_q, q), dot(bent, q)},
                              {0, 0, 0, dot(column, squared_radius)}}};
    Cholesky<4> cholesky;
    const auto state = cholesky.factor_stabilised(small, {b[0], dot(pull, p), dot(pull, q), dot(b, squared_radius)});
    if (!state.usable) return {plane({0, 0, 1}, 0), equations_.constant, true};
    const Vector<4> y = cholesky.solution();
    const Vec3 normal = p * y[1] + q * y[2];
    Coefficients c = {y[0], normal.x, normal.y, normal.z, 0, 0, 0, 0, 0, 0};
    for (std::size_t i = 4; i < 10; ++i) c[i] = y[3] * squared_radius[i];
    return {with_sphere_term(c), energy_without(cholesky.reduction()), state.regularised};
}

Vec3 cylinder_direction(const Moments& m) noexcept {
    const auto& n = m.normal2;
    return smallest_eigenvector({n[0], n[1], n[2], n[3], n[4], n[5]});
}

Vec3 revolution_direction(const Moments& m) noexcept {
    const auto& n = m.normal2;
    const double area = m.normal_area;
    if (!(area > 0)) return {0, 0, 1};
    const Vec3 sum{m.normal[0], m.normal[4], m.normal[8]}, mean = sum / area;
    return smallest_eigenvector({n[0] - sum.x * mean.x, n[1] - sum.x * mean.y, n[2] - sum.x * mean.z,
                                 n[3] - sum.y * mean.y, n[4] - sum.y * mean.z, n[5] - sum.z * mean.z});
}

Vec3 revolution_direction(const Coefficients& c) noexcept {
    return isolated_eigenvector({c[4], c[5] / 2, c[6] / 2, c[7], c[8] / 2, c[9]});
}

QuadricFit fit_sphere_linear(const Moments& m, double weight) noexcept {
    return NestedFits(m, weight).sphere();
}

QuadricFit fit_cylinder_linear(const Moments& m, double weight) noexcept {
    return NestedFits(m, weight).cylinder(cylinder_direction(m));
}

QuadricFit fit_revolution_linear(const Moments& m, double weight) noexcept {
    const NestedFits fits(m, weight);
    const QuadricFit by_normals = fits.revolution(revolution_direction(m));
    const QuadricFit by_form = fits.revolution(revolution_direction(fits.quadric().c));
    return by_form.energy < by_normals.energy ? by_form : by_normals;
}

}  // namespace quadseg::quadric
