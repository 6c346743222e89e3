#include "math/symmetric3.h"
#include "quadric/fit.h"

#include <algorithm>
#include <cmath>

namespace quadseg::quadric {
namespace {

/// argmin nᵀ S n − 2 b·n over |n| = 1: n(μ) = (S + μ)⁻¹ b with the μ > −λ_min for which |n(μ)| = 1; |n(μ)| falls with
/// μ.
Vec3 constrained_minimum_by_eigenvectors(const Symmetric3& s, const Vec3& b) noexcept {
    const EigenSystem e = eigen_decomposition(s);
    const double beta[3] = {dot(b, e.vectors[0]), dot(b, e.vectors[1]), dot(b, e.vectors[2])};
    const double gap[3] = {0, e.values[1] - e.values[0], e.values[2] - e.values[0]};
    // t = μ + λ_min in (0, |b|]: the smallest-eigenvalue part alone puts |n| ≥ 1 at t = |β0|, the whole |n| ≤ 1 at |b|.
    double t = std::abs(beta[0]), high = norm(b);
    double y[3] = {0, 0, 0};
    const auto length = [&] {
        for (int i = 0; i < 3; ++i) y[i] = t + gap[i] > 0 ? beta[i] / (t + gap[i]) : 0;
        return std::sqrt(y[0] * y[0] + y[1] * y[1] + y[2] * y[2]);
    };
    if (!(high > 0)) return e.vectors[0];
    if (std::abs(beta[0]) <= 1e-14 * high) {
        // The hard case: if the rest is shorter than 1 even at t = 0, the eigenvector makes up for it.
        t = 0;
        y[0] = 0;
        const double rest = length();
        if (rest < 1) {
            const double fill = std::sqrt(std::max(0.0, 1 - y[1] * y[1] - y[2] * y[2]));
            return normalized(e.vectors[0] * fill + e.vectors[1] * y[1] + e.vectors[2] * y[2]);
        }
    }
    double low = t;
    for (int step = 0; step < 60; ++step) {
        const double l = length();
        if (!(std::abs(l - 1) > 1e-15)) break;
        (l > 1 ? low : high) = t;
        // Newton on 1/|n| − 1, which is nearly linear.
        double slope = 0;
        for (int i = 0; i < 3; ++i) slope += t + gap[i] > 0 ? y[i] * y[i] / (t + gap[i]) : 0;
        double next = slope > 0 ? t + (l - 1) * l * l / slope : 0.5 * (low + high);
        if (!(next > low && next < high)) next = 0.5 * (low + high);
        if (next == t) break;
        t = next;
    }
    length();
    return normalized(e.vectors[0] * y[0] + e.vectors[1] * y[1] + e.vectors[2] * y[2]);
}

/// The same by Newton's method from μ = |b|, where |n| ≤ 1, with an adjugate a step: for nearly flat regions, where S
/// is small beside b, two or three steps. Zero when it does not settle inside the interval.
Vec3 constrained_minimum_by_newton(const Symmetric3& s, const Vec3& b) noexcept {
    double mu = norm(b);
    // μ stays right of −λ_min as long as S + μ is positive definite.
    for (int step = 0; step < 8; ++step) {
        const double xx = s.xx + mu, yy = s.yy + mu, zz = s.zz + mu;
        const Symmetric3 adjugate{yy * zz - s.yz * s.yz, s.xz * s.yz - s.xy * zz, s.xy * s.yz - s.xz * yy,
                                  xx * zz - s.xz * s.xz, s.xy * s.xz - xx * s.yz, xx * yy - s.xy * s.xy};
        const double determinant = xx * adjugate.xx + s.xy * adjugate.xy + s.xz * adjugate.xz;
        if (!(xx > 0 && adjugate.zz > 0 && determinant > 0)) return {};
        const double r = 1 / determinant;
        const Vec3 n = adjugate * b * r;
        const double square = squared_norm(n);
        if (std::abs(square - 1) < 1e-14) return normalized(n);
        const double slope = dot(n, adjugate * n) * r;
        const double length = std::sqrt(square);
        mu += (length - 1) * square / slope;
    }
    return {};
}

Vec3 constrained_minimum(const Symmetric3& s, const Vec3& b) noexcept {
    const Vec3 n = constrained_minimum_by_newton(s, b);
    return squared_norm(n) > 0.5 ? n : constrained_minimum_by_eigenvectors(s, b);
}

}  // namespace

QuadricFit fit_plane(const Moments& m, double weight) noexcept {
    const double area = m.area[0];
    if (!(area > 0)) return {plane({0, 0, 1}, 0), 0, true};
    const auto& v = m.area;
    const Vec3 centroid{v[1] / area, v[2] / area, v[3] / area};
    const Symmetric3 covariance{v[4] - v[1] * centroid.x, v[5] - v[1] * centroid.y, v[6] - v[1] * centroid.z,
                                v[7] - v[2] * centroid.y, v[8] - v[2] * centroid.z, v[9] - v[3] * centroid.z};
    const Vec3 normals{m.normal[0], m.normal[4], m.normal[8]};
    const Vec3 pull = normals * weight;
    Vec3 n = constrained_minimum(covariance, pull);
    if (weight == 0 && dot(n, normals) < 0) n = -n;
    if (!(squared_norm(n) > 0.5)) n = {0, 0, 1};
    const double distance = std::max(0.0, dot(n, covariance * n));
    const double normal = std::max(0.0, 2 * (m.normal_area - dot(n, normals)));
    return {plane(n, -dot(n, centroid)), distance + weight * normal, false};
}

}  // namespace quadseg::quadric
