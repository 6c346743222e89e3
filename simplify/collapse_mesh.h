// A triangle mesh under edge collapses: the corners of a vertex form a list, so that a collapse splices two lists and
// touches nothing but the two stars.
#pragma once

#include "math/vec3.h"
#include "simplify/error_quadric.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace quadseg::simplify {

using Face = std::array<std::uint32_t, 3>;
inline constexpr std::uint32_t none = 0xffffffffU;
/// Vertices of more faces take no part in a collapse: it bounds the work of one, whatever the input.
inline constexpr std::size_t max_valence = 96;
/// Among collapses of the same error the shortest edge first: an error of 1e-3 of the edge's length counts as none.
inline constexpr double length_weight = 1e-6;

enum VertexFlag : std::uint8_t {
    vertex_border = 1,     ///< moves along its border only
    vertex_locked = 2,     ///< non-manifold: stays where it is
    vertex_irregular = 4,  ///< the successors of its corners do not name every neighbour exactly once
    vertex_dead = 8,
    vertex_frozen = 16  ///< faces outside of the piece at hand: stays as it is
};

/// Corner i = corner i % 3 of face i / 3.
inline std::uint32_t corner_face(std::uint32_t corner) {
    return corner / 3;
}

/// Quadrics lose digits to offset and scale: inside, the box has its centre at 0 and the largest extent 1.
struct Frame {
    Vec3 centre;
    double scale = 1;
    Vec3 to_unit(const Vec3& x) const noexcept { return (x - centre) * scale; }
    Vec3 to_input(const Vec3& u) const noexcept { return u / scale + centre; }
};

/// What the cost of an edge needs of its ends, together: two cache lines.
struct alignas(64) Vertex {
    ErrorQuadric quadric;
    Vec3 position;                ///< in the frame
    std::uint32_t source = none;  ///< input vertex whose position this is exactly, or none
    std::uint32_t valence = 0;    ///< live faces
    std::uint8_t flags = 0;
};

struct CollapseMesh {
    Frame frame;
    std::vector<Vertex> vertices;
    std::vector<Face> faces;  ///< dead: {none, face that took its place, –}
    std::vector<std::uint32_t> first_corner, next_corner;
    std::size_t face_count = 0;  ///< alive

    bool alive(std::uint32_t face) const noexcept { return faces[face][0] != none; }
    bool dead_vertex(std::uint32_t v) const noexcept { return (vertices[v].flags & vertex_dead) != 0; }
    Vec3 area_vector(const Face& f) const noexcept {
        const Vec3& origin = vertices[f[0]].position;
        return cross(vertices[f[1]].position - origin, vertices[f[2]].position - origin);
    }
};

/// Builds lists, flags and quadrics: planes of the faces weighted by area; borders and creases sharper than
/// `feature_degrees` held by planes through them, perpendicular to their faces. Faces with a repeated vertex are dead.
/// False: stopped.
bool build_collapse_mesh(std::span<const Vec3> positions, std::span<const Face> faces, double feature_degrees,
                         const std::function<bool()>& stopped, CollapseMesh& mesh);

struct Placement {
    Vec3 position;
    double quadric_error = 0;  ///< Q(position)
    double cost = 0;           ///< with a small term for the length of the edge: what collapses are ordered by
    double area = 0;
    std::uint32_t source = none;
};
/// Where the vertex that replaces v and w goes.
Placement place_collapsed(const CollapseMesh& mesh, std::uint32_t v, std::uint32_t w);

/// Collapses edge (v, w) into v unless that changes the topology (link condition, Dey et al. 1999), turns a face over
/// or, with `keep_shape`, makes a sliver. Returns the number of faces removed: 0: refused and nothing changed.
std::size_t try_collapse(CollapseMesh& mesh, std::uint32_t v, std::uint32_t w, const Placement& placement,
                         bool keep_shape);

}  // namespace quadseg::simplify
