#include "datasets/surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace quadseg::datasets {
namespace {

Surface in_frame(SurfaceType type, const Frame& frame, bool outward) {
    Surface s;
    s.type = type;
    s.point = to_array(frame.origin);
    s.axis = to_array(frame.z);
    s.outward = outward;
    return s;
}

DiagonalQuadric oriented(DiagonalQuadric q, bool outward) {
    if (outward) return q;
    return {-q.d, -q.b, -q.c};
}

}  // namespace

Quadric to_world(const DiagonalQuadric& quadric, const Frame& frame) {
    // With y = Rᵀ(x − o): xᵀAx + gᵀx + c, A = R D Rᵀ, g = R b − 2 A o, c' = oᵀAo − (R b)·o + c.
    const std::array<Vec3, 3> r{frame.x, frame.y, frame.z};
    std::array<std::array<double, 3>, 3> a{};
    Vec3 g;
    for (int k = 0; k < 3; ++k) {
        const Vec3& axis = r[static_cast<std::size_t>(k)];
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 3; ++j) {
                a[i][j] += quadric.d[k] * axis[static_cast<int>(i)] * axis[static_cast<int>(j)];
            }
        }
        g += axis * quadric.b[k];
    }
    const Vec3& o = frame.origin;
    Vec3 ao;
    for (std::size_t i = 0; i < 3; ++i) {
        ao[static_cast<int>(i)] = a[i][0] * o.x + a[i][1] * o.y + a[i][2] * o.z;
    }
    const double c = dot(o, ao) - dot(g, o) + quadric.c;
    g -= ao * 2;
    return {c, g.x, g.y, g.z, a[0][0], 2 * a[0][1], 2 * a[0][2], a[1][1], 2 * a[1][2], a[2][2]};
}

Surface plane(const Frame& frame) {
    Surface s = in_frame(SurfaceType::plane, frame, true);
    s.coefficients = to_world({{}, {0, 0, 1}, 0}, frame);
    return s;
}

Surface sphere(const Frame& frame, double radius, bool outward) {
    Surface s = in_frame(SurfaceType::sphere, frame, outward);
    s.axis = {};
    s.radius = radius;
    const double k = 0.5 / radius;
    s.coefficients = to_world(oriented({{k, k, k}, {}, -radius / 2}, outward), frame);
    return s;
}

Surface cylinder(const Frame& frame, double radius, bool outward) {
    Surface s = in_frame(SurfaceType::cylinder, frame, outward);
    s.radius = radius;
    const double k = 0.5 / radius;
    s.coefficients = to_world(oriented({{k, k, 0}, {}, -radius / 2}, outward), frame);
    return s;
}

Surface cone(const Frame& frame, double half_angle, bool outward) {
    Surface s = in_frame(SurfaceType::cone, frame, outward);
    s.half_angle = half_angle;
    const double slope = std::tan(half_angle);
    // Gradient 1 at height 1.
    const double k = 0.5 * std::cos(half_angle) / slope;
    s.coefficients = to_world(oriented({{k, k, -k * slope * slope}, {}, 0}, outward), frame);
    return s;
}

Surface torus(const Frame& frame, double major_radius, double minor_radius, bool outward) {
    Surface s = in_frame(SurfaceType::torus, frame, outward);
    s.radius = major_radius;
    s.minor_radius = minor_radius;
    return s;
}

Surface general(SurfaceType type, const Frame& frame, const DiagonalQuadric& quadric, const Vec3& semi_axes,
                const Vec3& outer, const Vec3& outer_normal) {
    Surface s = in_frame(type, frame, true);
    for (int a = 0; a < 3; ++a) {
        const auto i = static_cast<std::size_t>(a);
        s.axes[i] = frame.x[a];
        s.axes[3 + i] = frame.y[a];
        s.axes[6 + i] = frame.z[a];
    }
    s.semi_axes = to_array(semi_axes);
    const Vec3 gradient{2 * quadric.d.x * outer.x + quadric.b.x, 2 * quadric.d.y * outer.y + quadric.b.y,
                        2 * quadric.d.z * outer.z + quadric.b.z};
    const double side = dot(gradient, outer_normal);
    const double scale = (side < 0 ? -1 : 1) / norm(gradient);
    s.outward = side >= 0;
    s.coefficients = to_world({quadric.d * scale, quadric.b * scale, quadric.c * scale}, frame);
    return s;
}

bool same_surface(const Surface& a, const Surface& b) {
    if (a.type != b.type || a.outward != b.outward) return false;
    const double size = 1 + norm(to_vec3(a.point)) + a.radius;
    const double length = 1e-9 * size;
    if (std::abs(a.radius - b.radius) > length || std::abs(a.minor_radius - b.minor_radius) > length ||
        std::abs(a.half_angle - b.half_angle) > 1e-9) {
        return false;
    }
    const Vec3 axis = to_vec3(a.axis);
    const Vec3 offset = to_vec3(b.point) - to_vec3(a.point);
    const double turn = norm(cross(axis, to_vec3(b.axis)));
    switch (a.type) {
        case SurfaceType::plane:
            return turn < 1e-9 && dot(axis, to_vec3(b.axis)) > 0 && std::abs(dot(axis, offset)) < length;
        case SurfaceType::sphere:
            return norm(offset) < length;
        case SurfaceType::cylinder:
            return turn < 1e-9 && norm(cross(axis, offset)) < length;
        case SurfaceType::cone:
            return turn < 1e-9 && dot(axis, to_vec3(b.axis)) > 0 && norm(offset) < length;
        case SurfaceType::torus:
            return turn < 1e-9 && norm(offset) < length;
        default:
            return std::equal(a.coefficients.begin(), a.coefficients.end(), b.coefficients.begin(),
                              [](double x, double y) { return std::abs(x - y) <= 1e-9 * (1 + std::abs(x)); });
    }
}

}  // namespace quadseg::datasets
