// A working mesh of what simplification made of another.
#pragma once

#include "mesh/work_mesh.h"
#include "runtime/run_control.h"

#include <array>
#include <cstdint>
#include <span>

namespace quadseg::flow {

/// positions: in the unit frame of `fine`, which the result's lengths are in as well. Its input faces and vertices are
/// the given ones. Throws Error (empty_mesh), Stopped.
mesh::WorkMesh build_simplified_mesh(const mesh::WorkMesh& fine, std::span<const Vec3> positions,
                                     std::span<const std::array<std::uint32_t, 3>> faces,
                                     const runtime::RunControl& control);

}  // namespace quadseg::flow
