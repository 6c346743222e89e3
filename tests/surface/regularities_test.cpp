// Parallel, perpendicular, coaxial, coplanar, concentric and equal-radius groups, and snapping to them.
#include "surface/regularities.h"

#include "surface/surface.h"
#include "surface_samples.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace quadseg::surface {
namespace {

using namespace samples;
using Kind = Regularity::Kind;

RegularSurface item(const Surface& s, std::int32_t region, const Vec3& centroid, double area = 1, double noise = 1e-6) {
    RegularSurface r;
    r.surface = s;
    r.surface.coefficients = to_coefficients(s);
    r.region = region;
    r.area = area;
    r.centroid = centroid;
    r.extent = 1;
    r.noise = noise;
    return r;
}

std::vector<std::vector<std::int32_t>> groups_of(const RegularityResult& r, Kind kind) {
    std::vector<std::vector<std::int32_t>> found;
    for (const Regularity& g : r.groups)
        if (g.kind == kind) found.push_back(g.regions);
    return found;
}

/// Direction off by an angle the noise allows.
Vec3 off(const Vec3& v, double angle, Random& random) {
    return normalized(v + angle * random.direction());
}

/// A block with two coaxial holes of one radius, a ball and a torus around one centre, all slightly off.
std::vector<RegularSurface> part(double error) {
    Random random(3);
    const Vec3 x = normalized({1, 2, 3}), y = any_perpendicular(x), z = cross(x, y);
    auto near = [&](const Vec3& p) { return p + .5 * error * random.direction(); };
    std::vector<RegularSurface> part;
    part.push_back(item(plane(near({0, 0, 0}), off(z, error, random)), 0, {0, 0, 0}, 9));
    part.push_back(item(plane(near(2.0 * z), off(-z, error, random)), 1, 2.0 * z, 8));
    part.push_back(item(plane(near(3.0 * x), off(x, error, random)), 2, 3.0 * x, 5));
    part.push_back(item(plane(near(3.0 * x + 2.5 * y), off(x, error, random)), 3, 3.0 * x + 2.5 * y, 4));
    part.push_back(item(cylinder(near(x), off(z, error, random), .5 + .3 * error), 4, x, 2));
    part.push_back(item(cylinder(near(x + 2.0 * z), off(-z, error, random), .5 - .3 * error), 5, x + 2.0 * z, 2));
    part.push_back(item(cone(near(x - 1.0 * z), off(z, error, random), .7), 6, x, 1));
    part.push_back(item(sphere(near(y), .3), 7, y, 1));
    part.push_back(item(torus(near(y), off(z, error, random), 1, .3), 8, y, 1));
    part.push_back(item(plane({0, 0, 0}, normalized(x + z)), 9, {0, 0, 0}, .5));
    return part;
}

TEST(Regularities, GroupsOfAPart) {
    const auto surfaces = part(1e-6);
    const RegularityResult r = find_regularities(surfaces);
    using Groups = std::vector<std::vector<std::int32_t>>;
    EXPECT_EQ(groups_of(r, Kind::parallel), (Groups{{0, 1, 4, 5, 6, 8}, {2, 3}}));
    EXPECT_EQ(groups_of(r, Kind::perpendicular), (Groups{{0, 2}}));
    EXPECT_EQ(groups_of(r, Kind::coaxial), (Groups{{4, 5, 6}}));
    EXPECT_EQ(groups_of(r, Kind::coplanar), (Groups{{2, 3}}));
    EXPECT_EQ(groups_of(r, Kind::concentric), (Groups{{7, 8}}));
    EXPECT_EQ(groups_of(r, Kind::equal_radius), (Groups{{4, 5}}));
}

TEST(Regularities, SnappedSurfacesAreExactAndNear) {
    const auto surfaces = part(1e-6);
    const RegularityResult r = find_regularities(surfaces);
    auto axis = [&](std::size_t i) { return to_vec3(r.snapped[i].axis); };
    for (std::size_t i : {1, 4, 5, 6, 8}) EXPECT_LT(norm(cross(axis(0), axis(i))), 1e-15) << i;
    EXPECT_LT(std::abs(dot(axis(0), axis(2))), 1e-15);
    EXPECT_EQ(r.snapped[4].radius, r.snapped[5].radius);
    for (std::size_t i : {5, 6}) {
        const Vec3 u = to_vec3(r.snapped[i].point) - to_vec3(r.snapped[4].point);
        EXPECT_LT(norm(cross(u, axis(4))), 1e-14);
    }
    EXPECT_LT(std::abs(dot(to_vec3(r.snapped[3].point) - to_vec3(r.snapped[2].point), axis(2))), 1e-14);
    EXPECT_EQ(r.snapped[7].point, r.snapped[8].point);
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        EXPECT_GT(dot(axis(i), to_vec3(surfaces[i].surface.axis)), .999);
        // Near its region a snapped surface has hardly moved.
        Random random(i);
        for (int k = 0; k < 20; ++k) {
            const Vec3 p = foot_point(surfaces[i].surface, surfaces[i].centroid + random.direction());
            EXPECT_LT(std::abs(signed_distance(r.snapped[i], p)), 2e-5) << i;
            if (r.snapped[i].type <= SurfaceType::cone) {
                EXPECT_NEAR(quadric::value(r.snapped[i].coefficients, foot_point(r.snapped[i], p)), 0, 1e-12);
            }
        }
    }
}

