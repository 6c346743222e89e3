// Energies of packs of triangles with the one-point gradient: the formulas of triangle_energy(), a triangle a lane.
#pragma once

#include "quadric/pack.h"

namespace quadseg::quadric {

/// Eight triangles.
struct FacePack {
    Pack corners[9];  ///< x y z of three corners
    Pack normal[3];
    Pack area;  ///< 0 in the lanes that are filled up and for faces without area
};

/// Some lanes of a pack of triangles.
struct FacePart {
    Parts corners, normal;
    const Part& area;
    FacePart(const FacePack& f, std::size_t part) noexcept
        : corners(&f.corners[0], part), normal(&f.normal[0], part), area(part_of(f.area, part)) {}
};

/// Coefficients are numbers (one quadric for all lanes) or lanes (one each).
template <class Coefficients>
struct PartGradient {
    Part x, y, z;
    PartGradient(const Coefficients& c, const Part& px, const Part& py, const Part& pz) noexcept
        : x(2 * c[4] * px + c[5] * py + c[6] * pz + c[1]),
          y(c[5] * px + 2 * c[7] * py + c[8] * pz + c[2]),
          z(c[6] * px + c[8] * py + 2 * c[9] * pz + c[3]) {}
};

struct PartEnergy {
    Part distance, normal;  ///< 180 E_d and 12 E_n; E_d may be below 0 by rounding
    Part along;             ///< the area where n·∇f(c_t) > 0
};

template <class Coefficients>
[[gnu::always_inline]] inline void part_energy(const Coefficients& c, const FacePart& f, const Part& gradient_floor,
                                               PartEnergy& out) noexcept {
    using Gradient = PartGradient<Coefficients>;
    const Parts v = f.corners;
    const Gradient g0(c, v[0], v[1], v[2]), g1(c, v[3], v[4], v[5]), g2(c, v[6], v[7], v[8]);
    // f = c0 + u·(b + ∇f)/2; middles of edges from end values and gradients (see triangle_energy).
    const Part f0 = 0.5 * (v[0] * (g0.x + c[1]) + v[1] * (g0.y + c[2]) + v[2] * (g0.z + c[3])) + c[0];
    const Part f1 = 0.5 * (v[3] * (g1.x + c[1]) + v[4] * (g1.y + c[2]) + v[5] * (g1.z + c[3])) + c[0];
    const Part f2 = 0.5 * (v[6] * (g2.x + c[1]) + v[7] * (g2.y + c[2]) + v[8] * (g2.z + c[3])) + c[0];
    const Part m01 = 0.5 * (f0 + f1) + 0.125 * ((g0.x - g1.x) * (v[3] - v[0]) + (g0.y - g1.y) * (v[4] - v[1]) +
                                                (g0.z - g1.z) * (v[5] - v[2]));
    const Part m12 = 0.5 * (f1 + f2) + 0.125 * ((g1.x - g2.x) * (v[6] - v[3]) + (g1.y - g2.y) * (v[7] - v[4]) +
                                                (g1.z - g2.z) * (v[8] - v[5]));
    const Part m20 = 0.5 * (f2 + f0) + 0.125 * ((g2.x - g0.x) * (v[0] - v[6]) + (g2.y - g0.y) * (v[1] - v[7]) +
                                                (g2.z - g0.z) * (v[2] - v[8]));
    const Part corners = f0 + f1 + f2, middles = m01 + m12 + m20;
    const Part integral = 7.0 * (f0 * f0 + f1 * f1 + f2 * f2) - corners * corners -
                          8.0 * (f0 * m12 + f1 * m20 + f2 * m01) +
                          16.0 * (middles * middles + m01 * m01 + m12 * m12 + m20 * m20);
    const Part sx = g0.x + g1.x + g2.x, sy = g0.y + g1.y + g2.y, sz = g0.z + g1.z + g2.z;
    Part length{};
    square_root((sx * sx + sy * sy + sz * sz) * (1.0 / 9), length);
    maximum(length, gradient_floor, length);
    const Part r = 1.0 / length;
    out.distance = f.area * integral * (r * r);
    const Part &nx = f.normal[0], &ny = f.normal[1], &nz = f.normal[2];
    Part misfit{};
    const auto add_square = [&](const Part& x, const Part& y, const Part& z) { misfit += x * x + y * y + z * z; };
    add_square(g0.x * r - nx, g0.y * r - ny, g0.z * r - nz);
    add_square(g1.x * r - nx, g1.y * r - ny, g1.z * r - nz);
    add_square(g2.x * r - nx, g2.y * r - ny, g2.z * r - nz);
    add_square(sx * r - 3.0 * nx, sy * r - 3.0 * ny, sz * r - 3.0 * nz);
    out.normal = f.area * misfit;
    where_positive(sx * nx + sy * ny + sz * nz, f.area, out.along);
}

}  // namespace quadseg::quadric
