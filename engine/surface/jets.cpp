#include "surface/jets.h"

#include "math/symmetric3.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace quadseg::surface {

namespace {

constexpr int most_terms = 15;  // order 4 in two variables
// Share of a column's norm that must be left after the columns before it are taken out.
constexpr double independent = 1e-7;

int order_for(std::size_t points) {
    return points >= 26 ? 4 : points >= 16 ? 3 : points >= 9 ? 2 : 1;
}

int term_count(int order) {
    return (order + 1) * (order + 2) / 2;
}

/// 1, u, v, u², uv, v², u³ …
void monomials(double u, double v, int order, double* row) {
    row[0] = 1;
    int first = 0, next = 1;
    for (int degree = 1; degree <= order; ++degree) {
        for (int i = 0; i < degree; ++i) row[next + i] = row[first + i] * u;
        row[next + degree] = row[first + degree - 1] * v;
        first = next;
        next += degree + 1;
    }
}

/// Height polynomial over a plane, in a frame centred and scaled to the points.
class HeightPolynomial {
  public:
    HeightPolynomial(std::span<const Vec3> points, const Vec3& orientation) {
        const std::size_t n = points.size();
        Vec3 sum;
        for (const Vec3& p : points) sum += p - points[0];
        centre_ = points[0] + sum / double(n);
        Symmetric3 covariance;
        double square = 0;
        for (const Vec3& p : points) {
            covariance.add_outer(p - centre_);
            square += squared_norm(p - centre_);
        }
        extent_ = std::sqrt(square / double(n));
        usable_ = n >= 3 && std::isfinite(extent_) && extent_ > 0 && std::isfinite(1 / extent_);
        normal_ = normalized(orientation);
        if (squared_norm(normal_) == 0) normal_ = eigen_decomposition(covariance).vectors[0];
        const Vec3 mean_plane = usable_ ? eigen_decomposition(covariance).vectors[0] : normal_;
        // The mean plane unless the points are too few or too curved to have one on the side of the normals.
        if (std::abs(dot(mean_plane, normal_)) > 0.7) normal_ = dot(mean_plane, normal_) > 0 ? mean_plane : -mean_plane;
        u_axis_ = any_perpendicular(normal_);
        v_axis_ = cross(normal_, u_axis_);
        if (!usable_) return;
        for (order_ = order_for(n); order_ >= 1 && !fit(points); --order_) {
        }
        usable_ = order_ >= 1;
    }

    bool usable() const { return usable_; }
    int order() const { return usable_ ? order_ : 0; }
    double residual() const { return residual_ * extent_; }
    const Vec3& plane_normal() const { return normal_; }

    struct Derivatives {
        double u = 0, v = 0, uu = 0, uv = 0, vv = 0;
    };
    Derivatives at(const Vec3& p) const {
        const Vec3 x = (p - centre_) / extent_;
        const double u = dot(x, u_axis_), v = dot(x, v_axis_);
        double pu[5] = {1, u, u * u, u * u * u, u * u * u * u}, pv[5] = {1, v, v * v, v * v * v, v * v * v * v};
        Derivatives d;
        int term = 0;
        for (int degree = 0; degree <= order_; ++degree) {
            for (int j = 0; j <= degree; ++j, ++term) {
                const int i = degree - j;
                const double c = c_[std::size_t(term)];
                if (i > 0) d.u += c * i * pu[i - 1] * pv[j];
                if (j > 0) d.v += c * j * pu[i] * pv[j - 1];
                if (i > 1) d.uu += c * i * (i - 1) * pu[i - 2] * pv[j];
                if (j > 1) d.vv += c * j * (j - 1) * pu[i] * pv[j - 2];
                if (i > 0 && j > 0) d.uv += c * i * j * pu[i - 1] * pv[j - 1];
            }
        }
        d.uu /= extent_;
        d.uv /= extent_;
        d.vv /= extent_;
        return d;
    }
    Vec3 normal(const Derivatives& d) const { return normalized(normal_ - d.u * u_axis_ - d.v * v_axis_); }

