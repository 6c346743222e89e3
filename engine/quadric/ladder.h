// The model ladder of merging: the cheapest surface that explains summed moments, simple models preferred mildly.
#pragma once

#include "quadric/moments.h"
#include "quadric/monomials.h"

#include <cstdint>

namespace quadseg::quadric {

enum class LadderModel : std::uint8_t { plane, sphere, cylinder, revolution, quadric };

/// What a model's energy is multiplied by when models are compared: plane 1, sphere 1.05, cylinder 1.1, surface of
/// revolution 1.2, quadric 1.5 (mild: dense parts gain .03, CAD tessellations .065 of mean IoU over no ladder).
double ladder_factor(LadderModel model) noexcept;
/// Degrees of freedom: 3, 4, 5, 6, 9.
int degrees_of_freedom(LadderModel model) noexcept;

struct LadderFit {
    Coefficients c{};   ///< in the frame of the moments given, |∇f| ≈ 1, oriented along the normals
    double energy = 0;  ///< E_d + ω E_n ≥ 0 from the moments, in their units, without the factor
    double cost = 0;    ///< ladder_factor(model) · energy; without the ladder the energy
    int dof = 3;
    LadderModel model = LadderModel::plane;
};

/// The model of smallest cost for unit-weight moments about any origin near them, in units in which `weight` holds
/// (the unit frame). Centres and scales internally. With ladder = false: the plane or the quadric, whichever has the
/// smaller energy (the plane when they are equal to rounding). Moments of no area give a plane of energy 0.
LadderFit fit_ladder(const Moments& m, double weight, bool ladder) noexcept;

/// Moments of the union of two regions about `origin`, from each one's about its own origin.
Moments joined(const Moments& a, const Vec3& origin_a, const Moments& b, const Vec3& origin_b,
               const Vec3& origin) noexcept;

}  // namespace quadseg::quadric
