#include "quadric/sheets.h"

#include "math/symmetric3.h"

#include <algorithm>
#include <cmath>

namespace quadseg::quadric {
namespace {

/// Terms of f below this share of the largest second-degree one do not bend the surface visibly over the region: a
/// hyperbola's bend or a hyperboloid's waist of 2 % of the region's size counts as an edge or an apex.
constexpr double small_bend = 4e-4;
constexpr double rounding = 1e-12;

}  // namespace

Sheets::Sheets(const Coefficients& local) noexcept {
    const EigenSystem e = eigen_decomposition({local[4], local[5] / 2, local[6] / 2, local[7], local[8] / 2, local[9]});
    const double largest = std::max(std::abs(e.values[0]), std::abs(e.values[2]));
    const Vec3 b{local[1], local[2], local[3]};
    double rest = local[0], linear_left = 0;
    for (int i = 0; i < 3; ++i) {
        axis_[i] = e.vectors[i];
        const double linear = dot(b, axis_[i]);
        if (std::abs(e.values[i]) > small_bend * largest) {
            lambda_[i] = e.values[i];
            centre_[i] = -linear / (2 * lambda_[i]);
            rest -= linear * linear / (4 * lambda_[i]);
        } else {
            linear_left = std::max(linear_left, std::abs(linear));
        }
    }
    if (!(largest > 0) || linear_left > small_bend * largest) return;  // plane, paraboloid, parabolic cylinder
    decide(-rest, largest);
}

bool Sheets::second_side(const Vec3& x) const noexcept {
    if (kind_ == Kind::by_nearer_plane) {
        const double p = std::sqrt(std::abs(lambda_[first_])) * (dot(axis_[first_], x) - centre_[first_]);
        const double q = std::sqrt(std::abs(lambda_[second_])) * (dot(axis_[second_], x) - centre_[second_]);
        return p * q < 0;  // |p + q| < |p − q|
    }
    return dot(axis_[first_], x) < centre_[first_];
}

bool Sheets::foot_on_second_side(const Coefficients& c, const Vec3& x) const noexcept {
    const Vec3 g = gradient(c, x);
    const double g2 = squared_norm(g), f = value(c, x);
    // Where the first-order step is longer than the region it tells nothing.
    return second_side(f * f < g2 ? x - g * (f / g2) : x);
}

void Sheets::decide(double k, double largest) noexcept {
    int positive = 0, negative = 0;
    for (const double l : lambda_) {
        positive += l > 0;
        negative += l < 0;
    }
    if (positive == 0 || negative == 0) {
        // Ellipsoid, elliptic cylinder, parallel planes; however small, they are real.
        const double signed_k = positive > 0 ? k : -k;
        if (!(signed_k > rounding * largest)) {
            kind_ = positive + negative > 1 || signed_k < -rounding * largest ? Kind::imaginary : Kind::connected;
        } else if (positive + negative == 1) {
            kind_ = Kind::by_sign;
            choose(positive > 0);
        }
        return;
    }
    const bool cone_like = std::abs(k) <= small_bend * largest;
    if (cone_like && positive == 1 && negative == 1) {
        kind_ = Kind::by_nearer_plane;
        first_ = lambda_[0] != 0 ? 0 : 1;
        second_ = lambda_[2] != 0 ? 2 : 1;
    } else if (cone_like) {
        kind_ = Kind::by_sign;  // the two nappes, on either side of the apex
        choose(positive == 1);
    } else if ((k > 0 ? positive : negative) == 1) {
        kind_ = Kind::by_sign;  // two-sheet hyperboloid, hyperbolic cylinder
        choose(k > 0);
    }
}

void Sheets::choose(bool positive) noexcept {
    for (int i = 0; i < 3; ++i) {
        if (positive ? lambda_[i] > 0 : lambda_[i] < 0) first_ = i;
    }
}

}  // namespace quadseg::quadric