  private:
    /// Least squares by Gram–Schmidt on the normal equations' Cholesky factor, with one step of refinement so that
    /// exact polynomials come back to rounding. False: too few independent points for this order.
    bool fit(std::span<const Vec3> points) {
        const int terms = term_count(order_);
        if (points.size() < std::size_t(terms)) return false;
        double m[most_terms][most_terms] = {}, row[most_terms];
        c_ = {};
        const double scale = 1 / extent_;
        for (const Vec3& p : points) {
            const Vec3 x = (p - centre_) * scale;
            monomials(dot(x, u_axis_), dot(x, v_axis_), order_, row);
            for (int i = 0; i < terms; ++i)
                for (int j = 0; j <= i; ++j) m[i][j] += row[i] * row[j];
        }
        for (int i = 0; i < terms; ++i) {
            for (int j = 0; j <= i; ++j) {
                double sum = m[i][j];
                for (int k = 0; k < j; ++k) sum -= m[i][k] * m[j][k];
                if (i == j) {
                    if (!(sum > independent * independent * m[i][i])) return false;
                    m[i][i] = std::sqrt(sum);
                } else {
                    m[i][j] = sum / m[j][j];
                }
            }
        }
        for (int pass = 0; pass < 3; ++pass) {
            double right[most_terms] = {}, square = 0;
            for (const Vec3& p : points) {
                const Vec3 x = (p - centre_) * scale;
                monomials(dot(x, u_axis_), dot(x, v_axis_), order_, row);
                double rest = dot(x, normal_);
                for (int i = 0; i < terms; ++i) rest -= c_[std::size_t(i)] * row[i];
                square += rest * rest;
                for (int i = 0; i < terms; ++i) right[i] += rest * row[i];
            }
            residual_ = std::sqrt(square / double(points.size()));
            if (pass == 2) break;
            for (int i = 0; i < terms; ++i) {
                for (int k = 0; k < i; ++k) right[i] -= m[i][k] * right[k];
                right[i] /= m[i][i];
            }
            for (int i = terms - 1; i >= 0; --i) {
                for (int k = i + 1; k < terms; ++k) right[i] -= m[k][i] * right[k];
                right[i] /= m[i][i];
                c_[std::size_t(i)] += right[i];
            }
        }
        return std::isfinite(residual_);
    }

    Vec3 centre_, normal_, u_axis_, v_axis_;
    double extent_ = 0, residual_ = 0;
    int order_ = 0;
    bool usable_ = false;
    std::array<double, most_terms> c_{};
};

}  // namespace

Jet fit_jet(std::span<const Vec3> points, const Vec3& orientation) {
    Jet jet;
    jet.normal = normalized(orientation);
    if (points.empty()) return jet;
    const HeightPolynomial height(points, orientation);
    if (!height.usable()) return jet;
    const auto d = height.at(points[0]);
    jet.normal = height.normal(d);
    jet.residual = height.residual();
    jet.order = height.order();
    // First and second fundamental forms of the graph; with normals against which the surface bends away, a sphere seen
    // from outside has positive curvatures.
    const double e = 1 + d.u * d.u, f = d.u * d.v, g = 1 + d.v * d.v, w = std::sqrt(e * g - f * f);
    const double l = -d.uu / w, m = -d.uv / w, n = -d.vv / w;
    const double mean = 0.5 * (l * g - 2 * m * f + n * e) / (w * w), gauss = (l * n - m * m) / (w * w);
    const double spread = std::sqrt(std::max(mean * mean - gauss, 0.0));
    jet.curvature_min = mean - spread;
    jet.curvature_max = mean + spread;
    return jet;
}

std::vector<Vec3> patch_normals(std::span<const Vec3> points, const Vec3& orientation, double* residual) {
    std::vector<Vec3> normals(points.size(), normalized(orientation));
    if (residual) *residual = 0;
    if (points.empty()) return normals;
    const HeightPolynomial height(points, orientation);
    if (!height.usable()) return normals;
    for (std::size_t i = 0; i < points.size(); ++i) normals[i] = height.normal(height.at(points[i]));
    if (residual) *residual = height.residual();
    return normals;
}

}  // namespace quadseg::surface
