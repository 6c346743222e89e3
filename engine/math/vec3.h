// Three-vectors of double. Nothing else of the project is needed to read this file.
#pragma once

#include <array>
#include <cmath>

namespace quadseg {

struct Vec3 {
    double x = 0, y = 0, z = 0;

    double& operator[](int i) noexcept { return i == 0 ? x : i == 1 ? y : z; }
    double operator[](int i) const noexcept { return i == 0 ? x : i == 1 ? y : z; }
    Vec3& operator+=(const Vec3& b) noexcept {
        x += b.x;
        y += b.y;
        z += b.z;
        return *this;
    }
    Vec3& operator-=(const Vec3& b) noexcept {
        x -= b.x;
        y -= b.y;
        z -= b.z;
        return *this;
    }
    Vec3& operator*=(double s) noexcept {
        x *= s;
        y *= s;
        z *= s;
        return *this;
    }
};

inline Vec3 operator+(const Vec3& a, const Vec3& b) noexcept {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vec3 operator-(const Vec3& a, const Vec3& b) noexcept {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vec3 operator-(const Vec3& a) noexcept {
    return {-a.x, -a.y, -a.z};
}
inline Vec3 operator*(const Vec3& a, double s) noexcept {
    return {a.x * s, a.y * s, a.z * s};
}
inline Vec3 operator*(double s, const Vec3& a) noexcept {
    return a * s;
}
inline Vec3 operator/(const Vec3& a, double s) noexcept {
    return {a.x / s, a.y / s, a.z / s};
}
inline bool operator==(const Vec3& a, const Vec3& b) noexcept {
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

inline double dot(const Vec3& a, const Vec3& b) noexcept {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vec3 cross(const Vec3& a, const Vec3& b) noexcept {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double squared_norm(const Vec3& a) noexcept {
    return dot(a, a);
}
inline double norm(const Vec3& a) noexcept {
    return std::sqrt(dot(a, a));
}
/// The zero vector stays zero.
inline Vec3 normalized(const Vec3& a) noexcept {
    const double n = norm(a);
    return n > 0 ? a / n : Vec3{};
}
inline std::array<double, 3> to_array(const Vec3& a) noexcept {
    return {a.x, a.y, a.z};
}
inline Vec3 to_vec3(const std::array<double, 3>& a) noexcept {
    return {a[0], a[1], a[2]};
}
/// Angle between two vectors in radians, accurate near 0 and π.
inline double angle_between(const Vec3& a, const Vec3& b) noexcept {
    return std::atan2(norm(cross(a, b)), dot(a, b));
}
/// A unit vector perpendicular to the unit vector a.
inline Vec3 any_perpendicular(const Vec3& a) noexcept {
    const double ax = std::abs(a.x), ay = std::abs(a.y), az = std::abs(a.z);
    const Vec3 e = ax <= ay && ax <= az ? Vec3{1, 0, 0} : ay <= az ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
    return normalized(cross(a, e));
}

}  // namespace quadseg
