// Typed surfaces prepared for hot loops: plain data, inline, no allocation. SurfaceEvaluator switches on the type at
// every call (one predicted branch); visit() hoists the switch out of a loop over points.
#pragma once

#include <quadseg/segmentation.h>

#include "math/vec3.h"
#include "surface/quadric_projector.h"

#include <algorithm>
#include <cmath>

namespace quadseg::surface {

struct PlaneEvaluator {
    Vec3 point, axis;
    double distance(const Vec3& p) const noexcept { return dot(p - point, axis); }
    Vec3 normal(const Vec3&) const noexcept { return axis; }
};

struct SphereEvaluator {
    Vec3 point, any;  ///< any: the normal chosen at the centre
    double radius = 0, sign = 1;
    double distance(const Vec3& p) const noexcept { return sign * (norm(p - point) - radius); }
    Vec3 normal(const Vec3& p) const noexcept {
        const Vec3 u = p - point;
        const double n = norm(u);
        return n > 0 ? u * (sign / n) : any * sign;
    }
};

struct CylinderEvaluator {
    Vec3 point, axis, any;  ///< any: the radial direction chosen on the axis
    double radius = 0, sign = 1;
    double distance(const Vec3& p) const noexcept {
        const Vec3 u = p - point;
        return sign * (norm(u - dot(u, axis) * axis) - radius);
    }
    Vec3 normal(const Vec3& p) const noexcept {
        const Vec3 u = p - point, v = u - dot(u, axis) * axis;
        const double n = norm(v);
        return n > 0 ? v * (sign / n) : any * sign;
    }
};

/// One nappe: the apex is nearest to all points behind it.
struct ConeEvaluator {
    Vec3 point, axis, any;
    double cosine = 1, sine = 0, sign = 1;
    double distance(const Vec3& p) const noexcept {
        const Vec3 u = p - point;
        const double z = dot(u, axis), rho = norm(u - z * axis);
        if (z * cosine + rho * sine < 0) return sign * std::sqrt(z * z + rho * rho);
        return sign * (rho * cosine - z * sine);
    }
    Vec3 normal(const Vec3& p) const noexcept {
        const Vec3 u = p - point;
        const double z = dot(u, axis);
        const Vec3 v = u - z * axis;
        const double rho = norm(v);
        const Vec3 radial = rho > 0 ? v / rho : any;
        return (radial * cosine - axis * sine) * sign;
    }
};

struct TorusEvaluator {
    Vec3 point, axis, any;
    double radius = 0, minor = 0, sign = 1;
    double pole = 0;  ///< spindle: height of the points on the axis, between which nothing of the circle is real
    bool spindle = false;
    double distance(const Vec3& p) const noexcept {
        const Vec3 u = p - point;
        const double z = dot(u, axis), rho = norm(u - z * axis), x = rho - radius;
        const double q = std::sqrt(x * x + z * z);
        if (spindle && radius * q + minor * x < 0) {
            const double h = std::abs(z) - pole, d = std::sqrt(rho * rho + h * h);
            return q < minor ? -sign * d : sign * d;
        }
        return sign * (q - minor);
    }
    Vec3 normal(const Vec3& p) const noexcept {
        const Vec3 u = p - point;
        double z = dot(u, axis);
        const Vec3 v = u - z * axis;
        const double rho = norm(v);
        const Vec3 radial = rho > 0 ? v / rho : any;
        double x = rho - radius, q = std::sqrt(x * x + z * z);
        if (spindle && radius * q + minor * x < 0) {
            x = -radius;
            z = std::copysign(pole, z);
            q = minor;
        }
        return q > 0 ? (radial * x + axis * z) * (sign / q) : radial * sign;
    }
};

struct QuadricEvaluator {
    QuadricProjector projector;
    double distance(const Vec3& p) const noexcept {
        const double d = norm(p - projector.foot_point(p));
        return projector.value(p) < 0 ? -d : d;
    }
    Vec3 normal(const Vec3& p) const noexcept {
        const Vec3 g = projector.gradient(projector.foot_point(p));
        return squared_norm(g) > 0 ? normalized(g) : normalized(projector.gradient(p));
    }
};

/// Any typed surface as plain data.
class SurfaceEvaluator {
  public:
    SurfaceEvaluator() = default;
    explicit SurfaceEvaluator(const Surface& s);

    SurfaceType type() const noexcept { return type_; }

    /// action(evaluator) with the concrete evaluator: one switch for a whole loop.
    template <class Action>
    decltype(auto) visit(Action&& action) const {
        switch (type_) {
            case SurfaceType::plane:
                return action(PlaneEvaluator{point_, axis_});
            case SurfaceType::sphere:
                return action(SphereEvaluator{point_, any_, radius_, sign_});
            case SurfaceType::cylinder:
                return action(CylinderEvaluator{point_, axis_, any_, radius_, sign_});
            case SurfaceType::cone:
                return action(ConeEvaluator{point_, axis_, any_, cosine_, sine_, sign_});
            case SurfaceType::torus:
                return action(TorusEvaluator{point_, axis_, any_, radius_, minor_, sign_, pole_, minor_ > radius_});
            default:
                return action(static_cast<const QuadricEvaluator&>(quadric_));
        }
    }

    double distance(const Vec3& p) const noexcept {
        return visit([&](const auto& e) { return e.distance(p); });
    }
    Vec3 normal(const Vec3& p) const noexcept {
        return visit([&](const auto& e) { return e.normal(p); });
    }

  private:
    SurfaceType type_ = SurfaceType::plane;
    double sign_ = 1, radius_ = 0, minor_ = 0, cosine_ = 1, sine_ = 0, pole_ = 0;
    Vec3 point_, axis_, any_;
    QuadricEvaluator quadric_;
};

}  // namespace quadseg::surface
