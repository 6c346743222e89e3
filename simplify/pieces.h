// Cuts a mesh into pieces of neighbouring faces, at other places in every phase.
#pragma once

#include "simplify/collapse_mesh.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace quadseg::simplify {

/// A vertex that several pieces have faces at has no owner.
inline constexpr std::uint32_t shared_vertex = none - 1;

struct Pieces {
    std::vector<std::uint32_t> owner;                   ///< of a vertex: the piece that all its faces are in
    std::vector<std::span<const std::uint32_t>> faces;  ///< of every piece
};

/// Sorts `alive` along a Morton curve whose cells lie elsewhere in every phase, so that borders between pieces do not
/// stay borders; pieces are runs of about `piece_faces` of it. They live as long as `alive` stays as it is. False:
/// stopped; then the faces in `alive` are the same, but there are no pieces.
bool cut_into_pieces(const CollapseMesh& mesh, std::size_t phase, std::size_t piece_faces,
                     const std::function<bool()>& stopped, std::vector<std::uint32_t>& alive, Pieces& pieces);

/// One piece with all the faces.
void keep_in_one_piece(const CollapseMesh& mesh, const std::vector<std::uint32_t>& alive, Pieces& pieces);

}  // namespace quadseg::simplify
