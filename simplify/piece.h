// A piece of a mesh, copied out so that its collapses stay in the cache of one core; pieces collapse at once.
#pragma once

#include "simplify/bucket_queue.h"
#include "simplify/collapse_mesh.h"
#include "simplify/pieces.h"
#include "simplify/rating.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace quadseg::simplify {

struct PieceLimits {
    float largest_cost = 0;        ///< of a collapse
    std::size_t fewest_faces = 0;  ///< that remain
    bool keep_shape = true;
};

class Piece {
  public:
    /// Copies piece `number` of the mesh. Vertices that other pieces have faces at stay where they are.
    void load(const CollapseMesh& mesh, const Pieces& pieces, std::uint32_t number);
    /// Collapses edges, the cheapest first. Returns the number of collapses.
    std::size_t collapse(const PieceLimits& limits, const std::function<bool()>& stopped);
    /// Cost of the k-th cheapest edge.
    float cost_of_rank(std::size_t k);
    /// Writes back what has changed; the faces that remain are appended to `alive`.
    void store(CollapseMesh& mesh, std::vector<std::uint32_t>& alive) const;

    std::size_t face_count() const noexcept { return local_.face_count; }
    /// The largest root of a collapse's quadric error over area, in the mesh's frame.
    double max_error() const noexcept { return max_error_; }

  private:
    std::uint32_t local_vertex(const CollapseMesh& mesh, std::uint32_t v);
    bool may_collapse(std::uint32_t v, std::uint32_t w) const;
    void rate_all();
    void rate_around(std::uint32_t v, float largest_cost);
    void enqueue(const RatedEdge& edge, float largest_cost);
    std::uint32_t stamp(std::uint32_t v, std::uint32_t w) const { return stamps_[v] + stamps_[w]; }

    CollapseMesh local_;
    std::vector<std::uint32_t> global_vertex_, global_face_;
    std::vector<std::uint32_t> slots_;           ///< hash table of local vertices
    std::vector<std::uint32_t> stamps_;          ///< of a vertex: the collapses into it
    std::vector<std::vector<RatedEdge>> rated_;  ///< by rate_all(), a list for every block of faces
    std::vector<RatedEdge> around_;
    BucketQueue queue_;
    double max_error_ = 0;
};

}  // namespace quadseg::simplify
