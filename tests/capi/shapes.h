// Small meshes for the C interface.
#pragma once

#include <quadseg/quadseg.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

namespace quadseg::capi_test {

struct Arrays {
    std::vector<double> positions;
    std::vector<std::uint32_t> triangles;

    quadseg_mesh_view view() const {
        quadseg_mesh_view v{};
        v.struct_size = sizeof v;
        v.positions = positions.data();
        v.vertex_count = positions.size() / 3;
        v.triangles = triangles.data();
        v.face_count = triangles.size() / 3;
        return v;
    }
};

/// A closed cylinder: side of `segments` × `rows` quads, two flat lids.
inline Arrays can(std::uint32_t segments = 24, std::uint32_t rows = 8) {
    Arrays a;
    for (std::uint32_t r = 0; r <= rows; ++r) {
        for (std::uint32_t s = 0; s < segments; ++s) {
            const double angle = 2 * std::numbers::pi * s / segments;
            a.positions.insert(a.positions.end(), {std::cos(angle), std::sin(angle), 3.0 * r / rows});
        }
    }
    const auto at = [&](std::uint32_t r, std::uint32_t s) { return r * segments + s % segments; };
    for (std::uint32_t r = 0; r < rows; ++r) {
        for (std::uint32_t s = 0; s < segments; ++s) {
            a.triangles.insert(a.triangles.end(), {at(r, s), at(r, s + 1), at(r + 1, s + 1)});
            a.triangles.insert(a.triangles.end(), {at(r, s), at(r + 1, s + 1), at(r + 1, s)});
        }
    }
    const auto bottom = static_cast<std::uint32_t>(a.positions.size() / 3), top = bottom + 1;
    a.positions.insert(a.positions.end(), {0, 0, 0, 0, 0, 3});
    for (std::uint32_t s = 0; s < segments; ++s) {
        a.triangles.insert(a.triangles.end(), {bottom, at(0, s + 1), at(0, s)});
        a.triangles.insert(a.triangles.end(), {top, at(rows, s), at(rows, s + 1)});
    }
    return a;
}

}  // namespace quadseg::capi_test
