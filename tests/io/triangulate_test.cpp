#include "io/faces.h"
#include "io_support.h"

#include <cmath>
#include <numeric>

namespace quadseg::test {
namespace {

/// Signed areas along z of the triangles of a polygon in the plane z = 0.
std::vector<double> areas(const std::vector<double>& outline) {
    const std::size_t n = outline.size() / 2;
    std::vector<double> positions;
    for (std::size_t i = 0; i < n; ++i) {
        // A tilted plane, so that no coordinate is special; areas are measured in x and y all the same.
        positions.insert(positions.end(),
                         {outline[2 * i], outline[2 * i + 1], 0.3 * outline[2 * i] - 0.2 * outline[2 * i + 1]});
    }
    std::vector<std::uint32_t> polygon(n), triangles(3 * (n - 2));
    std::iota(polygon.begin(), polygon.end(), 0U);
    io::Triangulator(positions).cut(polygon, triangles.data());
    std::vector<double> result;
    for (std::size_t t = 0; t < triangles.size(); t += 3) {
        const double* a = &outline[2 * triangles[t]];
        const double* b = &outline[2 * triangles[t + 1]];
        const double* c = &outline[2 * triangles[t + 2]];
        result.push_back(((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2);
    }
    return result;
}

void expect_proper(const std::vector<double>& outline, double area) {
    double sum = 0;
    for (const double a : areas(outline)) {
        EXPECT_GT(a * area, 0);
        sum += a;
    }
    EXPECT_NEAR(sum, area, 1e-12 * std::abs(area));
}

TEST(Triangulate, ConcavePolygonsAreCovered) {
    expect_proper({0, 0, 2, 0, 2, 1, 1, 1, 1, 2, 0, 2}, 3);                          // L
    expect_proper({0, 2, 1, 2, 1, 1, 2, 1, 2, 0, 0, 0}, -3);                         // L, clockwise
    expect_proper({0, 0, 1, -1, 0, 4, -1, -1}, 4);                                   // dart
    expect_proper({1, -1, 0, 4, -1, -1, 0, 0}, 4);                                   // the same, its reflex corner last
    expect_proper({0, 0, 4, 0, 4, 4, 2, 1, 0, 4}, 10);                               // notch
    expect_proper({2, 1, 0, 4, 0, 0, 4, 0, 4, 4}, 10);                               // the same, from its reflex corner
    expect_proper({0, 0, 1, 0, 2, 0, 2, 2, 1, 2, 0, 2}, 4);                          // straight corners
    expect_proper({0, 0, 3, 0, 3, 3, 0, 3, 0, 0, 1, 1, 1, 2, 2, 2, 2, 1, 1, 1}, 8);  // a hole, joined by a bridge
}

TEST(Triangulate, StarsOfAnySize) {
    for (const int n : {3, 5, 50, 1000}) {
        std::vector<double> outline;
        double area = 0;
        for (int i = 0; i < 2 * n; ++i) {
            const double r = i % 2 == 0 ? 2 : 0.7, angle = 3.14159265358979 * i / n;
            outline.insert(outline.end(), {r * std::cos(angle), r * std::sin(angle)});
        }
        for (std::size_t i = 0; i < outline.size(); i += 2) {
            const std::size_t j = (i + 2) % outline.size();
            area += (outline[i] * outline[j + 1] - outline[i + 1] * outline[j]) / 2;
        }
        double sum = 0;
        for (const double a : areas(outline)) {
            EXPECT_GT(a, 0);
            sum += a;
        }
        EXPECT_NEAR(sum, area, 1e-9 * area);
    }
}

TEST(Triangulate, DegeneratePolygonsGiveTheirNumberOfTriangles) {
    EXPECT_EQ(areas({0, 0, 1, 0, 2, 0, 3, 0, 4, 0}).size(), 3u);              // on a line
    EXPECT_EQ(areas({1, 1, 1, 1, 1, 1, 1, 1}).size(), 2u);                    // a point
    EXPECT_EQ(areas({0, 0, 1, 1, 1, 0, 0, 1}).size(), 2u);                    // crossing
    EXPECT_EQ(areas({0, 0, 1e300, 0, 1e300, 1e300, 0, 1e300}).size(), 2u);    // its area is infinite
    EXPECT_EQ(areas({0, 0, 1, 0, 1, 0, 1, 1, 0, 1, 0, 1, 0, 1}).size(), 5u);  // repeated corners
}

}  // namespace
}  // namespace quadseg::test
