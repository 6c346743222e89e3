// Random quadrics of all 17 kinds of the classification over the reals.
#pragma once

#include "math/vec3.h"
#include "quadric/monomials.h"
#include "surface_samples.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace quadseg::surface::samples {

enum class Kind {
    ellipsoid,
    imaginary_ellipsoid,
    point,
    one_sheet,
    two_sheets,
    cone,
    elliptic_paraboloid,
    hyperbolic_paraboloid,
    elliptic_cylinder,
    imaginary_cylinder,
    line,
    hyperbolic_cylinder,
    parabolic_cylinder,
    crossing_planes,
    parallel_planes,
    imaginary_planes,
    double_plane
};
inline constexpr int kind_count = 17;

/// Σ square_i u_i² + slope u_2 + constant in the frame (centre, axes).
struct PrincipalQuadric {
    Vec3 centre, axes[3];
    double square[3]{}, slope = 0, constant = 0;

    quadric::Coefficients coefficients() const {
        quadric::Coefficients c{};
        c[0] = constant;
        for (int i = 0; i < 3; ++i) {
            const Vec3& a = axes[i];
            const double k = square[i], at = dot(a, centre), linear = -2 * k * at + (i == 2 ? slope : 0);
            c[0] += k * at * at - (i == 2 ? slope * at : 0);
            c[1] += linear * a.x;
            c[2] += linear * a.y;
            c[3] += linear * a.z;
            c[4] += k * a.x * a.x;
            c[5] += 2 * k * a.x * a.y;
            c[6] += 2 * k * a.x * a.z;
            c[7] += k * a.y * a.y;
            c[8] += 2 * k * a.y * a.z;
            c[9] += k * a.z * a.z;
        }
        return c;
    }
};

inline PrincipalQuadric random_quadric(Kind kind, Random& random) {
    PrincipalQuadric q;
    q.axes[0] = random.direction();
    q.axes[1] = normalized(cross(q.axes[0], random.direction()));
    q.axes[2] = cross(q.axes[0], q.axes[1]);
    if (random.next() % 3 == 0) {  // aligned with the coordinates
        q.axes[0] = {1, 0, 0};
        q.axes[1] = {0, 1, 0};
        q.axes[2] = {0, 0, 1};
    }
    if (random.next() % 3 != 0) q.centre = random.vector(0, 3);
    double k[3];
    for (double& v : k) v = std::exp(random.uniform(-2, 2));
    if (random.next() % 4 == 0) k[1] = k[0];  // of revolution
    if (random.next() % 8 == 0) k[2] = k[1];
    switch (kind) {
        case Kind::ellipsoid:
            q = {q.centre, {q.axes[0], q.axes[1], q.axes[2]}, {k[0], k[1], k[2]}, 0, -1};
            break;
        case Kind::imaginary_ellipsoid:
            q = {q.centre, {q.axes[0], q.axes[1], q.axes[2]}, {k[0], k[1], k[2]}, 0, 1};
            break;
        case Kind::point:
            q = {q.centre, {q.axes[0], q.axes[1], q.axes[2]}, {k[0], k[1], k[2]}, 0, 0};
            break;
        case Kind::one_sheet:
            q = {q.centre, {q.axes[0], q.axes[1], q.axes[2]}, {k[0], k[1], -k[2]}, 0, -1};
            break;
        case Kind::two_sheets:
            q = {q.centre, {q.axes[0], q.axes[1], q.axes[2]}, {k[0], k[1], -k[2]}, 0, 1};
            break;
        case Kind::cone:
            q = {q.centre, {q.axes[0], q.axes[1], q.axes[2]}, {k[0], k[1], -k[2]}, 0, 0};
            break;
        case Kind::elliptic_paraboloid:
            q = {q.centre, {q.axes[0], q.axes[1], q.axes[2]}, {k[0], k[1], 0}, -1, 0};
            break;
        case Kind::hyperbolic_paraboloid:
            q = {q.centre, {q.axes[0], q.axes[1], q.axes[2]}, {k[0], -k[1], 0}, -1, 0};
            break;
        case Kind::elliptic_cylinder:
            q = {q.centre, {q.axes[0], q.axes[1], q.axes[2]}, {k[0], k[1], 0}, 0, -1};
            break;
        case Kind::imaginary_cylinder:
            q = {q.centre, {q.axes[0], q.axes[1], q.axes[2]}, {k[0], k[1], 0}, 0, 1};
            break;
        case Kind::line:
            q = {q.centre, {q.axes[0], q.axes[1], q.axes[2]}, {k[0], k[1], 0}, 0, 0};
            break;
        case Kind::hyperbolic_cylinder:
            q = {q.centre, {q.axes[0], q.axes[1], q.axes[2]}, {k[0], -k[1], 0}, 0, -1};
            break;
        case Kind::parabolic_cylinder:
            q = {q.centre, {q.axes[0], q.axes[1], q.axes[2]}, {k[0], 0, 0}, -1, 0};
            break;
        case Kind::crossing_planes:
            q = {q.centre, {q.axes[0], q.axes[1], q.axes[2]}, {k[0], -k[1], 0}, 0, 0};
            break;
        case Kind::parallel_planes:
            q = {q.centre, {q.axes[0], q.axes[1], q.axes[2]}, {k[0], 0, 0}, 0, -1};
            break;
        case Kind::imaginary_planes:
            q = {q.centre, {q.axes[0], q.axes[1], q.axes[2]}, {k[0], 0, 0}, 0, 1};
            break;
        case Kind::double_plane:
            q = {q.centre, {q.axes[0], q.axes[1], q.axes[2]}, {k[0], 0, 0}, 0, 0};
            break;
    }
    if (random.next() % 2) {
        for (double& v : q.square) v = -v;
        q.slope = -q.slope;
        q.constant = -q.constant;
    }
    return q;
}

}  // namespace quadseg::surface::samples
