#include "surface/quadric_projector.h"

#include "math/symmetric3.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace quadseg::surface {

namespace {

// Eigenvalues and linear terms below this share of the largest are rounding of an exact zero.
constexpr double rounding_share = 1e-14;
// An extremum of f that close to 0 (relative to the terms that cancel in it) is a degenerate quadric, not a tiny one.
constexpr double degenerate_share = 1e-13;
constexpr int most_iterations = 100;
// ν, the squared ratio of distances to the centre, above which f(p) is too rounded.
constexpr double far_away = 1e4;

}  // namespace

QuadricProjector::QuadricProjector(const quadric::Coefficients& c) {
    double largest = 0;
    for (double v : c) {
        if (!std::isfinite(v)) return;
        largest = std::max(largest, std::abs(v));
    }
    if (!(largest > 0)) return;
    const double unit = 1 / largest;
    const Symmetric3 hessian{2 * c[4] * unit, c[5] * unit, c[6] * unit, 2 * c[7] * unit, c[8] * unit, 2 * c[9] * unit};
    const Vec3 linear = Vec3{c[1], c[2], c[3]} * unit;
    c0_ = c[0] * unit;
    EigenSystem eigen = eigen_decomposition(hessian);
    const double top = std::max(std::abs(eigen.values[0]), std::abs(eigen.values[2]));
    int zeros = 0;
    for (int i = 0; i < 3; ++i) {
        d_[i] = std::abs(eigen.values[i]) > rounding_share * top ? eigen.values[i] : 0;
        axes_[i] = eigen.vectors[i];
        b_[i] = dot(axes_[i], linear);
        zeros += d_[i] == 0;
    }
    const double slope_scale = norm(linear) + std::sqrt(std::abs(c0_) * top);
    double extremum = c0_, cancelled = std::abs(c0_);
    bool slope = false;
    for (int i = 0; i < 3; ++i) {
        if (d_[i] == 0) {
            if (std::abs(b_[i]) <= rounding_share * slope_scale) b_[i] = 0;
            slope = slope || b_[i] != 0;
        } else {
            extremum -= b_[i] * b_[i] / (2 * d_[i]);
            cancelled += b_[i] * b_[i] / (2 * std::abs(d_[i]));
        }
    }
    planar_ = zeros == 3;
    if (planar_) {
        empty_ = !slope;
        return;
    }
    const bool bottom = !slope && std::abs(extremum) <= degenerate_share * cancelled;
    bool real = true;
    for (int s = 0; s < 2; ++s) {
        Side& side = side_[s];
        for (int i = 0; i < 3; ++i) {
            side.d[i] = s == 0 ? d_[i] : -d_[i];
            side.inverse_d[i] = side.d[i] == 0 ? 0 : 1 / side.d[i];
        }
        const int lowest = int(std::min_element(side.d, side.d + 3) - side.d);
        const int highest = int(std::max_element(side.d, side.d + 3) - side.d);
        side.pole = side.d[lowest] < 0;
        side.k = side.pole ? lowest : highest;
        side.scale = 1 / std::abs(side.d[side.k]);
        for (int i = 0; i < 3; ++i) side.r[i] = side.d[i] / side.d[side.k];
        side.bottom = bottom && !side.pole;
        // A definite form whose extremum lies on the same side of 0 as all other values has no real point.
        if (!side.pole && !slope && !bottom && (s == 0 ? extremum : -extremum) > 0) real = false;
    }
    empty_ = !real;
}

double QuadricProjector::value(const Vec3& p) const noexcept {
    double f = c0_;
    for (int i = 0; i < 3; ++i) {
        const double u = dot(axes_[i], p);
        f += u * (0.5 * d_[i] * u + b_[i]);
    }
    return f;
}

Vec3 QuadricProjector::gradient(const Vec3& p) const noexcept {
    Vec3 g;
    for (int i = 0; i < 3; ++i) g += (d_[i] * dot(axes_[i], p) + b_[i]) * axes_[i];
    return g;
}

Vec3 QuadricProjector::foot_point(const Vec3& p) const noexcept {
    if (empty_) return p;
    double f = c0_, w[3], u[3];
    for (int i = 0; i < 3; ++i) {
        u[i] = dot(axes_[i], p);
        const double du = d_[i] * u[i];
        f += u[i] * (0.5 * du + b_[i]);
        w[i] = du + b_[i];
    }
    if (!std::isfinite(f)) return p;
    if (planar_)
        return p -
               (f / (w[0] * w[0] + w[1] * w[1] + w[2] * w[2])) * (w[0] * axes_[0] + w[1] * axes_[1] + w[2] * axes_[2]);
    if (f < 0) {
        for (double& wi : w) wi = -wi;
        f = -f;
        const Vec3 e = displacement(side_[1], f, w, u);
        return p - (e.x * axes_[0] + e.y * axes_[1] + e.z * axes_[2]);
    }
    const Vec3 e = displacement(side_[0], f, w, u);
    return p - (e.x * axes_[0] + e.y * axes_[1] + e.z * axes_[2]);
}

