// Solids whose surfaces anyone can count.
#pragma once

#include "tests/mesh/shapes.h"
#include "tests/partition/box.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace quadseg::test {

/// Closed solid of revolution: rings of `sectors` vertices at (radius, height), bottom first, closed by flat fans. A
/// radius of 0 is a pole.
inline Shape turned(const std::vector<std::array<double, 2>>& profile, std::uint32_t sectors) {
    Shape s;
    const double pi = std::acos(-1.0);
    std::vector<std::vector<std::uint32_t>> rings;
    const auto add_ring = [&](double r, double z) {
        std::vector<std::uint32_t> ring;
        if (!(r > 0)) {
            ring.assign(sectors, s.vertex(0, 0, z));
        } else {
            for (std::uint32_t i = 0; i < sectors; ++i) {
                const double t = 2 * pi * i / sectors;
                ring.push_back(s.vertex(r * std::cos(t), r * std::sin(t), z));
            }
        }
        rings.push_back(ring);
    };
    if (profile.front()[0] > 0) add_ring(0, profile.front()[1]);
    for (const auto& [r, z] : profile) add_ring(r, z);
    if (profile.back()[0] > 0) add_ring(0, profile.back()[1]);
    for (std::size_t j = 0; j + 1 < rings.size(); ++j) {
        for (std::uint32_t i = 0; i < sectors; ++i) {
            const std::uint32_t a = rings[j][i], b = rings[j][(i + 1) % sectors];
            const std::uint32_t c = rings[j + 1][(i + 1) % sectors], d = rings[j + 1][i];
            if (a != b) s.face(a, b, c);
            if (c != d) s.face(a, c, d);
        }
    }
    return s;
}

inline Shape can(std::uint32_t sectors, std::uint32_t rows, double radius = 1, double height = 2) {
    std::vector<std::array<double, 2>> profile;
    for (std::uint32_t j = 0; j <= rows; ++j) profile.push_back({radius, height * j / rows});
    return turned(profile, sectors);
}

inline Shape frustum(std::uint32_t sectors, std::uint32_t rows) {
    std::vector<std::array<double, 2>> profile;
    for (std::uint32_t j = 0; j <= rows; ++j) profile.push_back({2 - 1.0 * j / rows, 1.5 * j / rows});
    return turned(profile, sectors);
}

inline Shape ball(std::uint32_t sectors, std::uint32_t rings) {
    const double pi = std::acos(-1.0);
    std::vector<std::array<double, 2>> profile;
    for (std::uint32_t j = 0; j <= rings; ++j) {
        const double a = pi * j / rings;
        profile.push_back({j == 0 || j == rings ? 0 : std::sin(a), -std::cos(a)});
    }
    return turned(profile, sectors);
}

/// A square profile with a quarter missing, unit cells cut into n × n squares.
inline Shape l_block(std::uint32_t n) {
    Shape s;
    std::map<std::array<std::uint32_t, 3>, std::uint32_t> known;
    const auto vertex = [&](std::array<std::uint32_t, 3> p) {
        const auto [at, is_new] = known.try_emplace(p, static_cast<std::uint32_t>(s.positions.size() / 3));
        if (is_new) s.vertex(1.0 * p[0] / n, 1.0 * p[1] / n, 1.0 * p[2] / n);
        return at->second;
    };
    const auto solid = [](int x, int y, int z) {
        return x >= 0 && x < 2 && y >= 0 && y < 2 && z == 0 && !(x == 1 && y == 1);
    };
    for (int x = 0; x < 2; ++x) {
        for (int y = 0; y < 2; ++y) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                for (int side = 0; side < 2; ++side) {
                    std::array<int, 3> cell{x, y, 0}, beyond = cell;
                    beyond[axis] += side == 1 ? 1 : -1;
                    if (!solid(x, y, 0) || solid(beyond[0], beyond[1], beyond[2])) continue;
                    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
                    for (std::uint32_t j = 0; j < n; ++j) {
                        for (std::uint32_t i = 0; i < n; ++i) {
                            const auto corner = [&](std::uint32_t di, std::uint32_t dj) {
                                std::array<std::uint32_t, 3> p{};
                                p[axis] = (static_cast<std::uint32_t>(cell[axis]) + (side == 1 ? 1U : 0U)) * n;
                                p[u] = static_cast<std::uint32_t>(cell[u]) * n + i + di;
                                p[v] = static_cast<std::uint32_t>(cell[v]) * n + j + dj;
                                return vertex(p);
                            };
                            if (side == 1) {
                                s.quad(corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1));
                            } else {
                                s.quad(corner(0, 0), corner(0, 1), corner(1, 1), corner(1, 0));
                            }
                        }
                    }
                }
            }
        }
    }
    return s;
}

/// box(n) without its top.
inline Shape cup(std::uint32_t n) {
    const Shape closed = box(n);
    Shape s;
    s.positions = closed.positions;
    for (std::size_t f = 0; f < closed.faces(); ++f) {
        const std::uint32_t* v = &closed.triangles[3 * f];
        const auto top = [&](std::uint32_t i) { return closed.positions[3 * i + 2] > 1 - 1e-9; };
        if (!(top(v[0]) && top(v[1]) && top(v[2]))) s.face(v[0], v[1], v[2]);
    }
    return s;
}

}  // namespace quadseg::test
