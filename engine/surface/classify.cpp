// Section 4.4.2: types of quadrics from the eigenvalues of the quadratic form.
#include "math/symmetric3.h"
#include "surface/surface.h"

#include <algorithm>
#include <cmath>

namespace quadseg::surface {

namespace {

// Relative to the terms that cancel in it, a constant below this is 0.
constexpr double rounding = 1e-13;

/// ½ Σ d_i y_i² + Σ b_i y_i + c in the eigenframe of a local frame around the region.
class Classifier {
  public:
    Classifier(const quadric::Coefficients& c, double tolerance) : tolerance_(tolerance), c_(c[0]) {
        const EigenSystem e = eigen_decomposition({2 * c[4], c[5], c[6], 2 * c[7], c[8], 2 * c[9]});
        for (int i = 0; i < 3; ++i) {
            d_[i] = e.values[i];
            axis_[i] = e.vectors[i];
            b_[i] = dot(e.vectors[i], Vec3{c[1], c[2], c[3]});
            largest_ = std::max(largest_, std::abs(d_[i]));
        }
        const QuadricProjector projector(c);
        foot_ = projector.foot_point({});
        gradient_ = quadric::gradient(c, foot_);
        slope_ = norm(gradient_);
        if (!(norm(foot_) < 1e6) || !projector.has_real_points()) foot_ = {};
    }

    Surface run() {
        // A region of radius 1 leaves its tangent plane by ½ d / |∇f|.
        if (!(largest_ > tolerance_ * slope_)) return plane();
        order_by_magnitude();
        int zeros = 0;
        for (double d : d_) zeros += std::abs(d) <= tolerance_ * largest_;
        return zeros == 0 ? central() : zeros == 1 ? cylindrical() : parabolic();
    }

  private:
    Surface named(SurfaceType type, const Vec3& point) const {
        Surface s;
        s.type = type;
        s.point = to_array(point);
        for (std::size_t i = 0; i < 3; ++i) {
            s.axes[3 * i] = axis_[i].x;
            s.axes[3 * i + 1] = axis_[i].y;
            s.axes[3 * i + 2] = axis_[i].z;
        }
        s.axis = to_array(axis_[2]);
        return s;
    }

    Surface plane() const {
        Surface s;
        s.type = SurfaceType::plane;
        s.point = to_array(foot_);
        s.axis = to_array(normalized(gradient_));
        return s;
    }

    void swap(int i, int j) {
        std::swap(d_[i], d_[j]);
        std::swap(b_[i], b_[j]);
        std::swap(axis_[i], axis_[j]);
        flip(2);
    }
    /// Keeps the frame right-handed by the sign of axis i.
    void flip(int i) {
        if (dot(cross(axis_[0], axis_[1]), axis_[2]) < 0) {
            axis_[i] = -axis_[i];
            b_[i] = -b_[i];
        }
    }
    void turn_last() {  // half a turn about the first axis
        axis_[1] = -axis_[1];
        axis_[2] = -axis_[2];
        b_[1] = -b_[1];
        b_[2] = -b_[2];
    }
    void order_by_magnitude() {
        for (int pass = 0; pass < 2; ++pass)
            for (int i = 0; i < 2; ++i)
                if (std::abs(d_[i]) < std::abs(d_[i + 1])) swap(i, i + 1);
    }
    bool alike(int i, int j) const {
        return std::abs(d_[i] - d_[j]) <= tolerance_ * std::max(std::abs(d_[i]), std::abs(d_[j]));
    }
    double coordinate(int i, const Vec3& p) const { return dot(axis_[i], p); }

    /// Of a linear term along directions without curvature.
    double least_slope() const {
        const double linear = std::sqrt(b_[0] * b_[0] + b_[1] * b_[1] + b_[2] * b_[2]);
        return std::max(tolerance_ * slope_, rounding * (linear + largest_));
    }

    Surface general() const { return named(SurfaceType::quadric, foot_); }