// No root inside: p lies in the symmetry plane (or axis) of the pole's eigenvectors, along which the foot point is
// free. The lowest index and the sign of w, or +, decide.
Vec3 QuadricProjector::at_pole(const Side& side, double value, const double* w) noexcept {
    double e[3]{}, rest = value;
    for (int i = 0; i < 3; ++i) {
        const double q = 1 - side.r[i];
        if (i == side.k || !(q > 0)) continue;
        e[i] = side.scale * w[i] / q;
        rest -= 0.5 * side.scale * w[i] * w[i] * (1 + q) / (q * q);
    }
    const double free = std::sqrt(2 * std::max(rest, 0.0) * side.scale);
    e[side.k] = w[side.k] < 0 ? -free : free;
    return {e[0], e[1], e[2]};
}

Vec3 QuadricProjector::displacement(const Side& side, double value, const double* w, const double* u) const noexcept {
    if (!(value > 0)) return {};
    const double T = side.scale;
    const double w2[3] = {w[0] * w[0], w[1] * w[1], w[2] * w[2]};
    const double sum = w2[0] + w2[1] + w2[2];
    if (side.bottom) return {w[0] * side.inverse_d[0], w[1] * side.inverse_d[1], w[2] * side.inverse_d[2]};

    // Pole: t = T (1 − μ), 1 + t d_i = (1 − r_i) + μ r_i. Infinite: t = T (1 − μ)/μ. In both μ = 1/√(1 + ν).
    const double ratio = 2 * value / T;
    double low, high, nu;
    if (side.pole) {
        // All terms are positive and each falls with 1 + t d_i ≥ μ: the pole's term alone and all terms taken as pole
        // terms bound the root.
        low = ratio / sum;
        const double pole = w2[side.k];
        if (!(pole > 1e-290 * sum)) {
            double at_end = 0;
            for (int i = 0; i < 3; ++i) {
                const double q = 1 - side.r[i];
                if (i != side.k && w2[i] > 0) at_end += w2[i] * (1 + q) / (q * q);
            }
            if (!(at_end * 0.5 * T > value)) return at_pole(side, value, w);
        }
        high = pole > 0 ? ratio / pole : std::numeric_limits<double>::infinity();
        nu = low;
    } else {
        // t ≥ F/Σw² by concavity; all terms taken with the largest eigenvalue bound κ = ν/(1 + ν) from above.
        const double x = value / (T * sum);
        low = x * (2 + x);
        const double kappa = ratio / sum;
        high = kappa < 1 ? kappa / (1 - kappa) : std::numeric_limits<double>::infinity();
        nu = low;
    }
    double q[3]{}, t = 0, mu = 1;
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
        mu = 1 / std::sqrt(1 + nu);
        double s = 0, slope = 0;
        if (side.pole) {
            t = T * nu * mu * mu / (1 + mu);
            for (int i = 0; i < 3; ++i) q[i] = (1 - side.r[i]) + side.r[i] * mu;
        } else {
            t = T * nu * mu / (1 + mu);
            for (int i = 0; i < 3; ++i) q[i] = 1 + t * side.d[i];
        }
        for (int i = 0; i < 3; ++i) {
            const double inverse = 1 / q[i], g = w2[i] * inverse * inverse;
            s += g * (1 + q[i]);
            slope += g * inverse;
        }
        s *= 0.5 * t;
        const double excess = s - value;
        if (excess > 0)
            high = nu;
        else
            low = nu;
        if (std::abs(excess) <= 2e-16 * value || !(slope > 0)) break;
        double next;
        if (side.pole) {
            // dt/dν = T μ³ / 2
            next = nu - excess / (slope * 0.5 * T * mu * mu * mu);
        } else {
            // Newton in κ = ν/(1 + ν): dt/dκ = T / (2 μ³)
            const double step = excess * 2 * mu * mu * mu / (slope * T) * (1 + nu);
            const double denominator = 1 + step;
            next = denominator > 0 ? (nu - step) / denominator : std::numeric_limits<double>::infinity();
        }
        if (!(next > low && next < high)) {
            if (std::isinf(high))
                next = 16 * low + 1e-300;
            else
                next = std::sqrt(low) * std::sqrt(high);
            if (!(next > low && next < high)) break;
        }
        if (std::abs(next - nu) <= 1e-16 * nu) break;
        nu = next;
    }
    if (!side.pole && nu > far_away) {
        // So far from the surface f(p) has lost what tells the root; f at the foot point itself has not.
        const double sign = &side == &side_[0] ? 1 : -1;
        for (int correction = 0; correction < 4; ++correction) {
            double f = c0_, slope = 0;
            for (int i = 0; i < 3; ++i) {
                const double y = u[i] - t * w[i] / q[i];
                f += y * (0.5 * d_[i] * y + b_[i]);
                slope += w2[i] / (q[i] * q[i] * q[i]);
            }
            const double next = t + sign * f / slope;
            if (!(next > 0) || !std::isfinite(next)) break;
            t = next;
            for (int i = 0; i < 3; ++i) q[i] = 1 + t * side.d[i];
        }
    }
    return {t * w[0] / q[0], t * w[1] / q[1], t * w[2] / q[2]};
}

}  // namespace quadseg::surface
