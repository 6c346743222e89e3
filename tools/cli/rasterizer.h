// A small software rasteriser: a shaded mesh with dark lines between regions, the same pixels everywhere.
#pragma once

#include <quadseg/mesh.h>

#include "tools/cli/image.h"

#include <array>
#include <cstdint>
#include <span>

namespace quadseg::cli {

using Edge = std::array<std::uint32_t, 2>;

struct Scene {
    MeshView mesh;
    std::span<const std::int32_t> labels;  ///< F, or none: one region
    std::span<const Rgb> color_of_region;  ///< by label
    std::span<const double> error_shares;  ///< V, or none: error_color() of these instead of a region's colour
    std::span<const Edge> edges;           ///< pairs of vertices to be joined by a line
    Rgb edge_color{};
    double edge_width = 1;  ///< pixels
    int up = -1;            ///< axis that stands upright (0 … 2); else the box decides
};

/// Draws into the part [0, width) × [0, height) of the image, in a three-quarter view from above the largest faces of
/// the bounding box, smoothed 2 × 2.
void draw_scene(Image& image, std::size_t width, std::size_t height, const Scene& scene);

}  // namespace quadseg::cli
