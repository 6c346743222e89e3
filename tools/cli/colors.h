// Colours of regions and of surface types.
#pragma once

#include <quadseg/segmentation.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace quadseg::cli {

using Rgb = std::array<std::uint8_t, 3>;

/// Far apart for neighbouring numbers.
Rgb region_color(std::int32_t region);
/// The fixed legend.
Rgb type_color(SurfaceType type);
inline constexpr Rgb unlabelled_color{90, 90, 90};
/// From blue (0: none) over green and yellow to red (1 and more).
Rgb error_color(double share);

/// Three bytes a face.
std::vector<std::uint8_t> face_colors(std::span<const std::int32_t> labels, std::span<const Rgb> color_of_region);

}  // namespace quadseg::cli
