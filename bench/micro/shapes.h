// Patches that the micro benchmarks of quadric/ run on.
#pragma once

#include "math/vec3.h"
#include "quadric/region_fit.h"

#include <cmath>
#include <cstddef>
#include <vector>

namespace quadseg::bench {

struct Patch {
    std::vector<Vec3> corners, normals;
    std::vector<double> areas;
    quadric::TriangleSoup soup() const { return {corners, normals, areas}; }
};

/// About `faces` triangles of an ellipsoid away from the origin: no model simpler than the general quadric fits.
inline Patch ellipsoid_patch(std::size_t faces) {
    const int n = static_cast<int>(std::sqrt(static_cast<double>(faces) / 2) + 0.5);
    const auto at = [n](int i, int j) {
        const double u = static_cast<double>(i) / n, v = static_cast<double>(j) / n - 0.5;
        return Vec3{0.3 + 0.3 * std::cos(u) * std::cos(v), 0.2 + 0.2 * std::sin(u) * std::cos(v),
                    -0.4 + 0.1 * std::sin(v)};
    };
    Patch patch;
    const auto add = [&patch](const Vec3& a, const Vec3& b, const Vec3& c) {
        const Vec3 n2 = cross(b - a, c - a);
        patch.corners.insert(patch.corners.end(), {a, b, c});
        patch.normals.push_back(normalized(n2));
        patch.areas.push_back(norm(n2) / 2);
    };
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            add(at(i, j), at(i + 1, j), at(i + 1, j + 1));
            add(at(i, j), at(i + 1, j + 1), at(i, j + 1));
        }
    }
    return patch;
}

}  // namespace quadseg::bench
