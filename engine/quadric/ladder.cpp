#include "quadric/ladder.h"

#include "quadric/fit.h"
#include "quadric/nested_fits.h"
#include "quadric/pack.h"
#include "quadric/triangle_moments.h"

namespace quadseg::quadric {
namespace {

/// An angle of 1e-6 rad on every normal: energies below this are rounding and do not decide between models.
constexpr double rounding_angle_square = 1e-12;

/// Of the radius: a centroid nearer to the origin than this is at it to rounding.
constexpr double centred_share = 1e-10;

/// Without the ladder a quadric must beat the plane by more than this to be worth its degrees of freedom.
constexpr double equal_to_rounding = 1 + 1e-3;

}  // namespace

double ladder_factor(LadderModel model) noexcept {
    constexpr std::array<double, 5> factors = {1, 1.05, 1.1, 1.2, 1.5};
    return factors[static_cast<std::size_t>(model)];
}

int degrees_of_freedom(LadderModel model) noexcept {
    constexpr std::array<int, 5> dof = {3, 4, 5, 6, 9};
    return dof[static_cast<std::size_t>(model)];
}

Moments joined(const Moments& a, const Vec3& origin_a, const Moments& b, const Vec3& origin_b,
               const Vec3& origin) noexcept {
    // shifted() of both at once.
    const Vec3 shift_a = origin - origin_a, shift_b = origin - origin_b;
    Pair area[35];
    for (std::size_t i = 0; i < 35; ++i) area[i] = Pair{a.area[i], b.area[i]};
    translate_moments(&area[0], Pair{-shift_a.x, -shift_b.x}, Pair{-shift_a.y, -shift_b.y},
                      Pair{-shift_a.z, -shift_b.z});
    Moments sum = a;
    for (std::size_t i = 0; i < 35; ++i) sum.area[i] = area[i][0] + area[i][1];
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double mean_a = a.normal[normal_index(axis, 0)], mean_b = b.normal[normal_index(axis, 0)];
        sum.normal[normal_index(axis, 0)] = mean_a + mean_b;
        for (std::size_t k = 1; k < 4; ++k) {
            const int direction = static_cast<int>(k) - 1;
            sum.normal[normal_index(axis, k)] = (a.normal[normal_index(axis, k)] - shift_a[direction] * mean_a) +
                                                (b.normal[normal_index(axis, k)] - shift_b[direction] * mean_b);
        }
    }
    for (std::size_t i = 0; i < 6; ++i) sum.normal2[i] += b.normal2[i];
    sum.total_area += b.total_area;
    sum.normal_area += b.normal_area;
    return sum;
}

LadderFit fit_ladder(const Moments& m, double weight, bool ladder) noexcept {
    LadderFit result;
    Spread size = spread(m);
    if (!(size.radius > 0)) {
        result.c = fit_plane(m, weight).c;
        return result;
    }
    const double scale = 1 / size.radius;
    // Regions are merged about their common centroid: then there is nothing to shift.
    const bool is_centred = squared_norm(size.centroid) <= centred_share * centred_share * size.radius * size.radius;
    if (is_centred) size.centroid = {};
    const Moments centred = scaled(is_centred ? m : shifted(m, size.centroid), scale);
    const double local_weight = scaled_weight(weight, scale);
    const double rounding = rounding_angle_square * (local_weight + 1e-12) * centred.area[0];

    QuadricFit best = fit_plane(centred, local_weight);
    LadderModel model = LadderModel::plane;
    double best_cost = best.energy + rounding;
    const auto factor = [ladder](LadderModel candidate) {
        return candidate == LadderModel::plane ? 1.0 : ladder ? ladder_factor(candidate) : equal_to_rounding;
    };
    const auto offer = [&](const QuadricFit& candidate, LadderModel candidate_model) {
        const double cost = factor(candidate_model) * (candidate.energy + rounding);
        if (cost < best_cost) {
            best = candidate;
            model = candidate_model;
            best_cost = cost;
        }
    };
    // The quadric's energy bounds those of all the others from below: it tells which of them can still win.
    if (best_cost > factor(LadderModel::sphere) * rounding) {
        const NestedFits fits(centred, local_weight);
        const double bound = fits.quadric_energy() + rounding;
        const auto may_win = [&](LadderModel candidate) { return factor(candidate) * bound < best_cost; };
        if (fits.usable() && may_win(LadderModel::sphere)) {
            const QuadricFit quadric = fits.quadric();
            if (ladder) {
                if (factor(LadderModel::sphere) * (fits.sphere_energy() + rounding) < best_cost) {
                    offer(fits.sphere(), LadderModel::sphere);
                }
                if (may_win(LadderModel::cylinder)) {
                    offer(fits.cylinder(cylinder_direction(centred)), LadderModel::cylinder);
                }
                if (may_win(LadderModel::revolution)) {
                    offer(fits.revolution(revolution_direction(centred)), LadderModel::revolution);
                }
                if (may_win(LadderModel::revolution)) {
                    offer(fits.revolution(revolution_direction(quadric.c)), LadderModel::revolution);
                }
            }
            if (may_win(LadderModel::quadric)) offer(quadric, LadderModel::quadric);
        }
    }
    result.c = from_local(best.c, size.centroid, scale);
    for (double& v : result.c) v *= size.radius;  // |∇f| as it was in the local frame
    const double to_input_units = size.radius * size.radius * size.radius * size.radius;
    result.energy = best.energy * to_input_units;
    result.cost = (ladder ? ladder_factor(model) : 1.0) * result.energy;
    result.model = model;
    result.dof = degrees_of_freedom(model);
    return result;
}

}  // namespace quadseg::quadric