    Surface central() {
        const int negative = (d_[0] < 0) + (d_[1] < 0) + (d_[2] < 0);
        // The axis of the odd sign last.
        if (negative == 1 || negative == 2) {
            for (int i = 0; i < 2; ++i)
                if ((d_[i] < 0) == (negative == 1)) {
                    swap(i, 2);
                    break;
                }
            if (std::abs(d_[0]) > std::abs(d_[1])) swap(0, 1);
        } else if (!alike(0, 1) && alike(1, 2)) {
            swap(0, 2);  // an oblate spheroid's axis last, as a prolate one's
        }
        Vec3 centre;
        double rest = c_, weight = 0, cancelled = std::abs(c_);
        for (int i = 0; i < 3; ++i) {
            const double y = -b_[i] / d_[i];
            centre += y * axis_[i];
            rest -= b_[i] * b_[i] / (2 * d_[i]);
            cancelled += std::abs(b_[i] * y);
            const double z = coordinate(i, foot_) - y;
            weight = std::max(weight, 0.5 * std::abs(d_[i]) * z * z);
        }
        const bool definite = negative == 0 || negative == 3;
        if (std::abs(rest) <= std::max(tolerance_ * weight, rounding * cancelled))
            return definite ? general() : conical(centre);
        double square[3];
        int real = 0;
        for (int i = 0; i < 3; ++i) {
            square[i] = -2 * rest / d_[i];
            real += square[i] > 0;
        }
        if (real == 0) return general();
        if (definite && alike(0, 1) && alike(0, 2) && alike(1, 2)) {
            Surface s = named(SurfaceType::sphere, centre);
            s.radius = std::cbrt(std::sqrt(square[0]) * std::sqrt(square[1]) * std::sqrt(square[2]));
            s.axis = {0, 0, 1};
            s.axes = {};
            s.outward = dot(gradient_, foot_ - centre) >= 0;
            return s;
        }
        Surface s = named(definite    ? SurfaceType::ellipsoid
                          : real == 2 ? SurfaceType::hyperboloid_one_sheet
                                      : SurfaceType::hyperboloid_two_sheets,
                          centre);
        for (std::size_t i = 0; i < 3; ++i) s.semi_axes[i] = std::sqrt(std::abs(square[i]));
        s.outward = dot(gradient_, foot_ - centre) >= 0;
        return s;
    }

    Surface conical(const Vec3& apex) {
        if (coordinate(2, foot_ - apex) < 0) turn_last();
        Surface s = named(SurfaceType::elliptic_cone, apex);
        s.semi_axes = {std::sqrt(-d_[2] / d_[0]), std::sqrt(-d_[2] / d_[1]), 1};
        const Vec3 u = foot_ - apex, radial = u - coordinate(2, u) * axis_[2];
        s.outward = dot(gradient_, radial) >= 0;
        if (alike(0, 1)) {
            s.type = SurfaceType::cone;
            s.half_angle = std::atan(std::sqrt(s.semi_axes[0] * s.semi_axes[1]));
            s.semi_axes = {};
            s.axes = {};
        }
        return s;
    }

