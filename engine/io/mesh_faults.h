// The texts of faults that several formats share.
#pragma once

#include "io/file_contents.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

namespace quadseg::io {

/// The largest number of vertices and faces that 32-bit indices can name.
inline constexpr std::uint64_t largest_count = std::numeric_limits<std::uint32_t>::max();

/// Vertices and faces are counted from 0 in messages, as everywhere in the library.
inline Fault not_finite(const char* where, std::size_t vertex) {
    return {ErrorCode::invalid_mesh, where,
            "vertex " + std::to_string(vertex) +
                " (counted from 0) has a coordinate that is NaN, infinite or too large; repair the mesh"};
}
inline Fault index_out_of_range(const char* where, std::size_t face, std::int64_t index, std::size_t vertices,
                                int first_index) {
    return {ErrorCode::invalid_mesh, where,
            "face " + std::to_string(face) + " (counted from 0) names vertex " + std::to_string(index) +
                ", but the file has " + std::to_string(vertices) + " vertices, counted from " +
                std::to_string(first_index) + "; repair the mesh"};
}
inline Fault too_few_corners(const char* where, std::size_t face, std::int64_t corners) {
    return {ErrorCode::file_format, where,
            "face " + std::to_string(face) + " (counted from 0) has " + std::to_string(corners) +
                " corners; a face needs at least 3"};
}

}  // namespace quadseg::io
