#include "quadric/axis.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace quadseg::quadric {
namespace {

/// Eigenvalues as mean + 2·spread·cos(angle + 2πk/3), the largest first (k = 0), the smallest at k = 1.
struct Trigonometric {
    double mean = 0, spread = 0, angle = 0;

    explicit Trigonometric(const Symmetric3& m) noexcept : mean((m.xx + m.yy + m.zz) / 3) {
        const double x = m.xx - mean, y = m.yy - mean, z = m.zz - mean;
        const double off = m.xy * m.xy + m.xz * m.xz + m.yz * m.yz;
        spread = std::sqrt((x * x + y * y + z * z + 2 * off) / 6);
        if (!(spread > 0)) return;
        const double determinant =
            x * (y * z - m.yz * m.yz) - m.xy * (m.xy * z - m.yz * m.xz) + m.xz * (m.xy * m.yz - y * m.xz);
        const double cosine = determinant / (2 * spread * spread * spread);
        angle = std::acos(std::clamp(cosine, -1.0, 1.0)) / 3;
    }
    double largest() const noexcept { return mean + 2 * spread * std::cos(angle); }
    double smallest() const noexcept { return mean + 2 * spread * std::cos(angle + 2 * std::numbers::pi / 3); }
};

/// The kernel of m − λ: perpendicular to its rows.
Vec3 eigenvector(const Symmetric3& m, double lambda) noexcept {
    const Vec3 r0{m.xx - lambda, m.xy, m.xz}, r1{m.xy, m.yy - lambda, m.yz}, r2{m.xz, m.yz, m.zz - lambda};
    const Vec3 c0 = cross(r0, r1), c1 = cross(r0, r2), c2 = cross(r1, r2);
    const double n0 = squared_norm(c0), n1 = squared_norm(c1), n2 = squared_norm(c2);
    return normalized(n0 >= n1 && n0 >= n2 ? c0 : n1 >= n2 ? c1 : c2);
}

bool is_unit(const Vec3& v) noexcept {
    return squared_norm(v) > 0.5;
}

}  // namespace

Vec3 smallest_eigenvector(const Symmetric3& m) noexcept {
    const Vec3 v = eigenvector(m, Trigonometric(m).smallest());
    return is_unit(v) ? v : eigen_decomposition(m).vectors[0];
}

Vec3 isolated_eigenvector(const Symmetric3& m) noexcept {
    const Trigonometric t(m);
    // angle in [0, π/3]: below π/6 the two smaller eigenvalues are the closer pair.
    const bool largest = t.angle < std::numbers::pi / 6;
    const Vec3 v = eigenvector(m, largest ? t.largest() : t.smallest());
    return is_unit(v) ? v : eigen_decomposition(m).vectors[largest ? 2 : 0];
}

}  // namespace quadseg::quadric
