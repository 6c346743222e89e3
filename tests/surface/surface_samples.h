// Surfaces, points on them and tessellations of their patches for the tests of this folder.
#pragma once

#include <quadseg/segmentation.h>

#include "math/vec3.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace quadseg::surface::samples {

class Random {
  public:
    explicit Random(std::uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15ull + 1) {}
    std::uint64_t next() {
        std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ull);
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
        return z ^ (z >> 31);
    }
    double uniform(double low, double high) { return low + (high - low) * double(next() >> 11) * 0x1p-53; }
    double gauss() {
        const double r = std::sqrt(-2 * std::log(1 - uniform(0, 1)));
        return r * std::cos(uniform(0, 2 * std::numbers::pi));
    }
    /// Of arguments and factors no order is laid down, and gcc and clang draw them in different ones: here a length
    /// comes after its direction.
    Vec3 vector(double low, double high) {
        const Vec3 d = direction();
        return uniform(low, high) * d;
    }
    Vec3 direction() {
        Vec3 v{gauss(), gauss(), gauss()};
        return normalized(v);
    }

  private:
    std::uint64_t state_;
};

inline Surface make(SurfaceType type, const Vec3& point, const Vec3& axis) {
    Surface s;
    s.type = type;
    s.point = to_array(point);
    s.axis = to_array(normalized(axis));
    return s;
}
inline Surface plane(const Vec3& point, const Vec3& normal) {
    return make(SurfaceType::plane, point, normal);
}
inline Surface sphere(const Vec3& centre, double radius) {
    Surface s = make(SurfaceType::sphere, centre, {0, 0, 1});
    s.radius = radius;
    return s;
}
inline Surface cylinder(const Vec3& point, const Vec3& axis, double radius) {
    Surface s = make(SurfaceType::cylinder, point, axis);
    s.radius = radius;
    return s;
}
inline Surface cone(const Vec3& apex, const Vec3& axis, double half_angle) {
    Surface s = make(SurfaceType::cone, apex, axis);
    s.half_angle = half_angle;
    return s;
}
inline Surface torus(const Vec3& centre, const Vec3& axis, double major, double minor) {
    Surface s = make(SurfaceType::torus, centre, axis);
    s.radius = major;
    s.minor_radius = minor;
    return s;
}

/// u: angle about the axis (plane: first coordinate); v: height along the axis, slant distance of a cone, angle of a
/// torus' circle (0: outermost), latitude of a sphere.
inline Vec3 point_on(const Surface& s, double u, double v) {
    const Vec3 o = to_vec3(s.point), a = normalized(to_vec3(s.axis)), e = any_perpendicular(a), f = cross(a, e);
    const Vec3 radial = std::cos(u) * e + std::sin(u) * f;
    switch (s.type) {
        case SurfaceType::plane:
            return o + u * e + v * f;
        case SurfaceType::sphere:
            return o + s.radius * (std::cos(v) * radial + std::sin(v) * a);
        case SurfaceType::cylinder:
            return o + s.radius * radial + v * a;
        case SurfaceType::cone:
            return o + v * (std::cos(s.half_angle) * a + std::sin(s.half_angle) * radial);
        default:
            return o + (s.radius + s.minor_radius * std::cos(v)) * radial + s.minor_radius * std::sin(v) * a;
    }
}

/// The second parameter is drawn first.
inline Vec3 random_point_on(const Surface& s, Random& random) {
    const double pi = std::numbers::pi;
    double limit = pi;
    if (s.type == SurfaceType::torus && s.minor_radius > s.radius) limit = std::acos(-s.radius / s.minor_radius);
    const auto point = [&](double u, double low, double high) {
        const double v = random.uniform(low, high);
        return point_on(s, random.uniform(-u, u), v);
    };
    switch (s.type) {
        case SurfaceType::plane:
            return point(2, -2, 2);
        case SurfaceType::sphere:
            return s.radius * random.direction() + to_vec3(s.point);
        case SurfaceType::cylinder:
            return point(pi, -2, 2);
        case SurfaceType::cone:
            return point(pi, .01, 3);
        default:
            return point(pi, -.999 * limit, .999 * limit);
    }
}

inline Vec3 true_normal(const Surface& s, const Vec3& p) {
    const Vec3 o = to_vec3(s.point), a = normalized(to_vec3(s.axis)), u = p - o;
    const double z = dot(u, a), side = s.outward ? 1 : -1;
    const Vec3 radial = normalized(u - z * a);
    switch (s.type) {
        case SurfaceType::plane:
            return a;
        case SurfaceType::sphere:
            return side * normalized(u);
        case SurfaceType::cylinder:
            return side * radial;
        case SurfaceType::cone:
            return side * (std::cos(s.half_angle) * radial - std::sin(s.half_angle) * a);
        default:
            return side * normalized(u - s.radius * radial);
    }
}

/// Vertices of a patch and normals at them, bent as those of coarse faces are.
struct Patch {
    std::vector<Vec3> points, normals;
};

struct Range {
    double low, high;
    int count;
    double at(int i) const { return count == 1 ? low : low + (high - low) * i / (count - 1); }
};

/// A grid on the surface: u around the axis, v as in point_on; normals bent by random angles up to `bend`.
inline Patch grid(const Surface& s, Range u, Range v, double bend = 0, std::uint64_t seed = 1) {
    Patch patch;
    Random random(seed);
    for (int i = 0; i < u.count; ++i) {
        for (int j = 0; j < v.count; ++j) {
            const Vec3 p = point_on(s, u.at(i), v.at(j));
            patch.points.push_back(p);
            patch.normals.push_back(normalized(true_normal(s, p) + random.vector(0, bend)));
        }
    }
    return patch;
}

inline void add_noise(Patch& patch, double sigma, std::uint64_t seed = 9) {
    Random random(seed);
    for (Vec3& p : patch.points) p += sigma * Vec3{random.gauss(), random.gauss(), random.gauss()};
}

/// Largest difference of the parameters: lengths over `size`, directions in radians, the same surface being written in
/// different ways (axis point, sign of the axis).
inline double parameter_error(const Surface& a, const Surface& b, double size) {
    if (a.type != b.type) return 1e300;
    const Vec3 pa = to_vec3(a.point), pb = to_vec3(b.point), aa = to_vec3(a.axis), ab = to_vec3(b.axis);
    const double turn = std::min(norm(aa - ab), norm(aa + ab)), radius = std::abs(a.radius - b.radius) / size;
    const Vec3 shift = (pa - pb) / size;
    switch (a.type) {
        case SurfaceType::plane:
            return std::max(norm(aa - ab), std::abs(dot(shift, ab)));
        case SurfaceType::sphere:
            return std::max(norm(shift), radius);
        case SurfaceType::cylinder:
            return std::max({norm(shift - dot(shift, ab) * ab), turn, radius});
        case SurfaceType::cone:
            return std::max({norm(shift), norm(aa - ab), std::abs(a.half_angle - b.half_angle)});
        default:
            return std::max({norm(shift), turn, radius, std::abs(a.minor_radius - b.minor_radius) / size});
    }
}

}  // namespace quadseg::surface::samples
