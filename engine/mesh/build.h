// The stages of build_work_mesh(), one file each. Private to the room.
#pragma once

#include "mesh/work_mesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace quadseg::mesh::build {

/// Faces a block of the parallel loops: small enough to poll every few milliseconds.
inline constexpr std::size_t block = 8192;

/// Throws Error when the arrays are no mesh. Returns a flag a vertex: used by a face.
std::vector<std::uint8_t> check_input(const MeshView& input, const runtime::RunControl& control);

/// Bounding box of the vertices in use, frame and the report's entries about them.
void measure_box(const MeshView& input, const std::vector<std::uint8_t>& used, WorkMesh& mesh,
                 const runtime::RunControl& control);

/// (face, kept face) for input faces with the same three vertices; the kept one comes first in the input.
using Duplicates = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

struct FaceOrder {
    std::vector<std::uint32_t> faces;
    std::vector<std::uint8_t> first_corner;  ///< of each of them, not as the file begins it
    Duplicates duplicates;                   ///< left out of it, by face
};
/// Input faces with three different vertices, each once, in Morton order of their centroids. Ties are broken by the
/// positions of corners from the first one on, then by index, so that the order hardly depends on that of the input.
FaceOrder morton_order(const MeshView& input, const UnitFrame& frame, const runtime::RunControl& control);

/// Fills input_face, faces, input_vertex and positions, the latter still in input coordinates.
void renumber(const MeshView& input, std::vector<std::uint32_t> order, const std::vector<std::uint8_t>& first_corner,
              WorkMesh& mesh, const runtime::RunControl& control);

struct EdgeCounts {
    std::size_t border = 0, non_manifold = 0;
    std::size_t same_direction = 0;  ///< two-face edges whose faces disagree in orientation
};
/// Fills neighbors by matching half-edges in buckets of their larger vertex.
EdgeCounts match_edges(WorkMesh& mesh, const runtime::RunControl& control);

/// Vertices whose faces form more than one fan. To be called while vertices are still numbered by first use (before
/// orient()).
std::size_t count_non_manifold_vertices(const WorkMesh& mesh, const runtime::RunControl& control);

/// Fills normals and areas from positions in input coordinates.
void measure_faces(WorkMesh& mesh, const runtime::RunControl& control);

/// Turns faces so that every component agrees with the larger part of its area; cuts edges that cannot agree.
void orient(WorkMesh& mesh, const runtime::RunControl& control);

/// Joins border half-edges at identical positions (input coordinates) where exactly two of opposite direction meet.
void stitch_borders(WorkMesh& mesh, const runtime::RunControl& control);

/// Fills components and component_count.
void find_components(WorkMesh& mesh, const runtime::RunControl& control);

/// Fills label_source and polygon. Duplicates take the label of the kept face.
void find_label_sources(const MeshView& input, const Duplicates& duplicates, WorkMesh& mesh,
                        const runtime::RunControl& control);

/// Bit-equal positions, −0 taken as +0.
inline Vec3 without_negative_zero(const Vec3& p) noexcept {
    return {p.x + 0.0, p.y + 0.0, p.z + 0.0};
}

inline bool has_repeated_index(const std::uint32_t* t) noexcept {
    return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

}  // namespace quadseg::mesh::build
