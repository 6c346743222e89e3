// Symmetric 3×3 matrices and their eigen decomposition.
#pragma once

#include "math/vec3.h"

namespace quadseg {

struct Symmetric3 {
    double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

    /// this += w · v vᵀ
    void add_outer(const Vec3& v, double w = 1) noexcept {
        xx += w * v.x * v.x;
        xy += w * v.x * v.y;
        xz += w * v.x * v.z;
        yy += w * v.y * v.y;
        yz += w * v.y * v.z;
        zz += w * v.z * v.z;
    }
    Vec3 operator*(const Vec3& v) const noexcept {
        return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z, xz * v.x + yz * v.y + zz * v.z};
    }
};

struct EigenSystem {
    double values[3];  ///< ascending
    Vec3 vectors[3];   ///< unit, right-handed, same order
};

/// Cyclic Jacobi: accurate to rounding also for close eigenvalues and tiny matrices. Never fails for finite input.
EigenSystem eigen_decomposition(const Symmetric3& m) noexcept;

}  // namespace quadseg
