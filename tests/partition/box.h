// A box of n × n squares a side: six exact planes, known to the last face.
#pragma once

#include "mesh/work_mesh.h"
#include "partition/leaves.h"
#include "runtime/run_control.h"
#include "tests/mesh/shapes.h"

#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

namespace quadseg::test {

inline Shape box(std::uint32_t n, double x0 = 0) {
    Shape s;
    std::map<std::array<std::uint32_t, 3>, std::uint32_t> known;
    const auto vertex = [&](std::array<std::uint32_t, 3> p) {
        const auto [at, is_new] = known.try_emplace(p, static_cast<std::uint32_t>(s.positions.size() / 3));
        if (is_new) {
            s.vertex(x0 + static_cast<double>(p[0]) / n, static_cast<double>(p[1]) / n, static_cast<double>(p[2]) / n);
        }
        return at->second;
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::uint32_t side = 0; side < 2; ++side) {
            const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
            for (std::uint32_t j = 0; j < n; ++j) {
                for (std::uint32_t i = 0; i < n; ++i) {
                    const auto corner = [&](std::uint32_t di, std::uint32_t dj) {
                        std::array<std::uint32_t, 3> p{};
                        p[axis] = side * n;
                        p[u] = i + di;
                        p[v] = j + dj;
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
    return s;
}

/// Open cylinder of radius 1 and height 2, n facets round, with a flat disc on top: two surfaces.
inline Shape capped_cylinder(std::uint32_t n, std::uint32_t rows) {
    Shape s;
    const double pi = std::acos(-1.0);
    for (std::uint32_t j = 0; j <= rows; ++j) {
        for (std::uint32_t i = 0; i < n; ++i) {
            const double t = 2 * pi * i / n;
            s.vertex(std::cos(t), std::sin(t), 2.0 * j / rows);
        }
    }
    for (std::uint32_t j = 0; j < rows; ++j) {
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t k = (i + 1) % n;
            s.quad(j * n + i, j * n + k, (j + 1) * n + k, (j + 1) * n + i);
        }
    }
    const std::uint32_t centre = s.vertex(0, 0, 2);
    for (std::uint32_t i = 0; i < n; ++i) s.face(rows * n + i, rows * n + (i + 1) % n, centre);
    return s;
}

inline mesh::WorkMesh work_mesh(const Shape& s) {
    return mesh::build_work_mesh(s.view(), runtime::RunControl(nullptr));
}

/// Every label 0 … count−1 occurs and is edge-connected across the passage.
inline void expect_partition(const partition::Passage& passage, const partition::Labels& labels, std::size_t count) {
    std::vector<std::uint8_t> seen(count, 0);
    for (std::size_t f = 0; f < labels.size(); ++f) {
        if (!passage.is_active(f)) {
            EXPECT_EQ(labels[f], -1);
            continue;
        }
        ASSERT_GE(labels[f], 0);
        ASSERT_LT(labels[f], static_cast<std::int32_t>(count));
        seen[static_cast<std::size_t>(labels[f])] = 1;
    }
    for (const std::uint8_t s : seen) EXPECT_EQ(s, 1);
    partition::Labels parts = labels;
    EXPECT_EQ(partition::connected_parts(passage, parts), count);
}

}  // namespace quadseg::test
