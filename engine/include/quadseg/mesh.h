// Meshes as flat arrays, and what a check of one reports.
#pragma once

#include <quadseg/export.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace quadseg {

class Context;

/// A view of the caller's arrays; nothing is copied or owned. They must outlive the call.
struct MeshView {
    std::span<const double> positions;  ///< x, y, z a vertex: 3V numbers, any unit, any frame
    std::span<const std::uint32_t>
        triangles;  ///< 3 vertex indices a face: 3F numbers, counter-clockwise seen from outside
    /// Empty, or F numbers: the polygon that a triangle was cut from. Triangles of one polygon must follow one another;
    /// they share a label.
    std::span<const std::uint32_t> polygons = {};

    std::size_t vertex_count() const noexcept { return positions.size() / 3; }
    std::size_t face_count() const noexcept { return triangles.size() / 3; }
};

/// A mesh that owns its arrays, as read_mesh() returns it.
struct Mesh {
    std::vector<double> positions;
    std::vector<std::uint32_t> triangles;
    std::vector<std::uint32_t> polygons;  ///< empty where every face of the file is a triangle
    std::size_t file_faces = 0;           ///< faces (polygons) in the file
    std::size_t welded_vertices = 0;      ///< STL: corners that were joined with an earlier one at the same position

    MeshView view() const noexcept { return {positions, triangles, polygons}; }
};

/// What the check of a mesh found, and what was done about it. Counts are of the input.
struct MeshReport {
    std::size_t faces = 0;
    std::size_t vertices = 0;
    std::size_t components = 0;             ///< by shared manifold edges, after the repairs below
    std::size_t border_edges = 0;           ///< edges of one face
    std::size_t non_manifold_edges = 0;     ///< edges of three and more faces; regions do not cross them
    std::size_t non_manifold_vertices = 0;  ///< vertices of several fans; reported, no repair needed
    std::size_t isolated_vertices = 0;      ///< vertices of no face; ignored
    std::size_t degenerate_faces = 0;       ///< repeated index or no area; they take a neighbour's label
    std::size_t duplicate_faces = 0;        ///< the same three vertices as an earlier face; they take its label
    std::size_t flipped_faces = 0;          ///< turned (inside only) to agree with their neighbours
    std::size_t unorientable_edges = 0;     ///< edges cut because no orientation suits both sides (Möbius strip)
    std::size_t stitched_edges = 0;         ///< pairs of border edges at identical positions that were joined
    std::size_t feature_edges =
        0;                ///< edges sharper than the feature angle that do not belong to a tessellated surface
    double diagonal = 0;  ///< of the bounding box of the vertices in use, input unit
    double area = 0;      ///< input unit squared
    double offset = 0;    ///< distance of the box centre from the origin, in diagonals
    std::array<double, 3> box_min{}, box_max{};
};

/// Checks a mesh without segmenting it. `feature_degrees` as Options::feature_angle (≤ 0: features are not counted).
/// Throws Error invalid_mesh (index out of range, non-finite coordinate, named), empty_mesh, cancelled. Thread-safe.
QUADSEG_API MeshReport inspect(const MeshView& mesh, double feature_degrees = 30, Context* context = nullptr);

}  // namespace quadseg
