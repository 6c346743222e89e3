#include "quadric/region_fit.h"
#include "quadric/sheets.h"
#include "tests/quadric/shapes.h"

#include <gtest/gtest.h>

namespace quadseg::quadric {
namespace {

using test::Random;
using test::Soup;

/// Validity must not depend on where the region lies, how it is turned and how large it is.
bool valid_everywhere(const Coefficients& c, const Soup& soup, bool expected) {
    Random random(7);
    bool all = is_valid({{}, c, 1e-6}, soup.view()) == expected;
    for (int round = 0; round < 4; ++round) {
        const auto rotation = test::random_rotation(random);
        const Vec3 shift = random.vector(3);
        const double s = round % 2 == 0 ? 1 : 0.01;
        const Soup moved = soup.mapped([&](const Vec3& x) { return rotation * x * s + shift; });
        // f'(x) = f(Rᵀ(x − shift)/s)
        const Coefficients scaled = to_local(c, {}, s);
        const Vec3 b{scaled[1], scaled[2], scaled[3]};
        const Vec3 axes[3] = {rotation.x, rotation.y, rotation.z};
        const double q[3][3] = {{scaled[4], scaled[5] / 2, scaled[6] / 2},
                                {scaled[5] / 2, scaled[7], scaled[8] / 2},
                                {scaled[6] / 2, scaled[8] / 2, scaled[9]}};
        const Vec3 linear = rotation * b;
        double m[3][3] = {};
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) {
                for (int k = 0; k < 3; ++k) {
                    for (int l = 0; l < 3; ++l) m[k][l] += q[i][j] * axes[i][k] * axes[j][l];
                }
            }
        }
        const Coefficients turned = {scaled[0],   linear.x,    linear.y, linear.z,    m[0][0],
                                     2 * m[0][1], 2 * m[0][2], m[1][1],  2 * m[1][2], m[2][2]};
        all = all && is_valid({shift, turned, 1e-6}, moved.view()) == expected;
    }
    return all;
}

Soup sheet(double height, double sign) {
    return test::patch(6, -1, 1, -1, 1, [=](double u, double v) {
        // Normals along sign · z.
        return sign > 0 ? Vec3{u, v, height} : Vec3{v, u, height};
    });
}

TEST(IsValid, PlanesAndTheirNormals) {
    const Soup up = sheet(0, 1);
    EXPECT_TRUE(valid_everywhere(plane({0, 0, 1}, 0), up, true));
    EXPECT_TRUE(valid_everywhere(plane({0, 0, -1}, 0), up, false));
    Soup mixed = up;
    mixed.append(sheet(0, -1));
    EXPECT_TRUE(valid_everywhere(plane({0, 0, 1}, 0), mixed, false));
}

TEST(IsValid, OneNormalInAThousandMayBeWrong) {
    Soup soup = test::patch(30, -1, 1, -1, 1, [](double u, double v) { return Vec3{u, v, 0}; });
    soup.normals[5] = -soup.normals[5];
    EXPECT_TRUE(is_valid(plane_proxy({}, {0, 0, 1}), soup.view()));
    for (std::size_t t = 0; t < 40; ++t) soup.normals[t] = {0, 0, -1};
    EXPECT_FALSE(is_valid(plane_proxy({}, {0, 0, 1}), soup.view()));
}

TEST(IsValid, ConnectedQuadrics) {
    EXPECT_TRUE(valid_everywhere({-1, 0, 0, 0, 1, 0, 0, 1, 0, 1}, test::ellipsoid_patch(10, 1, 1, 1), true));
    EXPECT_TRUE(valid_everywhere({-1, 0, 0, 0, 1, 0, 0, 1, 0, 0}, test::cylinder_patch(12, 1, 6.283185307), true));
    EXPECT_TRUE(valid_everywhere({0, 0, 0, 1, 0, -0.4, 0, 0, 0, 0}, test::saddle_patch(), true));
    // A long thin pin: its radius is far below the size of the region, yet it is no line.
    const Soup pin = test::patch(24, 0, 6.283185307, 0, 1, [](double u, double v) {
        return Vec3{0.002 * std::cos(u), 0.002 * std::sin(u), v};
    });
    EXPECT_TRUE(valid_everywhere({-4e-6, 0, 0, 0, 1, 0, 0, 1, 0, 0}, pin, true));
}

