// A small software rasteriser: a shaded mesh with dark lines between regions, the same pixels everywhere.
#pragma once

#include <quadseg/mesh.h>

#include "tools/cli/image.h"

#include <cstdint>
#include <span>

namespace quadseg::cli {

struct Scene {
    MeshView mesh;
    std::span<const std::int32_t> labels;  ///< F
    std::span<const Rgb> color_of_region;  ///< by label
};

/// Draws into the part [0, width) × [0, height) of the image, in a three-quarter view from above the largest faces of
/// the bounding box, smoothed 2 × 2.
void draw_scene(Image& image, std::size_t width, std::size_t height, const Scene& scene);

}  // namespace quadseg::cli
