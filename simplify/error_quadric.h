// The error quadric of Garland and Heckbert (1997): Q(x) = xᵀAx + 2bᵀx + c, a weighted sum of squared plane distances.
#pragma once

#include "math/vec3.h"

#include <algorithm>
#include <cmath>

namespace quadseg::simplify {

struct ErrorQuadric {
    double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;  ///< A
    Vec3 b;
    double c = 0;
    double area = 0;  ///< of the faces in it: Q / area is a mean squared distance

    /// The plane n·x = offset, n unit.
    void add_plane(const Vec3& n, double offset, double weight) noexcept {
        const Vec3 wn = n * weight;
        xx += wn.x * n.x;
        xy += wn.x * n.y;
        xz += wn.x * n.z;
        yy += wn.y * n.y;
        yz += wn.y * n.z;
        zz += wn.z * n.z;
        b -= wn * offset;
        c += weight * offset * offset;
    }
    ErrorQuadric& operator+=(const ErrorQuadric& q) noexcept {
        xx += q.xx;
        xy += q.xy;
        xz += q.xz;
        yy += q.yy;
        yz += q.yz;
        zz += q.zz;
        b += q.b;
        c += q.c;
        area += q.area;
        return *this;
    }
    Vec3 times(const Vec3& v) const noexcept {
        return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z, xz * v.x + yz * v.y + zz * v.z};
    }
    double operator()(const Vec3& x) const noexcept { return std::max(dot(x, times(x) + b * 2.0) + c, 0.0); }

    /// The minimum nearest to `start`: along directions in which the quadric (almost) does not vary it stays put.
    /// Two steps of iterated Tikhonov regularisation: the strong directions are exact to 1e-10 and better.
    Vec3 minimum_near(const Vec3& start) const noexcept {
        const double trace = xx + yy + zz;
        if (!(trace > 0)) return start;
        const double ridge = 1e-6 * trace;
        const double dx = xx + ridge, dy = yy + ridge, dz = zz + ridge;
        // Adjugate of A + ridge·I: a single division.
        const double ixx = dy * dz - yz * yz, ixy = xz * yz - xy * dz, ixz = xy * yz - xz * dy;
        const double iyy = dx * dz - xz * xz, iyz = xy * xz - dx * yz, izz = dx * dy - xy * xy;
        const double inverse = 1.0 / (dx * ixx + xy * ixy + xz * ixz);
        Vec3 x = start;
        for (int step = 0; step < 2; ++step) {
            const Vec3 g = (times(x) + b) * inverse;
            x -= {ixx * g.x + ixy * g.y + ixz * g.z, ixy * g.x + iyy * g.y + iyz * g.z,
                  ixz * g.x + iyz * g.y + izz * g.z};
        }
        return x;
    }
};

}  // namespace quadseg::simplify
