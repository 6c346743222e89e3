#include "mesh/features.h"

#include <quadseg/error.h>

#include "runtime/parallel.h"
#include "tests/mesh/shapes.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

namespace quadseg::test {
namespace {

using mesh::WorkMesh;

struct Profile {
    std::vector<std::array<double, 2>> points;  ///< counter-clockwise
};

Profile regular_polygon(int n, double radius) {
    Profile p;
    for (int i = 0; i < n; ++i) {
        p.points.push_back({radius * std::cos(2 * M_PI * i / n), radius * std::sin(2 * M_PI * i / n)});
    }
    return p;
}

/// Prism over the profile with closed ends (a fan about the centre), `rows` of quads along its height.
Shape prism(const Profile& profile, double height, std::uint32_t rows = 1, double top_scale = 1) {
    Shape s;
    const auto n = static_cast<std::uint32_t>(profile.points.size());
    Vec3 centre;
    for (const auto& p : profile.points) centre += Vec3{p[0], p[1], 0} / static_cast<double>(n);
    for (std::uint32_t r = 0; r <= rows; ++r) {
        const double t = static_cast<double>(r) / rows, scale = 1 + t * (top_scale - 1);
        for (const auto& p : profile.points) s.vertex(p[0] * scale, p[1] * scale, t * height);
    }
    for (std::uint32_t r = 0; r < rows; ++r) {
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t a = r * n + i, b = r * n + (i + 1) % n;
            s.quad(a, b, b + n, a + n);
        }
    }
    const auto bottom = s.vertex(centre.x, centre.y, 0),
               top = s.vertex(centre.x * top_scale, centre.y * top_scale, height);
    for (std::uint32_t i = 0; i < n; ++i) {
        s.face(bottom, (i + 1) % n, i);
        s.face(top, rows * n + i, rows * n + (i + 1) % n);
    }
    return s;
}

Shape turned_inside_out(Shape s) {
    for (std::size_t f = 0; f < s.faces(); ++f) std::swap(s.triangles[3 * f + 1], s.triangles[3 * f + 2]);
    return s;
}

std::size_t feature_count(const Shape& s, double degrees = 30) {
    const WorkMesh m = build(s);
    const runtime::RunControl control(nullptr);
    const mesh::FeatureEdges features = mesh::find_feature_edges(m, degrees, control);
    for (std::size_t f = 0; f < m.face_count(); ++f) {
        for (std::size_t k = 0; k < 3; ++k) {
            const bool set = (features[f] >> k & 1U) != 0;
            if (m.neighbors[f][k] == mesh::no_face) {
                EXPECT_FALSE(set);
                continue;
            }
            const auto g = static_cast<std::size_t>(m.neighbors[f][k]);
            EXPECT_EQ(set, (features[g] >> mesh::matching_edge(m, f, k) & 1U) != 0);
        }
    }
    return mesh::count_feature_edges(features);
}

TEST(Features, CubeHasTwelve) {
    EXPECT_EQ(feature_count(cube()), 12U);
    EXPECT_EQ(feature_count(cube(), 89), 12U);
    EXPECT_EQ(feature_count(cube(), 91), 0U);
    EXPECT_EQ(feature_count(cube(), 0), 0U);
}

TEST(Features, ShaftsAndHolesOfFewFacetsAreSmooth) {
    for (const int n : {8, 10, 11, 12, 16, 24, 32}) {
        for (const double height : {0.05, 1.0, 20.0}) {
            for (const std::uint32_t rows : {1U, 3U}) {
                const Shape s = prism(regular_polygon(n, 1), height, rows);
                const auto rims = static_cast<std::size_t>(2 * n);
                EXPECT_EQ(feature_count(s), rims) << n << " facets, height " << height;
                EXPECT_EQ(feature_count(turned_inside_out(s)), rims) << n << " facets, hole, height " << height;
                EXPECT_EQ(feature_count(s, 10), rims) << n << " facets, 10 degrees";
            }
        }
    }
}

TEST(Features, NutsAndBarsAreSharp) {
    for (const int n : {3, 4, 5, 6, 7}) {
        EXPECT_EQ(feature_count(prism(regular_polygon(n, 1), 0.7)), static_cast<std::size_t>(3 * n)) << n;
    }
}

TEST(Features, CoarseConesAreSmooth) {
    for (const int n : {8, 10, 12}) {
        for (const double top : {0.2, 0.5, 0.9}) {
            for (const double height : {0.15, 0.6, 3.0}) {
                const Shape s = prism(regular_polygon(n, 1), height, 1, top);
                EXPECT_EQ(feature_count(s, 15) % static_cast<std::size_t>(n), 0U);
                EXPECT_LE(feature_count(s, 15), static_cast<std::size_t>(2 * n))
                    << n << " top " << top << " height " << height;
            }
        }
        Shape pointed;  // apex
        for (const auto& p : regular_polygon(n, 1).points) pointed.vertex(p[0], p[1], 0);
        const auto count = static_cast<std::uint32_t>(n);
        const auto apex = pointed.vertex(0, 0, 2), base = pointed.vertex(0, 0, 0);
        for (std::uint32_t i = 0; i < count; ++i) {
            pointed.face(i, (i + 1) % count, apex);
            pointed.face(base, (i + 1) % count, i);
        }
        EXPECT_EQ(feature_count(pointed, 20), static_cast<std::size_t>(n)) << n;
    }
}

/// Square bar whose corners are replaced: `facets` = 1: a chamfer; more: a fillet with vertices on the arc.
Profile bar_with_corners(double half, double radius, int facets) {
    Profile p;
    for (int corner = 0; corner < 4; ++corner) {
        const double from = M_PI / 2 * corner;
        const double cx = (corner == 0 || corner == 3 ? 1 : -1) * (half - radius);
        const double cy = (corner < 2 ? 1 : -1) * (half - radius);
        for (int i = 0; i <= facets; ++i) {
            const double t = from + M_PI / 2 * i / facets;
            p.points.push_back({cx + radius * std::cos(t), cy + radius * std::sin(t)});
        }
    }
    return p;
}

TEST(Features, SingleChamfersAreSharpOnBothSides) {
    for (const double width : {0.02, 0.1, 0.3}) {
        const Profile p = bar_with_corners(1, width, 1);
        EXPECT_EQ(feature_count(prism(p, 3)), 3 * p.points.size()) << width;
    }
}

TEST(Features, QuarterFilletsAreSmooth) {
    for (const int facets : {2, 3, 4, 6}) {
        for (const double radius : {0.1, 0.4}) {
            const Profile p = bar_with_corners(1, radius, facets);
            EXPECT_EQ(feature_count(prism(p, 3), 20), 2 * p.points.size() + (facets == 2 ? 8U : 0U))
                << facets << " " << radius;
            EXPECT_EQ(feature_count(prism(p, 3), 29), 2 * p.points.size()) << facets << " " << radius;
        }
    }
}

TEST(Features, TeethAlternateAndAreSharp) {
    Profile p;
    for (int i = 0; i < 24; ++i) {
        const double r = i % 2 ? 1 : 1.12, t = 2 * M_PI * i / 24;
        p.points.push_back({r * std::cos(t), r * std::sin(t)});
    }
    EXPECT_EQ(feature_count(prism(p, 1)), 24U * 3);
}

TEST(Features, FacetsCutIntoManyFacesAreWalkedOver) {
    for (const int n : {8, 12}) {
        Profile p;  // each side of the polygon in five pieces
        const Profile corners = regular_polygon(n, 1);
        for (std::size_t i = 0; i < corners.points.size(); ++i) {
            const auto a = corners.points[i], b = corners.points[(i + 1) % corners.points.size()];
            for (int j = 0; j < 5; ++j)
                p.points.push_back({a[0] + (b[0] - a[0]) * j / 5, a[1] + (b[1] - a[1]) * j / 5});
        }
        EXPECT_EQ(feature_count(prism(p, 1, 7), 25), 2 * p.points.size()) << n;
    }
}

TEST(Features, FacesWithoutAreaHideNoCrease) {
    // The middle of a cube's edge is a corner of one side only: a face without area closes the gap.
    Shape s = cube();
    const auto middle = s.vertex(0.5, 0, 0);
    ASSERT_EQ(s.triangles[12], 0U);  // face 4: (0, 1, 5)
    ASSERT_EQ(s.triangles[13], 1U);
    s.triangles[13] = middle;
    s.face(middle, 1, 5);
    s.face(0, 1, middle);
    const WorkMesh m = build(s);
    ASSERT_EQ(m.report.border_edges, 0U);
    ASSERT_EQ(m.report.degenerate_faces, 1U);
    EXPECT_EQ(feature_count(s), 13U);  // one of the twelve has two pieces
    std::size_t groups = 0;
    const auto features = mesh::find_feature_edges(m, 30, runtime::RunControl(nullptr));
    mesh::feature_groups(m, features, groups);
    EXPECT_EQ(groups, 6U);
}

TEST(Features, GroupsAreTheSidesByFirstFace) {
    const WorkMesh m = build(prism(regular_polygon(10, 1), 1));
    const auto features = mesh::find_feature_edges(m, 30, runtime::RunControl(nullptr));
    std::size_t groups = 0;
    const auto group = mesh::feature_groups(m, features, groups);
    EXPECT_EQ(groups, 3U);
    std::int32_t next = 0;
    for (std::size_t f = 0; f < m.face_count(); ++f) {
        ASSERT_LE(group[f], next);
        next = std::max(next, group[f] + 1);
        for (std::size_t k = 0; k < 3; ++k) {
            if ((features[f] >> k & 1U) == 0) {
                EXPECT_EQ(group[f], group[static_cast<std::size_t>(m.neighbors[f][k])]);
            }
        }
    }
}

TEST(Features, SameAtAnyNumberOfThreads) {
    const Shape s = joined(bumpy_grid(120), prism(regular_polygon(9, 30), 10, 40));
    const WorkMesh m = build(s);
    const runtime::RunControl control(nullptr);
    const tbb::global_control more_than_cores(tbb::global_control::max_allowed_parallelism, 8);
    mesh::FeatureEdges one, many;
    runtime::in_arena(1, [&] { one = mesh::find_feature_edges(m, 8, control); });
    EXPECT_GT(mesh::count_feature_edges(one), 0U);
    for (const int threads : {2, 8}) {
        runtime::in_arena(threads, [&] { many = mesh::find_feature_edges(m, 8, control); });
        EXPECT_EQ(many, one);
    }
}

TEST(Inspect, CountsFeaturesAndStops) {
    const Shape s = cube();
    EXPECT_EQ(inspect(s.view()).feature_edges, 12U);
    EXPECT_EQ(inspect(s.view(), 0).feature_edges, 0U);
    Context context;
    context.cancel();
    try {
        inspect(s.view(), 30, &context);
        FAIL() << "no error";
    } catch (const Error& e) {
        EXPECT_EQ(e.code(), ErrorCode::cancelled);
    }
}

}  // namespace
}  // namespace quadseg::test
