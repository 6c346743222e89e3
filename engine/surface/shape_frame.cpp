#include "surface/shape_frame.h"

#include "surface/surface.h"

#include <numbers>

namespace quadseg::surface {

namespace {

constexpr double steepest_tilt = 89.9 / 180 * std::numbers::pi;

class Rotation {
  public:
    explicit Rotation(const Vec3& rotation) noexcept {
        const double angle = norm(rotation);
        if (!(angle > 0)) return;
        axis_ = rotation / angle;
        const double half = std::sin(0.5 * angle);
        sine_ = std::sin(angle);
        versine_ = 2 * half * half;
    }
    Vec3 operator()(const Vec3& v) const noexcept {
        const Vec3 across = cross(axis_, v);
        return v + sine_ * across + versine_ * cross(axis_, across);
    }

  private:
    Vec3 axis_;
    double sine_ = 0, versine_ = 0;
};

}  // namespace

ShapeFrame stepped(const ShapeFrame& f, const double* step) noexcept {
    ShapeFrame next = f;
    const bool round = f.type == SurfaceType::cylinder || f.type == SurfaceType::cone || f.type == SurfaceType::torus;
    const Rotation rotated(step[1] * f.g + step[2] * f.b + (round ? step[3] : 0.0) * f.n);
    next.p = f.p + step[0] * f.n;
    next.n = normalized(rotated(f.n));
    const Vec3 g = rotated(f.g);
    next.g = normalized(g - dot(g, next.n) * next.n);
    next.b = cross(next.n, next.g);
    if (f.type == SurfaceType::sphere) next.curvature += step[3];
    if (round) next.curvature += step[4];
    if (f.type == SurfaceType::cone || f.type == SurfaceType::torus) next.tilt += step[5];
    if (f.type == SurfaceType::torus) next.minor_curvature += step[6];
    return next;
}

bool frame_of(const Surface& s, const Vec3& near, SurfaceType type, ShapeFrame& f) noexcept {
    f = {};
    f.type = type;
    f.p = foot_point(s, near);
    Surface outside = s;
    outside.outward = true;
    f.n = normal_at(outside, f.p);
    const Vec3 axis = normalized(to_vec3(s.axis)), u = f.p - to_vec3(s.point);
    switch (s.type) {
        case SurfaceType::plane:
        case SurfaceType::sphere:
            f.g = any_perpendicular(f.n);
            if (s.type == SurfaceType::sphere) f.curvature = 1 / s.radius;
            if (type == SurfaceType::torus) f.minor_curvature = f.curvature;
            break;
        case SurfaceType::cylinder:
            f.g = axis;
            f.curvature = 1 / s.radius;
            break;
        case SurfaceType::cone:
        case SurfaceType::torus: {
            const double z = dot(u, axis), rho = norm(u - z * axis);
            const Vec3 radial = normalized(u - z * axis);
            double cosine = std::cos(s.half_angle), sine = std::sin(s.half_angle);
            if (s.type == SurfaceType::torus) {
                f.minor_curvature = 1 / s.minor_radius;
                cosine = dot(f.n, radial);
                sine = -dot(f.n, axis);
                if (cosine < 0) {  // the inner half: seen from inside, its curvatures have opposite signs
                    f.n = -f.n;
                    f.minor_curvature = -f.minor_curvature;
                    cosine = -cosine;
                    sine = -sine;
                }
            }
            if (!(rho > 0) || !(cosine > 0)) return false;
            f.curvature = cosine / rho;
            f.tilt = std::atan2(sine, cosine);
            f.g = cosine * axis + sine * radial;
            break;
        }
        default:
            return false;
    }
    f.g = normalized(f.g - dot(f.g, f.n) * f.n);
    f.b = cross(f.n, f.g);
    const double check = squared_norm(f.p) + squared_norm(f.n) * squared_norm(f.g) + f.curvature + f.minor_curvature;
    return std::isfinite(check) && squared_norm(f.b) > 0.5;
}

bool surface_of(const ShapeFrame& f, double largest, Surface& s) noexcept {
    s.type = f.type;
    s.point = to_array(f.p);
    s.axis = to_array(f.n);
    s.radius = s.minor_radius = s.half_angle = 0;
    s.outward = true;
    if (f.type == SurfaceType::plane) return std::isfinite(squared_norm(f.p) + squared_norm(f.n));

    // Seen from the side on which the distance to the axis is positive.
    Vec3 n = f.n;
    double k = f.curvature, tilt = f.tilt, minor = f.minor_curvature;
    if (k < 0) {
        n = -n;
        k = -k;
        tilt = -tilt;
        minor = -minor;
        s.outward = false;
    }
    if (!(k * largest > 1) || !(std::abs(tilt) < steepest_tilt)) return false;
    const double cosine = std::cos(tilt), sine = std::sin(tilt);
    const Vec3 radial = sine * f.g + cosine * n;
    Vec3 axis = normalized(cosine * f.g - sine * n);
    const Vec3 centre = f.p - n / k;
    switch (f.type) {
        case SurfaceType::sphere:
            s.point = to_array(centre);
            s.axis = {0, 0, 1};
            s.radius = 1 / k;
            break;
        case SurfaceType::cylinder:
            s.point = to_array(centre);
            s.axis = to_array(axis);
            s.radius = 1 / k;
            break;
        case SurfaceType::cone: {
            const double slant = cosine / (k * sine);
            if (!(std::abs(slant) < largest)) return false;
            s.point = to_array(f.p - slant * f.g);
            if (tilt < 0) axis = -axis;
            s.axis = to_array(axis);
            s.half_angle = std::abs(tilt);
            break;
        }
        case SurfaceType::torus: {
            if (!(std::abs(minor) * largest > 1)) return false;
            const double r = 1 / minor, major = cosine * (1 / k - r);
            if (minor < 0) s.outward = !s.outward;  // n points to the circle's centre
            s.minor_radius = std::abs(r);
            s.radius = major;
            s.point = to_array(f.p - r * n - major * radial);
            s.axis = to_array(axis);
            if (!(std::abs(major) < largest) || (major < 0 && s.minor_radius <= -major)) return false;
            break;
        }
        default:
            return false;
    }
    return std::isfinite(squared_norm(to_vec3(s.point)) + squared_norm(to_vec3(s.axis)) + s.radius + s.minor_radius);
}

}  // namespace quadseg::surface