TEST(Regularities, NothingIsFoundBeyondTheUncertainty) {
    const RegularityResult r = find_regularities(part(1e-3));
    EXPECT_TRUE(groups_of(r, Kind::coaxial).empty());
    EXPECT_TRUE(groups_of(r, Kind::coplanar).empty());
    EXPECT_TRUE(groups_of(r, Kind::equal_radius).empty());
    EXPECT_TRUE(groups_of(r, Kind::perpendicular).empty());
    // With noise as large as the errors they are found again.
    auto noisy = part(1e-3);
    for (RegularSurface& s : noisy) s.noise = 1e-3;
    RegularityOptions options;
    options.most_length_share = 1e-2;
    const RegularityResult n = find_regularities(noisy, options);
    EXPECT_EQ(groups_of(n, Kind::coaxial).size(), 1u);
    EXPECT_EQ(groups_of(n, Kind::perpendicular).size(), 1u);
}

TEST(Regularities, OrderOfInputDoesNotMatter) {
    auto surfaces = part(1e-6);
    for (std::size_t i = 0; i < surfaces.size(); ++i) surfaces[i].area += .01 * double(i);  // no ties
    const RegularityResult a = find_regularities(surfaces);
    std::reverse(surfaces.begin(), surfaces.end());
    const RegularityResult b = find_regularities(surfaces);
    ASSERT_EQ(a.groups.size(), b.groups.size());
    for (std::size_t i = 0; i < a.groups.size(); ++i) {
        EXPECT_EQ(a.groups[i].regions, b.groups[i].regions);
        EXPECT_EQ(int(a.groups[i].kind), int(b.groups[i].kind));
    }
    for (std::size_t i = 0; i < surfaces.size(); ++i)
        EXPECT_EQ(a.snapped[i].axis, b.snapped[surfaces.size() - 1 - i].axis);
}

TEST(Regularities, EmptyAndOddInputs) {
    EXPECT_TRUE(find_regularities({}).groups.empty());
    std::vector<RegularSurface> odd(3);
    odd[1].surface.type = SurfaceType::freeform;
    odd[2].surface.axis = {std::nan(""), 0, 0};
    EXPECT_EQ(find_regularities(odd).snapped.size(), 3u);
}

TEST(SurfaceIds, EqualSurfacesShareAnId) {
    const Surface tube = cylinder({0, 0, 0}, {0, 0, 1}, .5);
    Surface same = cylinder({0, 0, 7}, {0, 0, -1}, .5 + 1e-9), thicker = cylinder({0, 0, 0}, {0, 0, 1}, .51);
    const Surface flat = plane({0, 0, 1}, {0, 0, 1}), higher = plane({0, 0, 1.1}, {0, 0, 1});
    const Patch a = grid(tube, {0, 1, 5}, {0, 1, 3}), b = grid(same, {2, 3, 5}, {0, 1, 3}),
                c = grid(thicker, {0, 1, 5}, {0, 1, 3}), d = grid(flat, {0, 1, 3}, {0, 1, 3}),
                e = grid(higher, {0, 1, 3}, {0, 1, 3});
    const std::vector<SurfacePoints> regions = {{flat, d.points, 1e-8},   {tube, a.points, 1e-8},
                                                {same, b.points, 1e-8},   {thicker, c.points, 1e-8},
                                                {higher, e.points, 1e-8}, {flat, d.points, 1e-8}};
    EXPECT_EQ(surface_ids(regions), (std::vector<std::int32_t>{0, 1, 1, 3, 4, 0}));
    EXPECT_NEAR(max_distance(thicker, a.points), .01, 1e-12);
}

}  // namespace
}  // namespace quadseg::surface
