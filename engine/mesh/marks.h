// Marks of faces and vertices that can be taken back in O(1): scratch of one thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace quadseg::mesh {

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

}  // namespace quadseg::mesh
