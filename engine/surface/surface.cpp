#include "surface/surface.h"

#include "surface/evaluate.h"

#include <cmath>

namespace quadseg::surface {

namespace {

Vec3 axis_of(const Surface& s) {
    const Vec3 a = normalized(to_vec3(s.axis));
    return squared_norm(a) > 0 ? a : Vec3{0, 0, 1};
}

// Σ (v·m)² − … as a quadric: adds scale · (a·x)² to c.
void add_square(quadric::Coefficients& c, const Vec3& a, double scale) {
    c[4] += scale * a.x * a.x;
    c[5] += scale * 2 * a.x * a.y;
    c[6] += scale * 2 * a.x * a.z;
    c[7] += scale * a.y * a.y;
    c[8] += scale * 2 * a.y * a.z;
    c[9] += scale * a.z * a.z;
}

// f(x) = q(x − origin) for q without linear terms.
quadric::Coefficients moved_from_origin(quadric::Coefficients c, const Vec3& origin) {
    const Vec3 g = quadric::gradient({0, 0, 0, 0, c[4], c[5], c[6], c[7], c[8], c[9]}, origin);
    c[1] = -g.x;
    c[2] = -g.y;
    c[3] = -g.z;
    c[0] += 0.5 * dot(g, origin);
    return c;
}

}  // namespace

SurfaceEvaluator::SurfaceEvaluator(const Surface& s)
    : type_(s.type),
      sign_(s.outward ? 1 : -1),
      radius_(s.radius),
      minor_(s.minor_radius),
      cosine_(std::cos(s.half_angle)),
      sine_(std::sin(s.half_angle)),
      point_(to_vec3(s.point)),
      axis_(axis_of(s)),
      any_(any_perpendicular(axis_)) {
    if (s.minor_radius > s.radius)
        pole_ = std::sqrt((s.minor_radius - s.radius) * std::max(s.minor_radius + s.radius, 0.0));
    if (s.type > SurfaceType::torus) quadric_.projector = QuadricProjector(s.coefficients);
}

double signed_distance(const Surface& s, const Vec3& p) {
    return SurfaceEvaluator(s).distance(p);
}

Vec3 normal_at(const Surface& s, const Vec3& p) {
    return SurfaceEvaluator(s).normal(p);
}

Vec3 foot_point(const Surface& s, const Vec3& p) {
    if (s.type > SurfaceType::torus) return QuadricProjector(s.coefficients).foot_point(p);
    const Vec3 origin = to_vec3(s.point), axis = axis_of(s), u = p - origin;
    const double z = dot(u, axis);
    if (s.type == SurfaceType::plane) return p - z * axis;
    if (s.type == SurfaceType::sphere)
        return origin + s.radius * (norm(u) > 0 ? normalized(u) : any_perpendicular(axis));
    const Vec3 v = u - z * axis;
    const double rho = norm(v);
    const Vec3 radial = rho > 0 ? v / rho : any_perpendicular(axis);
    if (s.type == SurfaceType::cylinder) return origin + z * axis + s.radius * radial;
    if (s.type == SurfaceType::cone) {
        const double c = std::cos(s.half_angle), q = std::sin(s.half_angle);
        const double along = std::max(z * c + rho * q, 0.0);
        return origin + along * (c * axis + q * radial);
    }
    const double x = rho - s.radius, length = std::sqrt(x * x + z * z);
    if (s.minor_radius > s.radius && s.radius * length + s.minor_radius * x < 0) {
        const double pole = std::sqrt((s.minor_radius - s.radius) * std::max(s.minor_radius + s.radius, 0.0));
        return origin + std::copysign(pole, z) * axis;
    }
    const Vec3 spine = origin + s.radius * radial;
    return length > 0 ? spine + (s.minor_radius / length) * (x * radial + z * axis) : spine + s.minor_radius * radial;
}

quadric::Coefficients to_coefficients(const Surface& s) {
    const Vec3 p = to_vec3(s.point), a = axis_of(s);
    if (s.type == SurfaceType::plane) return quadric::plane(a, -dot(a, p));
    if (s.type > SurfaceType::cone) return s.coefficients;
    const double sign = s.outward ? 1 : -1;
    quadric::Coefficients c{};
    if (s.type == SurfaceType::cone) {
        const double k = std::cos(s.half_angle), q = std::sin(s.half_angle), scale = sign / (2 * q * k);
        // (ρ² cos² − z² sin²) with ρ² = |u|² − z², so that |∇f| is the distance to the apex on the cone.
        c[4] = c[7] = c[9] = scale * k * k;
        add_square(c, a, -scale);
        return moved_from_origin(c, p);
    }
    const double scale = sign / (2 * s.radius);
    c[4] = c[7] = c[9] = scale;
    if (s.type == SurfaceType::cylinder) add_square(c, a, -scale);
    c[0] = -0.5 * sign * s.radius;
    return moved_from_origin(c, p);
}

Surface transformed(const Surface& s, const Vec3& centre, double scale) {
    Surface t = s;
    t.point = to_array((to_vec3(s.point) - centre) * scale);
    t.radius *= scale;
    t.minor_radius *= scale;
    for (double& v : t.semi_axes) v *= scale;
    // f'(x') = scale · f(x) keeps |∇f| = 1.
    t.coefficients = quadric::to_local(s.coefficients, centre, scale);
    for (double& v : t.coefficients) v *= scale;
    return t;
}

Surface transformed_back(const Surface& s, const Vec3& centre, double scale) {
    Surface t = s;
    t.point = to_array(to_vec3(s.point) / scale + centre);
    t.radius /= scale;
    t.minor_radius /= scale;
    for (double& v : t.semi_axes) v /= scale;
    t.coefficients = quadric::from_local(s.coefficients, centre, scale);
    for (double& v : t.coefficients) v /= scale;
    return t;
}

}  // namespace quadseg::surface
