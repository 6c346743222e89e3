// Quadrics as coefficient vectors: f(x) = c · [1, x, y, z, x², xy, xz, y², yz, z²] (the appendix's order, MATH.md §1).
#pragma once

#include "math/vec3.h"

#include <array>

namespace quadseg::quadric {

using Coefficients = std::array<double, 10>;

inline double value(const Coefficients& c, const Vec3& p) noexcept {
    return c[0] + p.x * (c[1] + c[4] * p.x + c[5] * p.y + c[6] * p.z) + p.y * (c[2] + c[7] * p.y + c[8] * p.z) +
           p.z * (c[3] + c[9] * p.z);
}
inline Vec3 gradient(const Coefficients& c, const Vec3& p) noexcept {
    return {c[1] + 2 * c[4] * p.x + c[5] * p.y + c[6] * p.z, c[2] + c[5] * p.x + 2 * c[7] * p.y + c[8] * p.z,
            c[3] + c[6] * p.x + c[8] * p.y + 2 * c[9] * p.z};
}
/// The same surface in coordinates u = (x − origin) · scale; values of f are kept: f'(u) = f(x).
Coefficients to_local(const Coefficients& c, const Vec3& origin, double scale) noexcept;
/// The reverse of to_local.
Coefficients from_local(const Coefficients& c, const Vec3& origin, double scale) noexcept;
/// Plane n·x + d as a quadric.
inline Coefficients plane(const Vec3& n, double d) noexcept {
    return {d, n.x, n.y, n.z, 0, 0, 0, 0, 0, 0};
}
inline bool is_plane(const Coefficients& c) noexcept {
    return c[4] == 0 && c[5] == 0 && c[6] == 0 && c[7] == 0 && c[8] == 0 && c[9] == 0;
}

}  // namespace quadseg::quadric
