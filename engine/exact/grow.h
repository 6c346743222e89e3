// Growing a surface over the mesh from a patch on which it was found.
#pragma once

#include "exact/candidate.h"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace quadseg::exact {

/// Marks of faces and vertices that can be taken back in O(1); one a thread.
class Marks {
  public:
    void prepare(std::size_t faces, std::size_t vertices) {
        if (faces_.size() < faces) faces_.assign(faces, 0);
        if (vertices_.size() < vertices) vertices_.assign(vertices, 0);
    }
    void clear() noexcept { ++stamp_; }
    bool mark_face(std::size_t f) noexcept { return std::exchange(faces_[f], stamp_) != stamp_; }
    bool mark_vertex(std::size_t v) noexcept { return std::exchange(vertices_[v], stamp_) != stamp_; }
    bool has_face(std::size_t f) const noexcept { return faces_[f] == stamp_; }

  private:
    std::vector<std::uint32_t> faces_, vertices_;
    std::uint32_t stamp_ = 1;
};

/// The faces that can be reached from `start` over faces on the surface (start faces that are not are left out). Sure
/// planes are not entered unless the surface is a plane.
std::vector<std::uint32_t> reach(const Scene& scene, const Surface& surface, std::span<const std::uint32_t> start,
                                 double largest_turn, Marks& marks);

/// Different vertices of faces, in order of first use; at most `most` of them, taken evenly.
std::vector<Vec3> vertices_of(const Scene& scene, std::span<const std::uint32_t> faces, std::size_t most, Marks& marks);

/// Grows, refits, grows again until the faces are stable; fills the figures of a candidate.
Candidate grow(const Scene& scene, const Surface& start, std::span<const std::uint32_t> patch, double largest_turn,
               Marks& marks);

/// Fills facets, area, median, gap and step of a candidate whose surface and faces are set.
void measure_candidate(const Scene& scene, Candidate& candidate, Marks& marks);

}  // namespace quadseg::exact
