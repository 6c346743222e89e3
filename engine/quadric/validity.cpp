// Whether a quadric is an appropriate stand-in for a region: its foot points lie on one connected sheet (section 4.3.3,
// MATH.md §4) and the region's normals agree with its gradient.

#include "math/symmetric3.h"
#include "quadric/region_fit.h"

#include <algorithm>
#include <cmath>

namespace quadseg::quadric {
namespace {

/// At most this share of a region's area may lie on another sheet or against the gradient.
constexpr double tolerated_share = 0.01;
/// Curvature-like terms below this share of the largest do not bend the surface over the region.
constexpr double flat_ratio = 1e-4;
/// Features of a quadric smaller than this share of the region (a hyperbola's bend, a hyperboloid's waist) are none.
constexpr double small_feature = 0.02;

/// f = Σ λ_i y_i² − k in the principal frame, as far as the linear terms allow it; lengths relative to the region.
class Sheets {
  public:
    enum class Kind { connected, imaginary, by_sign, by_nearer_plane };

    Sheets(const Coefficients& local, double /*unit*/) noexcept {
        const EigenSystem e =
            eigen_decomposition({local[4], local[5] / 2, local[6] / 2, local[7], local[8] / 2, local[9]});
        const double largest = std::max(std::abs(e.values[0]), std::abs(e.values[2]));
        const Vec3 b{local[1], local[2], local[3]};
        double rest = local[0], linear_left = 0;
        for (int i = 0; i < 3; ++i) {
            axis_[i] = e.vectors[i];
            const double linear = dot(b, axis_[i]);
            if (std::abs(e.values[i]) > flat_ratio * largest) {
                lambda_[i] = e.values[i];
                centre_[i] = -linear / (2 * lambda_[i]);
                rest -= linear * linear / (4 * lambda_[i]);
            } else {
                linear_left = std::max(linear_left, std::abs(linear));
            }
        }
        if (!(largest > 0) || linear_left > flat_ratio * largest) return;  // plane, paraboloid, parabolic cylinder
        decide(-rest, largest);
    }

    Kind kind() const noexcept { return kind_; }

    /// Side of the nearest surface point to x, of two.
    bool second_side(const Vec3& x) const noexcept {
        if (kind_ == Kind::by_nearer_plane) {
            const double p = std::sqrt(std::abs(lambda_[first_])) * (dot(axis_[first_], x) - centre_[first_]);
            const double q = std::sqrt(std::abs(lambda_[second_])) * (dot(axis_[second_], x) - centre_[second_]);
            return p * q < 0;  // |p + q| < |p − q|
        }
        return dot(axis_[first_], x) < centre_[first_];
    }

  private:
    void decide(double k, double largest) noexcept {
        const double tiny = small_feature * small_feature * largest;
        int positive = 0, negative = 0;
        for (const double l : lambda_) {
            positive += l > 0;
            negative += l < 0;
        }
        if (std::abs(k) <= tiny) {
            if (positive == 1 && negative == 1) {
                kind_ = Kind::by_nearer_plane;
                first_ = lambda_[0] != 0 ? 0 : 1;
                second_ = lambda_[2] != 0 ? 2 : 1;
            } else if (positive > 0 && negative > 0) {
                kind_ = Kind::by_sign;  // the two nappes, on either side of the apex
                choose(positive == 1);
            } else if (positive + negative > 1) {
                kind_ = Kind::imaginary;  // a line or a point
            }                             // a double plane stays connected
            return;
        }
        const int same = k > 0 ? positive : negative;
        if (same == 0) {
            kind_ = Kind::imaginary;
        } else if (same == 1) {
            kind_ = Kind::by_sign;  // two sheets, hyperbolic cylinder, parallel planes
            choose(k > 0);
        }
    }
    void choose(bool positive) noexcept {
        for (int i = 0; i < 3; ++i) {
            if (positive ? lambda_[i] > 0 : lambda_[i] < 0) first_ = i;
        }
    }

    Kind kind_ = Kind::connected;
    Vec3 axis_[3];
    double lambda_[3] = {0, 0, 0}, centre_[3] = {0, 0, 0};
    int first_ = 0, second_ = 2;
};

}  // namespace

bool is_valid(const Proxy& proxy, const TriangleSoup& region) {
    double area = 0, against = 0, square = 0;
    for (std::size_t t = 0; t < region.size(); ++t) {
        const Vec3 centroid =
            (region.corners[3 * t] + region.corners[3 * t + 1] + region.corners[3 * t + 2]) / 3.0 - proxy.origin;
        area += region.areas[t];
        square += region.areas[t] * squared_norm(centroid);
        if (!(dot(gradient(proxy.c, centroid), region.normals[t]) > 0)) against += region.areas[t];
    }
    if (!(area > 0)) return true;
    if (against > tolerated_share * area) return false;
    if (proxy.planar()) return true;

    const double radius = std::sqrt(square / area);
    if (!(radius > 0)) return true;
    const Sheets sheets(from_local(proxy.c, {}, radius), radius);
    if (sheets.kind() == Sheets::Kind::connected) return true;
    if (sheets.kind() == Sheets::Kind::imaginary) return false;
    double second = 0;
    for (std::size_t t = 0; t < region.size(); ++t) {
        const Vec3 x =
            (region.corners[3 * t] + region.corners[3 * t + 1] + region.corners[3 * t + 2]) / 3.0 - proxy.origin;
        const Vec3 g = gradient(proxy.c, x);
        const double g2 = squared_norm(g);
        // The first-order foot point, unless the gradient is too small for it to be near.
        const double f = value(proxy.c, x);
        const Vec3 foot = g2 > 0 && f * f <= g2 * g2 * radius * radius ? x - g * (f / g2) : x;
        if (sheets.second_side(foot / radius)) second += region.areas[t];
    }
    return std::min(second, area - second) <= tolerated_share * area;
}

}  // namespace quadseg::quadric