    Surface cylindrical() {
        const double y0 = -b_[0] / d_[0], y1 = -b_[1] / d_[1];
        double rest = c_ - b_[0] * b_[0] / (2 * d_[0]) - b_[1] * b_[1] / (2 * d_[1]);
        const bool same = (d_[0] < 0) == (d_[1] < 0);
        if (std::abs(b_[2]) > least_slope()) {
            // Paraboloid: ½ d_0 u² + ½ d_1 v² = −b_2 w from the vertex on.
            const double y2 = -rest / b_[2];
            if (std::abs(y2) < 1e9) {
                if ((d_[0] > 0) == (b_[2] > 0)) turn_last();
                const Vec3 point = y0 * axis_[0] + (-b_[1] / d_[1]) * axis_[1] + (-rest / b_[2]) * axis_[2];
                Surface s = named(same ? SurfaceType::elliptic_paraboloid : SurfaceType::hyperbolic_paraboloid, point);
                s.semi_axes = {2 * std::abs(b_[2] / d_[0]), 2 * std::abs(b_[2] / d_[1]), 0};
                s.outward = dot(gradient_, axis_[2]) <= 0;
                return s;
            }
        }
        const Vec3 centre = y0 * axis_[0] + y1 * axis_[1];
        const double u = coordinate(0, foot_) - y0, v = coordinate(1, foot_) - y1;
        const double weight = 0.5 * std::max(std::abs(d_[0]) * u * u, std::abs(d_[1]) * v * v);
        const double cancelled = std::abs(c_) + std::abs(b_[0] * y0) + std::abs(b_[1] * y1);
        if (std::abs(rest) <= std::max(tolerance_ * weight, rounding * cancelled))
            return general();  // crossing planes or a line
        double square[2] = {-2 * rest / d_[0], -2 * rest / d_[1]};
        const Vec3 radial = u * axis_[0] + v * axis_[1];
        if (same) {
            if (square[0] < 0) return general();
            Surface s = named(SurfaceType::elliptic_cylinder, centre);
            s.outward = dot(gradient_, radial) >= 0;
            s.semi_axes = {std::sqrt(square[0]), std::sqrt(square[1]), 0};
            if (alike(0, 1)) {
                s.type = SurfaceType::cylinder;
                s.radius = std::sqrt(s.semi_axes[0] * s.semi_axes[1]);
                s.semi_axes = {};
                s.axes = {};
            }
            return s;
        }
        if (square[0] < 0) {
            swap(0, 1);
            std::swap(square[0], square[1]);
        }
        Surface s = named(SurfaceType::hyperbolic_cylinder, centre);
        s.semi_axes = {std::sqrt(square[0]), std::sqrt(-square[1]), 0};
        s.outward = dot(gradient_, radial) >= 0;
        return s;
    }

    Surface parabolic() {
        const Vec3 linear = b_[1] * axis_[1] + b_[2] * axis_[2];
        const double slope = norm(linear);
        if (!(slope > least_slope())) return general();  // parallel planes
        // ½ d u² + slope w = …: the second axis into the opening.
        const Vec3 opening = (d_[0] > 0 ? -1.0 : 1.0) * normalized(linear);
        axis_[1] = opening;
        axis_[2] = cross(axis_[0], opening);
        const double b1 = dot(linear, opening), y0 = -b_[0] / d_[0];
        const double rest = c_ - b_[0] * b_[0] / (2 * d_[0]);
        Surface s = named(SurfaceType::parabolic_cylinder, y0 * axis_[0] - (rest / b1) * opening);
        s.semi_axes = {2 * std::abs(b1 / d_[0]), 0, 0};
        s.outward = dot(gradient_, opening) <= 0;
        return s;
    }

    double tolerance_, c_;
    double d_[3], b_[3], largest_ = 0, slope_ = 0;
    Vec3 axis_[3], foot_, gradient_;
};

}  // namespace

Surface classify(const quadric::Coefficients& c, const Vec3& near, double radius, double tolerance) {
    Surface s;
    s.type = SurfaceType::quadric;
    double largest = 0;
    for (double v : c) {
        if (!std::isfinite(v)) return s;
        largest = std::max(largest, std::abs(v));
    }
    s.coefficients = c;
    if (!(largest > 0) || !(radius > 0)) return s;
    quadric::Coefficients local = quadric::to_local(c, near, 1 / radius);
    for (double& v : local) v /= largest;
    Surface found = Classifier(local, tolerance).run();
    found = transformed_back(found, near, 1 / radius);
    found.coefficients = c;
    if (found.type <= SurfaceType::cone) found.coefficients = to_coefficients(found);
    return found;
}

}  // namespace quadseg::surface
