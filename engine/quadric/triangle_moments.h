// Exact moments of one triangle, for double or for a pack of lanes (one triangle a lane).
//
// About its centroid a triangle's moments of degree ≤ 4 follow from power sums of its corners u1 + u2 + u3 = 0
// (MATH.md §2 with h_p in power sums, p1 = 0): ∫uu = |t|/12 Σuu, ∫uuu = |t|/30 Σuuu and, as Σu⁴ = (Σu²)²/2 then,
// ∫u⁴ = |t|/60 (Σu²)² in every direction, which polarises to products of second moments. One shift brings them to the
// origin of the frame.
#pragma once

#include "math/vec3.h"
#include "quadric/monomials.h"

#include <array>
#include <cstddef>
#include <utility>

namespace quadseg::quadric {

/// Index of the monomial x^i y^j z^k among the 35 of moment_exponents.
constexpr std::size_t moment_index(int i, int j, int k) noexcept {
    constexpr std::array<std::size_t, 5> first = {0, 1, 4, 10, 20};
    const std::size_t rest = static_cast<std::size_t>(j) + static_cast<std::size_t>(k);
    return first[static_cast<std::size_t>(i) + rest] + rest * (rest + 1) / 2 + static_cast<std::size_t>(k);
}

namespace detail {

struct ShiftStep {
    std::size_t to = 0, from = 0;
};

/// m(…, p, …) += s · m(…, p − 1, …) in the order of a Taylor shift along one axis: 35 steps, each one multiply-add.
constexpr std::array<ShiftStep, 35> shift_steps(int axis) noexcept {
    std::array<ShiftStep, 35> steps{};
    std::size_t count = 0;
    const auto index = [axis](int along, int second, int third) {
        return axis == 0   ? moment_index(along, second, third)
               : axis == 1 ? moment_index(second, along, third)
                           : moment_index(second, third, along);
    };
    for (int rest = 0; rest <= 3; ++rest) {
        for (int third = 0; third <= rest; ++third) {
            for (int pass = 1; pass <= 4 - rest; ++pass) {
                for (int along = 4 - rest; along >= pass; --along) {
                    steps[count].to = index(along, rest - third, third);
                    steps[count].from = index(along - 1, rest - third, third);
                    ++count;
                }
            }
        }
    }
    return steps;
}

template <int axis>
inline constexpr std::array<ShiftStep, 35> axis_shift_steps = shift_steps(axis);

template <int axis, class T, std::size_t... I>
inline void shift_along(T* m, const T& s, std::index_sequence<I...> /*steps*/) noexcept {
    ((m[axis_shift_steps<axis>[I].to] = m[axis_shift_steps<axis>[I].to] + s * m[axis_shift_steps<axis>[I].from]), ...);
}

}  // namespace detail

/// The 35 moments m of x become those of x + (sx, sy, sz).
template <class T>
inline void translate_moments(T* m, const T& sx, const T& sy, const T& sz) noexcept {
    detail::shift_along<0>(m, sx, std::make_index_sequence<35>{});
    detail::shift_along<1>(m, sy, std::make_index_sequence<35>{});
    detail::shift_along<2>(m, sz, std::make_index_sequence<35>{});
}

/// corners: x y z of three corners. Writes all 35 entries of `m`.
template <class Corners, class T>
inline void triangle_moments(const Corners& corners, const T& area, T* m) noexcept {
    const T gx = (corners[0] + corners[3] + corners[6]) * (1.0 / 3);
    const T gy = (corners[1] + corners[4] + corners[7]) * (1.0 / 3);
    const T gz = (corners[2] + corners[5] + corners[8]) * (1.0 / 3);
    T xx{}, xy{}, xz{}, yy{}, yz{}, zz{};
    T xxx{}, xxy{}, xxz{}, xyy{}, xyz{}, xzz{}, yyy{}, yyz{}, yzz{}, zzz{};
    for (std::size_t i = 0; i < 3; ++i) {
        const T x = corners[3 * i] - gx, y = corners[3 * i + 1] - gy, z = corners[3 * i + 2] - gz;
        const T x2 = x * x, y2 = y * y, z2 = z * z, x_y = x * y;
        xx = xx + x2;
        xy = xy + x_y;
        xz = xz + x * z;
        yy = yy + y2;
        yz = yz + y * z;
        zz = zz + z2;
        xxx = xxx + x2 * x;
        xxy = xxy + x2 * y;
        xxz = xxz + x2 * z;
        xyy = xyy + y2 * x;
        xyz = xyz + x_y * z;
        xzz = xzz + z2 * x;
        yyy = yyy + y2 * y;
        yyz = yyz + y2 * z;
        yzz = yzz + z2 * y;
        zzz = zzz + z2 * z;
    }
    const T k2 = area * (1.0 / 12), k3 = area * (1.0 / 30);
    m[0] = area;
    m[1] = m[2] = m[3] = T{};
    m[4] = k2 * xx;
    m[5] = k2 * xy;
    m[6] = k2 * xz;
    m[7] = k2 * yy;
    m[8] = k2 * yz;
    m[9] = k2 * zz;
    m[10] = k3 * xxx;
    m[11] = k3 * xxy;
    m[12] = k3 * xxz;
    m[13] = k3 * xyy;
    m[14] = k3 * xyz;
    m[15] = k3 * xzz;
    m[16] = k3 * yyy;
    m[17] = k3 * yyz;
    m[18] = k3 * yzz;
    m[19] = k3 * zzz;
    const T k4 = area * (1.0 / 60), k43 = area * (1.0 / 180);
    const T kxx = k4 * xx, kyy = k4 * yy, kzz = k4 * zz;
    m[20] = kxx * xx;
    m[21] = kxx * xy;
    m[22] = kxx * xz;
    m[23] = k43 * (xx * yy + 2.0 * xy * xy);
    m[24] = k43 * (xx * yz + 2.0 * xy * xz);
    m[25] = k43 * (xx * zz + 2.0 * xz * xz);
    m[26] = kyy * xy;
    m[27] = k43 * (yy * xz + 2.0 * xy * yz);
    m[28] = k43 * (zz * xy + 2.0 * xz * yz);
    m[29] = kzz * xz;
    m[30] = kyy * yy;
    m[31] = kyy * yz;
    m[32] = k43 * (yy * zz + 2.0 * yz * yz);
    m[33] = kzz * yz;
    m[34] = kzz * zz;
    translate_moments(m, gx, gy, gz);
}

}  // namespace quadseg::quadric
