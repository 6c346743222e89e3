#include "mesh/build.h"

#include <utility>

namespace quadseg::mesh::build {

namespace {

using Turn = std::uint8_t;
constexpr Turn unknown = 0, keep = 1, turn = 2;

/// True if the faces run along their common edge in the same direction. (u, w): edge k of f.
bool same_direction(const WorkMesh& mesh, std::size_t f, std::size_t k, std::size_t g) noexcept {
    const std::uint32_t u = mesh.faces[f][k], w = mesh.faces[f][(k + 1) % 3];
    const auto& t = mesh.faces[g];
    return (t[0] == u && t[1] == w) || (t[1] == u && t[2] == w) || (t[2] == u && t[0] == w);
}

void turn_face(WorkMesh& mesh, std::size_t f) noexcept {
    std::swap(mesh.faces[f][1], mesh.faces[f][2]);
    std::swap(mesh.neighbors[f][0], mesh.neighbors[f][2]);  // (a, b, c) → (a, c, b): edge bc stays the middle one
    mesh.normals[f] = -mesh.normals[f];
}

/// Cuts the edge on both sides.
void cut(WorkMesh& mesh, std::size_t f, std::size_t k, std::size_t g) noexcept {
    const std::uint32_t u = mesh.faces[f][k], w = mesh.faces[f][(k + 1) % 3];
    mesh.neighbors[f][k] = no_face;
    for (std::size_t j = 0; j < 3; ++j) {
        const std::uint32_t a = mesh.faces[g][j], b = mesh.faces[g][(j + 1) % 3];
        if ((a == u && b == w) || (a == w && b == u)) mesh.neighbors[g][j] = no_face;
    }
}

}  // namespace

void orient(WorkMesh& mesh, const runtime::RunControl& control) {
    std::vector<Turn> state(mesh.face_count(), unknown);
    std::vector<std::uint32_t> component;
    std::size_t counter = 0;
    for (std::size_t start = 0; start < mesh.face_count(); ++start) {
        if (state[start] != unknown) continue;
        component.assign(1, static_cast<std::uint32_t>(start));
        state[start] = keep;
        double kept = 0, turned = 0;
        for (std::size_t i = 0; i < component.size(); ++i) {
            control.check_often(counter);
            const std::size_t f = component[i];
            (state[f] == keep ? kept : turned) += mesh.areas[f];
            for (std::size_t k = 0; k < 3; ++k) {
                const std::int32_t neighbor = mesh.neighbors[f][k];
                if (neighbor == no_face) continue;
                const auto g = static_cast<std::size_t>(neighbor);
                const Turn opposite = state[f] == keep ? turn : keep;
                const Turn wanted = same_direction(mesh, f, k, g) ? opposite : state[f];
                if (state[g] == unknown) {
                    state[g] = wanted;
                    component.push_back(static_cast<std::uint32_t>(g));
                } else if (state[g] != wanted) {
                    cut(mesh, f, k, g);
                    ++mesh.report.unorientable_edges;
                }
            }
        }
        const Turn minority = turned > kept ? keep : turn;
        for (const std::uint32_t f : component) {
            if (state[f] != minority) continue;
            turn_face(mesh, f);
            ++mesh.report.flipped_faces;
        }
    }
}

}  // namespace quadseg::mesh::build
