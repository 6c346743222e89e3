// The mesh that the algorithms work on: checked, repaired, reordered, in the unit frame.
#pragma once

#include <quadseg/mesh.h>

#include "math/vec3.h"
#include "runtime/run_control.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace quadseg::mesh {

inline constexpr std::int32_t no_face = -1;

/// x_unit = (x − centre) · scale: box centre at 0, largest extent 1 (the paper's unit cube, centred).
struct UnitFrame {
    Vec3 centre;
    double scale = 1;     ///< 1 / largest extent
    double diagonal = 1;  ///< of the bounding box, in the unit frame
    Vec3 to_unit(const Vec3& x) const noexcept { return (x - centre) * scale; }
    Vec3 to_input(const Vec3& u) const noexcept { return u / scale + centre; }
};

/// Faces in Morton order of their centroids, each from the corner opposite its longest edge on, vertices renumbered by
/// first use: hardly anything depends on how the input is numbered; degenerate faces with a repeated index
/// and duplicate faces are left out (they get their label from `label_source`). Faces of zero area with three different
/// vertices stay, with zero normal and area: they carry connectivity.
struct WorkMesh {
    std::vector<Vec3> positions;                      ///< V', unit frame
    std::vector<std::array<std::uint32_t, 3>> faces;  ///< F', oriented consistently within a component
    /// Face across edge k = (v[k], v[(k+1)%3]); no_face at borders, non-manifold and unorientable edges.
    std::vector<std::array<std::int32_t, 3>> neighbors;
    std::vector<Vec3> normals;             ///< unit; zero for faces without area
    std::vector<double> areas;             ///< unit frame
    std::vector<std::int32_t> components;  ///< 0 … component_count−1, by first face
    std::size_t component_count = 0;

    std::vector<std::uint32_t> input_face;    ///< F' → input face
    std::vector<std::uint32_t> input_vertex;  ///< V' → input vertex
    /// For each input face the work face whose label it takes (itself, its duplicate, or a neighbour); no_face: none.
    std::vector<std::int32_t> label_source;
    std::vector<std::int32_t> polygon;  ///< F' → first work face of its polygon; empty: all triangles
    UnitFrame frame;
    MeshReport report;
    double total_area = 0;  ///< unit frame

    std::size_t face_count() const noexcept { return faces.size(); }
    std::size_t vertex_count() const noexcept { return positions.size(); }
    Vec3 corner(std::size_t f, int k) const noexcept { return positions[faces[f][static_cast<std::size_t>(k)]]; }
    Vec3 centroid(std::size_t f) const noexcept { return (corner(f, 0) + corner(f, 1) + corner(f, 2)) / 3.0; }
};

/// Edge j of face g = neighbors[f][k] (not no_face) that is edge k of f, also where stitched faces share several edges.
std::size_t matching_edge(const WorkMesh& mesh, std::size_t f, std::size_t k) noexcept;

/// Checks, repairs, reorders. Parallel, deterministic, O(F). Throws Error (invalid_mesh, empty_mesh), Stopped.
WorkMesh build_work_mesh(const MeshView& mesh, const runtime::RunControl& control);

/// Incident faces of every vertex, CSR: faces of v are face[begin[v]] … face[begin[v+1]−1], ascending.
struct VertexFaces {
    std::vector<std::uint32_t> begin, face;
};
VertexFaces vertex_faces(const WorkMesh& mesh);

/// Labels of the work faces brought back to the input faces (−1 where label_source says so).
std::vector<std::int32_t> labels_to_input(const WorkMesh& mesh, const std::vector<std::int32_t>& labels);
/// The reverse: labels of the work faces taken from labels of the input faces.
std::vector<std::int32_t> labels_from_input(const WorkMesh& mesh, std::span<const std::int32_t> labels);

}  // namespace quadseg::mesh
