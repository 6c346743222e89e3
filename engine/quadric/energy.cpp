#include "quadric/energy.h"

#include "quadric/normal_equations.h"

#include <algorithm>

namespace quadseg::quadric {

TriangleEnergy triangle_energy(const Coefficients& c, const Vec3& v0, const Vec3& v1, const Vec3& v2, const Vec3& n,
                               double area, double gradient_floor) noexcept {
    if (!(area > 0)) return {};
    const Vec3 g0 = gradient(c, v0), g1 = gradient(c, v1), g2 = gradient(c, v2);
    const double f0 = value(c, v0), f1 = value(c, v1), f2 = value(c, v2);
    // A quadratic on an edge: its middle value follows from the end values and gradients.
    const double m01 = 0.5 * (f0 + f1) + 0.125 * dot(g0 - g1, v1 - v0);
    const double m12 = 0.5 * (f1 + f2) + 0.125 * dot(g1 - g2, v2 - v1);
    const double m20 = 0.5 * (f2 + f0) + 0.125 * dot(g2 - g0, v0 - v2);
    const Vec3 sum = g0 + g1 + g2;
    const double length = std::max(norm(sum) / 3, gradient_floor);
    if (!(length > 0)) return {0, area * squared_norm(n)};
    const double r = 1 / length;
    const double corners = f0 + f1 + f2, middles = m01 + m12 + m20;
    const double integral = 7 * (f0 * f0 + f1 * f1 + f2 * f2) - corners * corners -
                            8 * (f0 * m12 + f1 * m20 + f2 * m01) +
                            16 * (middles * middles + m01 * m01 + m12 * m12 + m20 * m20);
    const Vec3 d0 = g0 * r - n, d1 = g1 * r - n, d2 = g2 * r - n, d = sum * r - n * 3;
    return {std::max(0.0, area / 180 * integral * r * r),
            area / 12 * (squared_norm(d0) + squared_norm(d1) + squared_norm(d2) + squared_norm(d))};
}

TriangleEnergy plane_triangle_energy(const Vec3& plane_normal, double offset, const Vec3& v0, const Vec3& v1,
                                     const Vec3& v2, const Vec3& n, double area) noexcept {
    if (!(area > 0)) return {};
    const double d0 = dot(plane_normal, v0) + offset, d1 = dot(plane_normal, v1) + offset,
                 d2 = dot(plane_normal, v2) + offset;
    return {area / 6 * (d0 * d0 + d1 * d1 + d2 * d2 + d0 * d1 + d1 * d2 + d2 * d0),
            area * squared_norm(plane_normal - n)};
}

TriangleEnergy moment_energy(const Coefficients& c, const Moments& m) noexcept {
    Matrix<10> a;
    distance_matrix(m, a);
    const double distance = quadratic_form(a, c);
    for (auto& row : a) row.fill(0);
    add_normal_matrix(m, 1, a);
    const double normal = quadratic_form(a, c) - 2 * dot(c, normal_vector(m)) + m.normal_area;
    return {std::max(0.0, distance), std::max(0.0, normal)};
}

}  // namespace quadseg::quadric
