#include "quadric/fit.h"

#include "math/symmetric3.h"
#include "quadric/axis.h"
#include "quadric/cholesky.h"
#include "tests/quadric/shapes.h"

#include <gtest/gtest.h>

namespace quadseg::quadric {
namespace {

using test::Random;
using test::Soup;

constexpr double weight = 0.5;

struct Local {
    Moments moments;
    Vec3 centre;
    double scale = 1;
};
Local local_moments(const Soup& soup) {
    const Spread s = spread(soup.moments(soup.corners[0]));
    Local local;
    local.centre = soup.corners[0] + s.centroid;
    local.scale = 1 / s.radius;
    local.moments = scaled(soup.moments(local.centre), local.scale);
    return local;
}

/// Largest |f|/|∇f| at the corners, in the frame of the fit.
double worst_corner_distance(const Coefficients& c, const Soup& soup, const Local& local) {
    double worst = 0;
    for (const Vec3& x : soup.corners) {
        const Vec3 u = (x - local.centre) * local.scale;
        worst = std::max(worst, std::abs(value(c, u)) / norm(gradient(c, u)));
    }
    return worst;
}

/// Direction along which the quadratic form vanishes.
Vec3 cylinder_axis(const Coefficients& c) {
    const EigenSystem e = eigen_decomposition({c[4], c[5] / 2, c[6] / 2, c[7], c[8] / 2, c[9]});
    return std::abs(e.values[0]) < std::abs(e.values[2]) ? e.vectors[0] : e.vectors[2];
}

/// Points and normals of the true surface cannot be had from facets; triangles inside straight lines of a surface can:
/// slivers along the rulings of a cylinder shrink to exact data.
Soup ruled_cylinder(double radius, const Vec3& axis, const Vec3& at) {
    const Vec3 p = any_perpendicular(axis), q = cross(axis, p);
    Soup soup;
    const int strips = 24;
    for (int i = 0; i < strips; ++i) {
        const double u = 1.7 * i / strips, width = 1e-7;
        const auto point = [&](double angle, double h) {
            return at + (p * std::cos(angle) + q * std::sin(angle) + axis * h) * radius;
        };
        soup.add(point(u, 0), point(u + width, 0), point(u + width, 1));
        soup.add(point(u, 0), point(u + width, 1), point(u, 1));
        for (std::size_t k = 2; k-- > 0;) {
            soup.normals[soup.size() - 1 - k] = p * std::cos(u + width / 2) + q * std::sin(u + width / 2);
        }
    }
    return soup;
}

TEST(FitPlane, IsExactOnPlanes) {
    Random random(1);
    for (int round = 0; round < 20; ++round) {
        const auto rotation = test::random_rotation(random);
        const Vec3 shift = random.vector(2);
        const Soup soup = test::plane_patch().mapped([&](const Vec3& x) { return rotation * x + shift; });
        const Local local = local_moments(soup);
        const QuadricFit fit = fit_plane(local.moments, weight);
        EXPECT_LT(norm(Vec3{fit.c[1], fit.c[2], fit.c[3]} - soup.normals[0]), 1e-14);
        EXPECT_LT(fit.energy, 1e-13);
        EXPECT_LT(worst_corner_distance(fit.c, soup, local), 1e-14);
    }
}

TEST(FitPlane, HasTheLeastHybridEnergyOfAllPlanes) {
    Random random(2);
    for (const double w : {1e-3, 0.5, 100.0}) {
        for (const Soup& soup : {test::saddle_patch(4), test::cylinder_patch(8, 1, 3), test::crease_patch(3),
                                 test::cylinder_patch(16, 1, 6.283185307)}) {
            const Local local = local_moments(soup);
            const QuadricFit fit = fit_plane(local.moments, w);
            EXPECT_NEAR(moment_energy(fit.c, local.moments).hybrid(w), fit.energy, 1e-10 * (1 + fit.energy));
            const Vec3 best{fit.c[1], fit.c[2], fit.c[3]};
            for (int k = 0; k < 200; ++k) {
                const Vec3 n = k < 100 ? random.direction() : normalized(best + random.vector(1e-3));
                const double d = fit.c[0] + (k % 2 == 0 ? 0 : random.uniform(-1e-3, 1e-3));
                EXPECT_GE(moment_energy(plane(n, d), local.moments).hybrid(w), fit.energy * (1 - 1e-9));
            }
        }
    }
}

TEST(FitPlane, FindsTheMinimumWhereNormalsCancel) {
    // Two opposite sheets: the mean normal vanishes, distance alone decides.
    Soup soup = test::patch(3, -1, 1, -1, 1, [](double u, double v) { return Vec3{u, v, 0.01}; });
    soup.append(test::patch(3, -1, 1, -1, 1, [](double u, double v) { return Vec3{v, u, -0.01}; }));
    const QuadricFit fit = fit_plane(local_moments(soup).moments, weight);
    EXPECT_NEAR(std::abs(fit.c[3]), 1, 1e-12);
}

TEST(FitTaubin, IsExactOnQuadricsThatTheFacetsReach) {
    // f exact at thin facets only to their width: 1e-7 wide strips leave a sagitta of 1e-15.
    const Vec3 axis = normalized({0.3, -0.5, 0.8});
    for (const double radius : {0.02, 0.002}) {
        const Soup soup = ruled_cylinder(radius, axis, {0.4, -0.3, 0.45});
        const Local local = local_moments(soup);
        const double w = scaled_weight(weight, local.scale);
        const QuadricFit taubin = fit_taubin(local.moments), linear = fit_least_squares(local.moments, w);
        EXPECT_LT(norm(cross(cylinder_axis(taubin.c), axis)), 1e-12) << radius;
        EXPECT_LT(norm(cross(cylinder_axis(linear.c), axis)), 1e-12) << radius;
        EXPECT_LT(worst_corner_distance(taubin.c, soup, local), 1e-11);
        EXPECT_LT(worst_corner_distance(linear.c, soup, local), 1e-11);
    }
}

struct Shape {
    const char* name;
    Soup soup;
    Coefficients exact;
};
std::vector<Shape> shapes(int n) {
    return {{"sphere", test::ellipsoid_patch(n, 1, 1, 1), {-1, 0, 0, 0, 1, 0, 0, 1, 0, 1}},
            {"cylinder", test::cylinder_patch(n), {-1, 0, 0, 0, 1, 0, 0, 1, 0, 0}},
            {"cone", test::cone_patch(n), {0, 0, 0, 0, 1, 0, 0, 1, 0, -1}},
            {"saddle", test::saddle_patch(n), {0, 0, 0, 1, 0, -0.4, 0, 0, 0, 0}},
            {"ellipsoid", test::ellipsoid_patch(n, 1, 0.7, 0.5), {-1, 0, 0, 0, 1, 0, 0, 1 / 0.49, 0, 4}}};
}

TEST(Fits, ConvergeToTheTrueSurfaceWithTheFacets) {
    for (const bool taubin : {true, false}) {
        std::vector<double> errors[2];
        int level = 0;
        for (const int n : {8, 32}) {
            for (const Shape& s : shapes(n)) {
                const Local local = local_moments(s.soup);
                const QuadricFit fit = taubin ? fit_taubin(local.moments)
                                              : fit_least_squares(local.moments, scaled_weight(weight, local.scale));
                EXPECT_FALSE(fit.regularised) << s.name;
                EXPECT_GT(dot(gradient(fit.c, {}), s.soup.normals[s.soup.size() / 2]), 0) << s.name;
                errors[level].push_back(worst_corner_distance(fit.c, s.soup, local));
            }
            ++level;
        }
        for (std::size_t i = 0; i < errors[0].size(); ++i) {
            // Linear least squares is biased where |∇f| varies (cone, ellipsoid): only Taubin must go to zero there.
            if (taubin || i < 2) {
                EXPECT_LT(errors[1][i], 0.1 * errors[0][i] + 1e-14) << i;
            }
            EXPECT_LT(errors[1][i], 0.08) << i;
        }
    }
}

TEST(FitTaubin, ReportsAreaTimesTheSmallestQuotient) {
    Random random(3);
    for (const Shape& s : shapes(6)) {
        const Local local = local_moments(s.soup);
        const QuadricFit fit = fit_taubin(local.moments);
        const auto quotient = [&](const Coefficients& c) {
            const TriangleEnergy e = moment_energy(c, local.moments);
            Moments no_normals = local.moments;
            no_normals.normal = {};
            no_normals.normal_area = 0;
            return local.moments.area[0] * e.distance / moment_energy(c, no_normals).normal;
        };
        EXPECT_NEAR(quotient(fit.c), fit.energy, 1e-6 * fit.energy + 1e-14) << s.name;
        for (int k = 0; k < 50; ++k) {
            Coefficients c = fit.c;
            for (double& v : c) v += random.uniform(-1, 1) * (k % 2 == 0 ? 1e-2 : 1);
            EXPECT_GE(quotient(c), fit.energy * (1 - 1e-6)) << s.name;
        }
    }
}

TEST(FitLeastSquares, HasTheLeastQuadraticEnergy) {
    Random random(4);
    for (const Shape& s : shapes(6)) {
        const Local local = local_moments(s.soup);
        const QuadricFit fit = fit_least_squares(local.moments, weight);
        EXPECT_NEAR(moment_energy(fit.c, local.moments).hybrid(weight), fit.energy, 1e-12);
        for (int k = 0; k < 50; ++k) {
            Coefficients c = fit.c;
            for (double& v : c) v += random.uniform(-1, 1) * 1e-3;
            EXPECT_GE(moment_energy(c, local.moments).hybrid(weight), fit.energy) << s.name;
        }
    }
}

TEST(FitLeastSquares, NeverReturnsAPairOfPlanesForACrease) {
    const Local local = local_moments(test::crease_patch());
    EXPECT_LT(fit_taubin(local.moments).energy, 1e-12);  // the pair
    const QuadricFit fit = fit_least_squares(local.moments, weight);
    EXPECT_GT(fit.energy, 0.02 * weight * local.moments.area[0] * 0.1);
    EXPECT_GT(fit.energy, 1e-3);
}

TEST(RestrictedFits, AreExactMembersOfTheirFamily) {
    for (const Shape& s : shapes(10)) {
        const Local local = local_moments(s.soup);
        const double w = scaled_weight(weight, local.scale);
        const QuadricFit sphere = fit_sphere_linear(local.moments, w), cylinder = fit_cylinder_linear(local.moments, w),
                         revolution = fit_revolution_linear(local.moments, w),
                         quadric = fit_least_squares(local.moments, w);
        EXPECT_NEAR(sphere.c[4], sphere.c[7], 1e-14);
        EXPECT_NEAR(sphere.c[4], sphere.c[9], 1e-14);
        EXPECT_NEAR(std::abs(sphere.c[5]) + std::abs(sphere.c[6]) + std::abs(sphere.c[8]), 0, 1e-14);
        // Cylinder: ∇f has no part along the axis, and equal curvature across it.
        const EigenSystem e = eigen_decomposition(
            {cylinder.c[4], cylinder.c[5] / 2, cylinder.c[6] / 2, cylinder.c[7], cylinder.c[8] / 2, cylinder.c[9]});
        const int flat = std::abs(e.values[0]) < std::abs(e.values[2]) ? 0 : 2;
        EXPECT_NEAR(e.values[flat], 0, 1e-13);
        EXPECT_NEAR(e.values[1], e.values[2 - flat], 1e-13);
        EXPECT_NEAR(dot({cylinder.c[1], cylinder.c[2], cylinder.c[3]}, e.vectors[flat]), 0, 1e-12);
        const EigenSystem r = eigen_decomposition({revolution.c[4], revolution.c[5] / 2, revolution.c[6] / 2,
                                                   revolution.c[7], revolution.c[8] / 2, revolution.c[9]});
        EXPECT_NEAR(std::min(r.values[1] - r.values[0], r.values[2] - r.values[1]), 0, 1e-12);
        // Nested families, and the energies that they report are true.
        for (const QuadricFit& fit : {sphere, cylinder, revolution}) {
            EXPECT_GE(fit.energy, quadric.energy - 1e-12) << s.name;
            EXPECT_NEAR(moment_energy(fit.c, local.moments).hybrid(w), fit.energy, 1e-11 * (1 + w)) << s.name;
        }
        EXPECT_LE(revolution.energy, sphere.energy + 1e-12) << s.name;
    }
}

TEST(RestrictedFits, FindTheirShapes) {
    const auto energies = [](const Soup& soup) {
        const Local local = local_moments(soup);
        const double w = scaled_weight(weight, local.scale);
        return std::array<double, 4>{
            fit_sphere_linear(local.moments, w).energy, fit_cylinder_linear(local.moments, w).energy,
            fit_revolution_linear(local.moments, w).energy, fit_least_squares(local.moments, w).energy};
    };
    const auto sphere = energies(test::ellipsoid_patch(12, 1, 1, 1));
    EXPECT_LT(sphere[0], 1.03 * sphere[3]);
    const auto cylinder = energies(test::cylinder_patch());
    EXPECT_LT(cylinder[1], 1.03 * cylinder[3]);
    EXPECT_GT(cylinder[0], 5 * cylinder[3]);
    const auto cone = energies(test::cone_patch());
    EXPECT_LT(cone[2], 1.05 * cone[3]);
    const auto spheroid = energies(test::ellipsoid_patch(12, 1, 1, 0.4));
    EXPECT_LT(spheroid[2], 1.3 * spheroid[3]);  // the axis is estimated, not optimised
}

TEST(Fits, SurviveWhatHasNoSolution) {
    Soup one, two, flat;
    one.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    two.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    two.add({1, 0, 0}, {1, 1, 0.4}, {0, 1, 0});
    flat.add({0, 0, 0}, {1, 0, 0}, {3, 0, 0});
    for (const Moments& m :
         {one.moments({}), two.moments({0.3, 0.3, 0}), flat.moments({}), Moments{}, test::plane_patch().moments({})}) {
        for (const QuadricFit& fit :
             {fit_plane(m, weight), fit_taubin(m), fit_least_squares(m, weight), fit_least_squares(m, 0),
              fit_sphere_linear(m, weight), fit_cylinder_linear(m, weight), fit_revolution_linear(m, weight)}) {
            EXPECT_TRUE(std::isfinite(fit.energy));
            EXPECT_GE(fit.energy, 0);
            for (const double v : fit.c) EXPECT_TRUE(std::isfinite(v));
        }
    }
    // A single triangle: its plane squared is a common null vector; the system had to be stabilised, the plane is
    // found.
    EXPECT_TRUE(fit_least_squares(one.moments({}), weight).regularised);
    const QuadricFit fit = fit_least_squares(local_moments(one).moments, weight);
    EXPECT_LT(fit.energy, 1e-10);
    EXPECT_NEAR(gradient(fit.c, {}).z, 1, 1e-6);
}

TEST(Axis, ClosedFormsAgreeWithJacobi) {
    Random random(5);
    for (int round = 0; round < 200; ++round) {
        Symmetric3 m;
        for (int k = 0; k < 4; ++k) m.add_outer(random.vector(1), random.uniform(-1, 1));
        const EigenSystem e = eigen_decomposition(m);
        const double low = e.values[1] - e.values[0], high = e.values[2] - e.values[1];
        if (low > 1e-3) {
            EXPECT_LT(norm(cross(smallest_eigenvector(m), e.vectors[0])), 1e-9);
        }
        const int isolated = low > high ? 0 : 2;
        if (std::abs(low - high) > 1e-6 && std::max(low, high) > 1e-3) {
            EXPECT_LT(norm(cross(isolated_eigenvector(m), e.vectors[isolated])), 1e-9);
        }
    }
    EXPECT_NEAR(norm(smallest_eigenvector({})), 1, 1e-12);
    EXPECT_NEAR(norm(smallest_eigenvector({1, 0, 0, 1, 0, 1})), 1, 1e-12);
    EXPECT_NEAR(norm(isolated_eigenvector({2, 0, 0, 2, 0, 2})), 1, 1e-12);
}

TEST(Cholesky, SolvesAndKnowsSingularMatrices) {
    Random random(6);
    for (int round = 0; round < 50; ++round) {
        Matrix<5> a{};
        for (int k = 0; k < 7; ++k) {
            Vector<5> v;
            for (double& x : v) x = random.uniform(-1, 1);
            for (std::size_t i = 0; i < 5; ++i) {
                for (std::size_t j = 0; j < 5; ++j) a[i][j] += v[i] * v[j];
            }
        }
        Vector<5> x, b{};
        for (double& v : x) v = random.uniform(-1, 1);
        for (std::size_t i = 0; i < 5; ++i) {
            for (std::size_t j = 0; j < 5; ++j) b[i] += a[i][j] * x[j];
        }
        Cholesky<5> cholesky;
        ASSERT_TRUE(cholesky.factor(a, b, 1e-13));
        const Vector<5> solution = cholesky.solution();
        Vector<5> solved = b;
        cholesky.solve(solved);
        double product = 0;
        for (std::size_t i = 0; i < 5; ++i) {
            EXPECT_NEAR(solution[i], x[i], 1e-8);
            EXPECT_NEAR(solved[i], solution[i], 1e-12);
            product += b[i] * x[i];
        }
        EXPECT_NEAR(cholesky.reduction(), product, 1e-9);
        // A row twice: singular.
        for (std::size_t i = 0; i < 5; ++i) a[i][4] = a[i][3];
        a[3][4] = a[4][4] = a[3][3];
        EXPECT_FALSE(cholesky.factor(a, b, 1e-13));
        const auto state = cholesky.factor_stabilised(a, b);
        EXPECT_TRUE(state.usable);
        EXPECT_TRUE(state.regularised);
    }
    Matrix<2> broken = {{{NAN, 0}, {0, 1}}};
    EXPECT_FALSE(Cholesky<2>().factor_stabilised(broken, {}).usable);
}

}  // namespace
}  // namespace quadseg::quadric
