// Takes out the vertices that say nothing about a shape: those inside a facet, and those on a straight edge between
// two. Subdivision, boolean operations and repairs of T-junctions put them there. Knows only arrays.
#pragma once

#include "math/vec3.h"

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace quadseg::simplify {

struct Undivided {
    std::vector<Vec3> positions;  ///< of the vertices that are left, where they were
    std::vector<std::array<std::uint32_t, 3>> faces;
    std::vector<std::uint32_t> source_face;    ///< for each face an input face of the same facet
    std::vector<std::uint32_t> source_vertex;  ///< for each vertex the input vertex
};

struct UndivideOptions {
    double straight = 0;  ///< a border vertex within that of the line between its neighbours says nothing either
    /// Polled; what it throws leaves undivide().
    std::function<void()> check;
};

/// The same shape: one vertex after another is taken out, and its star cut into triangles anew. `facet_of_face`: faces
/// of one facet lie in one plane. Vertices of non-manifold edges, and where that would tie one, stay. Deterministic,
/// serial.
Undivided undivide(std::span<const Vec3> positions, std::span<const std::array<std::uint32_t, 3>> faces,
                   std::span<const std::int32_t> facet_of_face, const UndivideOptions& options);

}  // namespace quadseg::simplify
