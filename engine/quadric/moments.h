// Integrals over triangles from which every fit is made (MATH.md §2): additive, shiftable, 35 + 12 + 6 numbers.
#pragma once

#include "math/vec3.h"
#include "quadric/monomials.h"

#include <array>
#include <cstddef>

namespace quadseg::quadric {

/// Exponents (i, j, k) of the 35 monomials x^i y^j z^k of degree ≤ 4; the first 10 are those of Coefficients in their
/// order without factors, then degree 3 (10), then degree 4 (15), lexicographic in falling powers of x, then y.
extern const std::array<std::array<int, 3>, 35> moment_exponents;

struct Moments {
    std::array<double, 35> area{};  ///< ∫ w₂ x^i y^j z^k dσ, weight w₂ = 1/|∇f⁰|² in the second step, else 1
    /// ∫ w₁ n_a · {1, x, y, z} dσ: [3·a + 3 … ] see normal_index(); weight w₁ = 1/|∇f⁰|, else 1
    std::array<double, 12> normal{};
    std::array<double, 6> normal2{};  ///< ∫ n nᵀ dσ: xx xy xz yy yz zz, unweighted
    double total_area = 0;            ///< ∫ dσ, unweighted
    double normal_area = 0;           ///< ∫ |n_t|² dσ: total_area without faces of no normal

    Moments& operator+=(const Moments& b) noexcept;
    Moments& operator-=(const Moments& b) noexcept;
};
/// Index in Moments::normal of ∫ n_a m dσ, a = 0..2 component of n, m = 0..3 for {1, x, y, z}.
constexpr std::size_t normal_index(std::size_t a, std::size_t m) noexcept {
    return 4 * a + m;
}

/// Adds a triangle (corners relative to the frame of the moments) with weights w2 on area, w1 on normal moments. Exact.
/// n: unit normal; area: its area in the same unit as the corners.
void accumulate(Moments& m, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& n, double area, double w2 = 1,
                double w1 = 1) noexcept;

/// Moments about another origin: those of x' = x − shift. Exact binomial formula, generated axis by axis.
Moments shifted(const Moments& m, const Vec3& shift) noexcept;
/// Moments in units scaled by s: x' = s·x (areas scale by s²).
Moments scaled(const Moments& m, double s) noexcept;

/// Centroid and RMS radius (root of the mean squared distance from the centroid) of the area. Radius 0 for no area.
struct Spread {
    Vec3 centroid;
    double radius = 0;
};
Spread spread(const Moments& m) noexcept;

}  // namespace quadseg::quadric
