// Small triangulated patches and repeatable random numbers for the tests of quadric/.
#pragma once

#include "math/vec3.h"
#include "quadric/moments.h"
#include "quadric/region_fit.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace quadseg::quadric::test {

/// splitmix64
class Random {
  public:
    explicit Random(std::uint64_t seed) : state_(seed) {}
    double uniform(double low, double high) {
        state_ += 0x9e3779b97f4a7c15U;
        std::uint64_t z = state_;
        z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
        z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
        return low + (high - low) * static_cast<double>((z ^ (z >> 31U)) >> 11U) * 0x1p-53;
    }
    Vec3 vector(double size) { return {uniform(-size, size), uniform(-size, size), uniform(-size, size)}; }
    Vec3 direction() {
        for (;;) {
            const Vec3 v = vector(1);
            if (squared_norm(v) > 0.01 && squared_norm(v) < 1) return normalized(v);
        }
    }

  private:
    std::uint64_t state_;
};

struct Rotation {
    Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};  // images of the axes
    Vec3 operator*(const Vec3& v) const { return x * v.x + y * v.y + z * v.z; }
};
inline Rotation random_rotation(Random& random) {
    Rotation r;
    r.z = random.direction();
    r.x = any_perpendicular(r.z);
    r.y = cross(r.z, r.x);
    const double angle = random.uniform(0, 6.28);
    const Vec3 x = r.x * std::cos(angle) + r.y * std::sin(angle);
    r.x = x;
    r.y = cross(r.z, x);
    return r;
}

struct Soup {
    std::vector<Vec3> corners, normals;
    std::vector<double> areas;

    TriangleSoup view() const { return {corners, normals, areas}; }
    std::size_t size() const { return areas.size(); }
    double area() const {
        double sum = 0;
        for (const double a : areas) sum += a;
        return sum;
    }
    void add(const Vec3& a, const Vec3& b, const Vec3& c) {
        const Vec3 n = cross(b - a, c - a);
        corners.insert(corners.end(), {a, b, c});
        normals.push_back(normalized(n));
        areas.push_back(norm(n) / 2);
    }
    void append(const Soup& other) {
        corners.insert(corners.end(), other.corners.begin(), other.corners.end());
        normals.insert(normals.end(), other.normals.begin(), other.normals.end());
        areas.insert(areas.end(), other.areas.begin(), other.areas.end());
    }
    template <class Map>
    Soup mapped(const Map& map) const {
        Soup result;
        for (std::size_t t = 0; t < size(); ++t) {
            result.add(map(corners[3 * t]), map(corners[3 * t + 1]), map(corners[3 * t + 2]));
        }
        return result;
    }
    Moments moments(const Vec3& origin) const {
        Moments m;
        for (std::size_t t = 0; t < size(); ++t) {
            accumulate(m, corners[3 * t] - origin, corners[3 * t + 1] - origin, corners[3 * t + 2] - origin, normals[t],
                       areas[t]);
        }
        return m;
    }
    /// Exact normals of the surface in place of the facets'.
    template <class Normal>
    Soup with_normals(const Normal& normal) const {
        Soup result = *this;
        for (std::size_t t = 0; t < size(); ++t) {
            result.normals[t] = normal((corners[3 * t] + corners[3 * t + 1] + corners[3 * t + 2]) / 3.0);
        }
        return result;
    }
};

/// point(u, v) over [u0, u1] × [v0, v1] in n × n squares of two triangles.
template <class Point>
Soup patch(int n, double u0, double u1, double v0, double v1, const Point& point) {
    Soup soup;
    const auto at = [&](int i, int j) { return point(u0 + (u1 - u0) * i / n, v0 + (v1 - v0) * j / n); };
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            soup.add(at(i, j), at(i + 1, j), at(i + 1, j + 1));
            soup.add(at(i, j), at(i + 1, j + 1), at(i, j + 1));
        }
    }
    return soup;
}

inline Soup plane_patch(int n = 6) {
    return patch(n, -1, 1, -1, 1, [](double u, double v) { return Vec3{u, v, 0.3 * u - 0.2 * v}; });
}
inline Soup cylinder_patch(int n = 12, double radius = 1, double u1 = 1.5) {
    return patch(n, 0, u1, 0, 1, [radius](double u, double v) {
        return Vec3{radius * std::cos(u), radius * std::sin(u), radius * v};
    });
}
inline Soup ellipsoid_patch(int n, double a, double b, double c) {
    return patch(n, 0, 1.2, -0.5, 0.6, [=](double u, double v) {
        return Vec3{a * std::cos(u) * std::cos(v), b * std::sin(u) * std::cos(v), c * std::sin(v)};
    });
}
inline Soup cone_patch(int n = 12, double low = 0.3, double high = 1) {
    return patch(n, 0, 1.5, low, high, [](double u, double h) { return Vec3{h * std::cos(u), h * std::sin(u), -h}; });
}
inline Soup saddle_patch(int n = 12) {
    return patch(n, -1, 1, -1, 1, [](double u, double v) { return Vec3{u, v, 0.4 * u * v}; });
}
inline Soup crease_patch(int n = 6) {
    Soup soup = patch(n, -1, 0, -1, 1, [](double u, double v) { return Vec3{u, v, 0}; });
    soup.append(patch(n, 0, 1, -1, 1, [](double u, double v) { return Vec3{u, v, -u}; }));
    return soup;
}

}  // namespace quadseg::quadric::test
