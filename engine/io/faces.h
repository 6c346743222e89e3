// Faces of any size as they stand in a file, and their triangles.
#pragma once

#include <quadseg/mesh.h>

#include "runtime/run_control.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace quadseg::io {

/// Consecutive faces of a file, read by one task.
struct FaceBlock {
    std::vector<std::uint32_t> corners;
    std::vector<std::uint32_t> sizes;  ///< empty while all are triangles
    std::size_t faces = 0;

    /// The corners of the face have been appended already.
    void close_face(std::size_t size) {
        if (size != 3 && sizes.empty()) sizes.assign(faces, 3);
        ++faces;
        if (size != 3 || !sizes.empty()) sizes.push_back(static_cast<std::uint32_t>(size));
    }
    std::size_t triangles() const noexcept { return corners.size() - 2 * faces; }
};

/// Puts the triangles of all blocks into the mesh, whose positions must be there and whose indices must be in range.
/// Frees the blocks.
void append_faces(Mesh& mesh, std::vector<FaceBlock>& blocks, const runtime::RunControl& control);

/// Cuts a polygon of n ≥ 3 corners into n−2 triangles: a fan if it is strictly convex, ears otherwise.
void triangulate(std::span<const double> positions, std::span<const std::uint32_t> polygon, std::uint32_t* triangles);

}  // namespace quadseg::io
