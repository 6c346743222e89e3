#include "quadric/ladder.h"

#include "quadric/fit.h"
#include "tests/quadric/shapes.h"

#include <gtest/gtest.h>

namespace quadseg::quadric {
namespace {

using test::Random;
using test::Soup;

constexpr double weight = 0.5;

TEST(Ladder, NamesTheShapes) {
    const auto model = [](const Soup& soup) { return fit_ladder(soup.moments(soup.corners[0]), weight, true).model; };
    EXPECT_EQ(model(test::plane_patch()), LadderModel::plane);
    EXPECT_EQ(model(test::ellipsoid_patch(12, 1, 1, 1)), LadderModel::sphere);
    EXPECT_EQ(model(test::cylinder_patch()), LadderModel::cylinder);
    EXPECT_EQ(model(test::cone_patch()), LadderModel::revolution);
    EXPECT_EQ(model(test::saddle_patch()), LadderModel::quadric);
}

TEST(Ladder, WithoutItPlanesStayPlanesAndTheRestAreQuadrics) {
    const auto fit = [](const Soup& soup) { return fit_ladder(soup.moments(soup.corners[0]), weight, false); };
    EXPECT_EQ(fit(test::plane_patch()).model, LadderModel::plane);
    for (const Soup& soup : {test::cylinder_patch(), test::saddle_patch(), test::ellipsoid_patch(8, 1, 1, 1)}) {
        const LadderFit f = fit(soup);
        EXPECT_EQ(f.model, LadderModel::quadric);
        EXPECT_EQ(f.cost, f.energy);
        EXPECT_EQ(f.dof, 9);
    }
}

TEST(Ladder, CostIsFactorTimesEnergyAndTheLeast) {
    for (const Soup& soup : {test::cylinder_patch(), test::saddle_patch(), test::cone_patch(),
                             test::ellipsoid_patch(8, 1, 1, 1), test::ellipsoid_patch(8, 1, 0.6, 0.4)}) {
        const Moments m = soup.moments(spread(soup.moments({})).centroid);
        const double s = 1 / spread(m).radius, s4 = s * s * s * s;
        const Moments unit = scaled(m, s);
        const double w = scaled_weight(weight, s);
        const LadderFit fit = fit_ladder(m, weight, true);
        EXPECT_EQ(fit.cost, ladder_factor(fit.model) * fit.energy);
        EXPECT_EQ(fit.dof, degrees_of_freedom(fit.model));
        const double slack = 1e-9 * fit.cost + 1e-14;
        EXPECT_LE(fit.cost, fit_plane(unit, w).energy / s4 + slack);
        EXPECT_LE(fit.cost, 1.05 * fit_sphere_linear(unit, w).energy / s4 + slack);
        EXPECT_LE(fit.cost, 1.1 * fit_cylinder_linear(unit, w).energy / s4 + slack);
        EXPECT_LE(fit.cost, 1.2 * fit_revolution_linear(unit, w).energy / s4 + slack);
        EXPECT_LE(fit.cost, 1.5 * fit_least_squares(unit, w).energy / s4 + slack);
    }
}

TEST(Ladder, CoefficientsAreInTheFrameOfTheMoments) {
    Random random(1);
    for (const Soup& soup : {test::plane_patch(), test::cylinder_patch(), test::saddle_patch(), test::cone_patch(),
                             test::ellipsoid_patch(8, 1, 1, 1)}) {
        for (const bool ladder : {true, false}) {
            const Vec3 origin = random.vector(1);
            const Moments m = soup.moments(origin);
            const LadderFit fit = fit_ladder(m, weight, ladder);
            EXPECT_NEAR(moment_energy(fit.c, m).hybrid(weight), fit.energy, 1e-10);
            const Vec3 x = (soup.corners[0] + soup.corners[1] + soup.corners[2]) / 3.0 - origin;
            EXPECT_GT(dot(gradient(fit.c, x), soup.normals[0]), 0.3);
        }
    }
}

TEST(Ladder, DoesNotDependOnTheFrameOfTheMoments) {
    Random random(2);
    const Soup soup = test::ellipsoid_patch(8, 0.05, 0.04, 0.03);
    const LadderFit fit = fit_ladder(soup.moments(soup.corners[0]), weight, true);
    for (int round = 0; round < 10; ++round) {
        const auto rotation = test::random_rotation(random);
        const Soup moved = soup.mapped([&](const Vec3& x) { return rotation * x; });
        const LadderFit other = fit_ladder(moved.moments(moved.corners[0] + random.vector(0.05)), weight, true);
        EXPECT_NEAR(other.energy, fit.energy, 1e-8 * fit.energy);
        EXPECT_EQ(other.model, fit.model);
    }
}

TEST(Ladder, EnergyOfAUnionIsNotBelowThatOfItsParts) {
    Random random(3);
    for (int round = 0; round < 50; ++round) {
        Soup a, b;
        const auto add_triangle = [&](Soup& soup) {
            // One after the other: of arguments no order is laid down.
            const Vec3 third = random.vector(1), second = random.vector(1), first = random.vector(1);
            soup.add(first, second, third);
        };
        for (int k = 0; k < 6; ++k) {
            add_triangle(a);
            add_triangle(b);
        }
        const Vec3 oa = random.vector(1), ob = random.vector(1), o = random.vector(1);
        const Moments both = joined(a.moments(oa), oa, b.moments(ob), ob, o);
        Soup together = a;
        together.append(b);
        const Moments direct = together.moments(o);
        for (std::size_t i = 0; i < 35; ++i) EXPECT_NEAR(both.area[i], direct.area[i], 1e-11);
        const double separate =
            fit_ladder(a.moments(oa), weight, false).energy + fit_ladder(b.moments(ob), weight, false).energy;
        EXPECT_GE(fit_ladder(both, weight, false).energy, separate * (1 - 1e-3) - 1e-10);
    }
}

TEST(Ladder, CoplanarPiecesStayAPlaneWhateverTheirNumber) {
    // Rounding must neither turn an exact plane into something else nor give it energy.
    Random random(4);
    for (int round = 0; round < 50; ++round) {
        const auto rotation = test::random_rotation(random);
        const Vec3 shift = random.vector(1);
        const double s = std::pow(10, random.uniform(-4, 0));
        const Soup soup = test::plane_patch(3).mapped([&](const Vec3& x) { return rotation * x * s + shift; });
        for (const bool ladder : {true, false}) {
            const LadderFit fit = fit_ladder(soup.moments(soup.corners[3]), weight, ladder);
            EXPECT_EQ(fit.model, LadderModel::plane) << s;
            EXPECT_LT(fit.energy, 1e-14 * soup.area());
        }
    }
}

TEST(Ladder, SurvivesEmptyAndDegenerateMoments) {
    Soup one, flat;
    one.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    flat.add({0, 0, 0}, {1, 0, 0}, {2, 0, 0});
    Moments cancelled = one.moments({});
    cancelled -= one.moments({});
    for (const Moments& m : {Moments{}, one.moments({}), flat.moments({}), cancelled}) {
        for (const double w : {0.0, 0.5}) {
            for (const bool ladder : {true, false}) {
                const LadderFit fit = fit_ladder(m, w, ladder);
                EXPECT_EQ(fit.model, LadderModel::plane);
                EXPECT_NEAR(fit.energy, 0, 1e-15);
                for (const double v : fit.c) EXPECT_TRUE(std::isfinite(v));
            }
        }
    }
}

}  // namespace
}  // namespace quadseg::quadric