TEST(IsValid, PairOfCrossingPlanes) {
    // z (z + x) = 0 on a crease: oriented along the normals of both halves, E = 0, and no surface for it.
    const Soup crease = test::crease_patch();
    const Coefficients pair = {0, 0, 0, 0, 0, 0, 1, 0, 0, 1};
    Coefficients oriented = pair;
    if (dot(gradient(pair, Vec3{-0.5, 0, 0}), crease.normals[0]) < 0) {
        for (double& v : oriented) v = -v;
    }
    EXPECT_TRUE(valid_everywhere(oriented, crease, false));
    // One of the two planes alone is fine.
    const Soup half = test::patch(6, -1, -0.2, -1, 1, [](double u, double v) { return Vec3{u, v, 0}; });
    EXPECT_TRUE(valid_everywhere({0, 0, 0, 0, 0, 0, -1, 0, 0, -1}, half, true));
}

TEST(IsValid, ParallelPlanes) {
    // z² = 1/4 with outward normals on both.
    Soup slab = sheet(0.5, 1);
    const Coefficients planes = {-0.25, 0, 0, 0, 0, 0, 0, 0, 0, 1};
    EXPECT_TRUE(valid_everywhere(planes, slab, true));
    slab.append(sheet(-0.5, -1));
    EXPECT_TRUE(valid_everywhere(planes, slab, false));
}

TEST(IsValid, HyperboloidOfTwoSheets) {
    const auto cap = [](double sign) {
        return test::patch(8, -0.7, 0.7, -0.7, 0.7, [sign](double u, double v) {
            const double z = sign * std::sqrt(0.1 + u * u + v * v);
            return sign > 0 ? Vec3{u, v, z} : Vec3{v, u, z};
        });
    };
    const Coefficients two_sheets = {-0.1, 0, 0, 0, -1, 0, 0, -1, 0, 1};
    Soup soup = cap(1);
    EXPECT_TRUE(valid_everywhere(two_sheets, soup, true));
    soup.append(cap(-1));
    EXPECT_TRUE(valid_everywhere(two_sheets, soup, false));
}

TEST(IsValid, NappesOfACone) {
    const Coefficients cone = {0, 0, 0, 0, -1, 0, 0, -1, 0, 1};  // the patch looks inwards
    Soup soup = test::cone_patch();
    EXPECT_TRUE(valid_everywhere(cone, soup, true));
    soup.append(test::patch(12, 0, 1.5, 0.3, 1, [](double u, double h) {
        return Vec3{h * std::sin(u), h * std::cos(u), h};
    }));
    EXPECT_TRUE(valid_everywhere(cone, soup, false));
}

TEST(IsValid, HyperbolicCylinder) {
    const auto branch = [](double sign) {
        return test::patch(8, -1, 1, -1, 1, [sign](double u, double v) {
            const double z = sign * std::sqrt(0.2 + u * u);
            return sign > 0 ? Vec3{u, v, z} : Vec3{-u, v, z};
        });
    };
    const Coefficients cylinder = {-0.2, 0, 0, 0, -1, 0, 0, 0, 0, 1};
    Soup soup = branch(1);
    EXPECT_TRUE(valid_everywhere(cylinder, soup, true));
    soup.append(branch(-1));
    EXPECT_TRUE(valid_everywhere(cylinder, soup, false));
}

TEST(IsValid, ImaginaryQuadrics) {
    const Soup soup = sheet(0.5, 1);
    EXPECT_TRUE(valid_everywhere({0.1, 0, 0, 0, 0.1, 0, 0, 0.1, 0, 1}, soup, false));
    EXPECT_TRUE(valid_everywhere({0.1, 0, 0, 0, 0, 0, 0, 0.3, 0, 1}, soup, false));
    EXPECT_TRUE(valid_everywhere({0.1, 0, 0, 0, 0, 0, 0, 0, 0, 1}, soup, false));
}

TEST(IsValid, PaperFitOfACreaseIsNotAcceptedAsAPair) {
    const Soup crease = test::crease_patch();
    const RegionFit best = fit_region(crease.view(), {});
    EXPECT_TRUE(best.valid);
    EXPECT_GT(best.total, 1e-2);
    EXPECT_EQ(best.valid, is_valid(best.proxy, crease.view()));
}

TEST(IsValid, AgreesWithTheFitsOwnCheck) {
    Random random(8);
    int invalid = 0;
    for (int round = 0; round < 100; ++round) {
        Soup soup;
        for (int k = 0; k < 12; ++k) soup.add(random.vector(1), random.vector(1), random.vector(1));
        RegionFitOptions options;
        options.best_of = round % 2 == 0;
        const RegionFit fit = fit_region(soup.view(), options);
        EXPECT_EQ(fit.valid, is_valid(fit.proxy, soup.view())) << round;
        invalid += !fit.valid;
    }
    EXPECT_GT(invalid, 10);
}

}  // namespace
}  // namespace quadseg::quadric
