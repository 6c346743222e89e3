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

/// Cuts polygons into triangles; keeps its working memory from one to the next.
class Triangulator {
  public:
    struct Point {
        double x, y;
    };

    explicit Triangulator(std::span<const double> positions) : positions_(positions) {}

    /// A polygon of n ≥ 3 corners becomes n−2 triangles: a fan if it is strictly convex, ears otherwise.
    void cut(std::span<const std::uint32_t> polygon, std::uint32_t* triangles);

  private:
    bool project(std::span<const std::uint32_t> polygon, double& area);
    bool strictly_convex(double threshold) const noexcept;
    void cut_ears(std::span<const std::uint32_t> polygon, double threshold, std::uint32_t* triangles);
    std::size_t find_ear(std::size_t tip, std::size_t left, double threshold) const noexcept;
    bool is_empty(std::size_t tip, std::size_t left) const noexcept;

    std::span<const double> positions_;
    std::vector<Point> points_;                 ///< of the polygon, in its plane
    std::vector<std::size_t> next_, previous_;  ///< a ring of the corners that are not cut off yet
};

}  // namespace quadseg::io
