#include "quadric/moments.h"

#include "quadric/triangle_moments.h"

#include <cmath>

namespace quadseg::quadric {
namespace {

constexpr std::array<std::array<int, 3>, 35> all_exponents() {
    std::array<std::array<int, 3>, 35> result{};
    for (int degree = 0; degree <= 4; ++degree) {
        for (int rest = 0; rest <= degree; ++rest) {
            for (int k = 0; k <= rest; ++k) {
                result[moment_index(degree - rest, rest - k, k)] = {degree - rest, rest - k, k};
            }
        }
    }
    return result;
}

}  // namespace

const std::array<std::array<int, 3>, 35> moment_exponents = all_exponents();

Moments& Moments::operator+=(const Moments& b) noexcept {
    for (std::size_t i = 0; i < area.size(); ++i) area[i] += b.area[i];
    for (std::size_t i = 0; i < normal.size(); ++i) normal[i] += b.normal[i];
    for (std::size_t i = 0; i < normal2.size(); ++i) normal2[i] += b.normal2[i];
    total_area += b.total_area;
    normal_area += b.normal_area;
    return *this;
}

Moments& Moments::operator-=(const Moments& b) noexcept {
    for (std::size_t i = 0; i < area.size(); ++i) area[i] -= b.area[i];
    for (std::size_t i = 0; i < normal.size(); ++i) normal[i] -= b.normal[i];
    for (std::size_t i = 0; i < normal2.size(); ++i) normal2[i] -= b.normal2[i];
    total_area -= b.total_area;
    normal_area -= b.normal_area;
    return *this;
}

void accumulate(Moments& m, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& n, double area, double w2,
                double w1) noexcept {
    const std::array<double, 9> corners = {a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z};
    std::array<double, 35> t;
    triangle_moments(corners.data(), area, t.data());
    for (std::size_t i = 0; i < t.size(); ++i) m.area[i] += w2 * t[i];
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double w = w1 * n[static_cast<int>(axis)];
        for (std::size_t k = 0; k < 4; ++k) m.normal[normal_index(axis, k)] += w * t[k];
    }
    m.normal2[0] += area * n.x * n.x;
    m.normal2[1] += area * n.x * n.y;
    m.normal2[2] += area * n.x * n.z;
    m.normal2[3] += area * n.y * n.y;
    m.normal2[4] += area * n.y * n.z;
    m.normal2[5] += area * n.z * n.z;
    m.total_area += area;
    m.normal_area += area * squared_norm(n);
}

Moments shifted(const Moments& m, const Vec3& shift) noexcept {
    Moments r = m;
    translate_moments(r.area.data(), -shift.x, -shift.y, -shift.z);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double mean = m.normal[normal_index(axis, 0)];
        r.normal[normal_index(axis, 1)] -= shift.x * mean;
        r.normal[normal_index(axis, 2)] -= shift.y * mean;
        r.normal[normal_index(axis, 3)] -= shift.z * mean;
    }
    return r;
}

Moments scaled(const Moments& m, double s) noexcept {
    const double s2 = s * s, s3 = s2 * s, s4 = s2 * s2, s5 = s4 * s, s6 = s4 * s2;
    Moments r = m;
    r.area[0] *= s2;
    for (std::size_t i = 1; i < 4; ++i) r.area[i] *= s3;
    for (std::size_t i = 4; i < 10; ++i) r.area[i] *= s4;
    for (std::size_t i = 10; i < 20; ++i) r.area[i] *= s5;
    for (std::size_t i = 20; i < 35; ++i) r.area[i] *= s6;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        r.normal[normal_index(axis, 0)] *= s2;
        for (std::size_t k = 1; k < 4; ++k) r.normal[normal_index(axis, k)] *= s3;
    }
    for (double& v : r.normal2) v *= s2;
    r.total_area *= s2;
    r.normal_area *= s2;
    return r;
}

Spread spread(const Moments& m) noexcept {
    const double area = m.area[0];
    if (!(area > 0)) return {};
    const Vec3 centroid{m.area[1] / area, m.area[2] / area, m.area[3] / area};
    const double mean_square = (m.area[4] + m.area[7] + m.area[9]) / area - squared_norm(centroid);
    return {centroid, mean_square > 0 ? std::sqrt(mean_square) : 0};
}

}  // namespace quadseg::quadric
