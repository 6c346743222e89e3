// What the two forms of STL share.
#pragma once

#include <cstddef>
#include <string_view>

namespace quadseg::io {

inline constexpr std::size_t stl_header_bytes = 80;
inline constexpr std::size_t stl_prefix_bytes = 84;  ///< header and number of facets
inline constexpr std::size_t stl_facet_bytes = 50;   ///< normal, three corners, attribute

/// The size of the file agrees exactly with its number of facets: binary even if it begins with "solid".
bool has_binary_stl_size(std::string_view bytes) noexcept;

}  // namespace quadseg::io
