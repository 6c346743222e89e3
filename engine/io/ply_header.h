// The header of a PLY file: which elements with which properties follow, and how they are encoded.
#pragma once

#include "io/file_contents.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace quadseg::io {

enum class PlyType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

constexpr std::size_t ply_size(PlyType type) noexcept {
    constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
    return sizes[static_cast<std::size_t>(type)];
}
constexpr bool is_integer(PlyType type) noexcept {
    return type < PlyType::float32;
}

struct PlyProperty {
    std::string_view name;
    PlyType type = PlyType::int32;          ///< of the value or, in a list, of its entries
    std::optional<PlyType> list_size_type;  ///< set if it is a list
};

struct PlyElement {
    std::string_view name;
    std::size_t count = 0;
    std::vector<PlyProperty> properties;

    const PlyProperty* find(std::string_view property) const noexcept;
    bool has_list() const noexcept;
    /// Bytes of one element in a binary file, lists left out.
    std::size_t scalar_bytes() const noexcept;
};

enum class PlyEncoding { ascii, little_endian, big_endian };

struct PlyHeader {
    PlyEncoding encoding = PlyEncoding::ascii;
    std::vector<PlyElement> elements;
    const char* body = nullptr;

    // What a mesh is made of, found and checked.
    std::size_t vertex_element = 0, face_element = 0;  ///< in `elements`
    std::size_t corner_list = 0;                       ///< vertex_indices in the properties of the face element
    std::size_t coordinates[3] = {0, 0, 0};            ///< x, y, z in the properties of the vertex element

    const PlyElement& vertices() const noexcept { return elements[vertex_element]; }
    const PlyElement& faces() const noexcept { return elements[face_element]; }
};

/// Throws Error file_format with the line. Names are views of the file.
PlyHeader read_ply_header(const FileContents& file);

}  // namespace quadseg::io
