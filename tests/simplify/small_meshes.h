// Meshes for the tests of the room: exact shapes, and a plain reader of OFF and OBJ files.
#pragma once

#include "math/vec3.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

namespace quadseg::simplify {

struct SmallMesh {
    std::vector<Vec3> positions;
    std::vector<std::array<std::uint32_t, 3>> faces;
};

/// n × n squares over [0, 1]², height given by z(x, y).
template <class Height>
SmallMesh height_field(std::uint32_t n, const Height& z) {
    SmallMesh mesh;
    for (std::uint32_t j = 0; j <= n; ++j) {
        for (std::uint32_t i = 0; i <= n; ++i) {
            const double x = static_cast<double>(i) / n, y = static_cast<double>(j) / n;
            mesh.positions.push_back({x, y, z(x, y)});
        }
    }
    for (std::uint32_t j = 0; j < n; ++j) {
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t v = j * (n + 1) + i;
            mesh.faces.push_back({v, v + 1, v + n + 2});
            mesh.faces.push_back({v, v + n + 2, v + n + 1});
        }
    }
    return mesh;
}

inline SmallMesh flat_grid(std::uint32_t n) {
    return height_field(n, [](double, double) { return 0.0; });
}

/// The surface of [0, 1]³, n × n squares a side, closed.
inline SmallMesh cube(std::uint32_t n) {
    SmallMesh mesh;
    std::vector<std::uint32_t> number(static_cast<std::size_t>(n + 1) * (n + 1) * (n + 1), 0xffffffffU);
    const auto vertex = [&](std::array<std::uint32_t, 3> at) {
        std::uint32_t& id = number[(static_cast<std::size_t>(at[2]) * (n + 1) + at[1]) * (n + 1) + at[0]];
        if (id == 0xffffffffU) {
            id = static_cast<std::uint32_t>(mesh.positions.size());
            mesh.positions.push_back(
                {static_cast<double>(at[0]) / n, static_cast<double>(at[1]) / n, static_cast<double>(at[2]) / n});
        }
        return id;
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const std::uint32_t side : {0U, n}) {
            for (std::uint32_t j = 0; j < n; ++j) {
                for (std::uint32_t i = 0; i < n; ++i) {
                    const auto corner = [&](std::uint32_t a, std::uint32_t b) {
                        std::array<std::uint32_t, 3> at{};
                        at[axis] = side;
                        at[(axis + 1) % 3] = a;
                        at[(axis + 2) % 3] = b;
                        return vertex(at);
                    };
                    const std::uint32_t p = corner(i, j), q = corner(i + 1, j), r = corner(i + 1, j + 1),
                                        s = corner(i, j + 1);
                    if (side == 0) {
                        mesh.faces.push_back({p, r, q});
                        mesh.faces.push_back({p, s, r});
                    } else {
                        mesh.faces.push_back({p, q, r});
                        mesh.faces.push_back({p, r, s});
                    }
                }
            }
        }
    }
    return mesh;
}

/// Radius 1 around z, height 0 … `height`, `around` × `along` squares, open at both ends.
inline SmallMesh open_cylinder(std::uint32_t around, std::uint32_t along, double height) {
    SmallMesh mesh;
    for (std::uint32_t j = 0; j <= along; ++j) {
        for (std::uint32_t i = 0; i < around; ++i) {
            const double angle = 2 * std::numbers::pi * i / around;
            mesh.positions.push_back({std::cos(angle), std::sin(angle), height * j / along});
        }
    }
    for (std::uint32_t j = 0; j < along; ++j) {
        for (std::uint32_t i = 0; i < around; ++i) {
            const std::uint32_t p = j * around + i, q = j * around + (i + 1) % around;
            mesh.faces.push_back({p, q, q + around});
            mesh.faces.push_back({p, q + around, p + around});
        }
    }
    return mesh;
}

/// A torus of radii 1 and `minor`.
inline SmallMesh torus(std::uint32_t around, std::uint32_t across, double minor) {
    SmallMesh mesh;
    for (std::uint32_t j = 0; j < across; ++j) {
        for (std::uint32_t i = 0; i < around; ++i) {
            const double u = 2 * std::numbers::pi * i / around, v = 2 * std::numbers::pi * j / across;
            const double r = 1 + minor * std::cos(v);
            mesh.positions.push_back({r * std::cos(u), r * std::sin(u), minor * std::sin(v)});
        }
    }
    for (std::uint32_t j = 0; j < across; ++j) {
        for (std::uint32_t i = 0; i < around; ++i) {
            const std::uint32_t i1 = (i + 1) % around, j1 = (j + 1) % across;
            const std::uint32_t p = j * around + i, q = j * around + i1, r = j1 * around + i1, s = j1 * around + i;
            mesh.faces.push_back({p, q, r});
            mesh.faces.push_back({p, r, s});
        }
    }
    return mesh;
}

inline SmallMesh tetrahedron() {
    return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
}

/// b after a, with its own vertices.
inline SmallMesh together(SmallMesh a, const SmallMesh& b, const Vec3& shift) {
    const auto offset = static_cast<std::uint32_t>(a.positions.size());
    for (const Vec3& p : b.positions) a.positions.push_back(p + shift);
    for (const auto& f : b.faces) a.faces.push_back({f[0] + offset, f[1] + offset, f[2] + offset});
    return a;
}

/// Empty when the file is missing. Triangles only.
inline SmallMesh read_small_mesh(const std::string& path) {
    SmallMesh mesh;
    std::ifstream file(path);
    std::string line, word;
    if (path.ends_with(".off")) {
        std::size_t vertices = 0, faces = 0, edges = 0;
        file >> word >> vertices >> faces >> edges;
        mesh.positions.resize(file ? vertices : 0);
        for (Vec3& p : mesh.positions) file >> p.x >> p.y >> p.z;
        for (std::size_t i = 0; i < faces && file; ++i) {
            std::uint32_t corners = 0, a = 0, b = 0, c = 0;
            if (file >> corners >> a >> b >> c && corners == 3) mesh.faces.push_back({a, b, c});
        }
        return mesh;
    }
    while (std::getline(file, line)) {
        std::istringstream words(line);
        words >> word;
        if (word == "v") {
            Vec3 p;
            words >> p.x >> p.y >> p.z;
            mesh.positions.push_back(p);
        } else if (word == "f") {
            std::array<std::uint32_t, 3> f{};
            for (std::uint32_t& v : f) {
                words >> word;
                v = static_cast<std::uint32_t>(std::stoul(word)) - 1;
            }
            mesh.faces.push_back(f);
        }
        word.clear();
    }
    return mesh;
}

}  // namespace quadseg::simplify
