// Which face of a simplified mesh stands for each input face.
#pragma once

#include "simplify/collapse_mesh.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace quadseg::simplify {

/// For every face of the collapsed mesh the live face at the end of its chain of heirs; none: a face that never lived.
std::vector<std::uint32_t> last_heirs(const CollapseMesh& mesh);

/// Moves every entry of face_map downhill over the simplified mesh, from face to neighbouring face, until none stands
/// closer to the input face: in distance of its centroid, and in normal, so that it stays on its side of a crease.
void refine_face_map(std::span<const Vec3> positions, std::span<const Face> faces,
                     std::span<const Vec3> simplified_positions, std::span<const Face> simplified_faces,
                     const std::function<bool()>& stopped, std::vector<std::uint32_t>& face_map);

}  // namespace quadseg::simplify
