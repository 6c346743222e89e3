// Pictures of a mesh and of a segmentation, rendered without a display.
#pragma once

#include <quadseg/mesh.h>
#include <quadseg/segmentation.h>

#include "tools/cli/rasterizer.h"

#include <span>
#include <string>

namespace quadseg::cli {

/// What a picture shows of a mesh.
struct PictureContent {
    std::span<const std::int32_t> labels;  ///< F: every region in a colour of its own; none: one colour
    std::span<const SurfaceType> types;    ///< by label: every type in its colour, with the legend
    std::span<const double> errors;        ///< V: colours of errors, with their scale
    double largest_error = 1;              ///< red
    std::span<const Edge> edges;           ///< lines over the mesh
    Rgb edge_color{20, 60, 220};
    double edge_width = 2;
    int up = -1;  ///< axis that stands upright; −1: the box decides
    std::size_t width = 1000, height = 750;
};

/// Throws Error file_write.
void write_picture(const std::string& path, const MeshView& mesh, const PictureContent& content);

/// Every region in a colour of its own. Throws Error file_write.
void write_region_picture(const std::string& path, const Mesh& mesh, const Segmentation& segmentation);
/// Every surface type in its colour, with a legend.
void write_type_picture(const std::string& path, const Mesh& mesh, const Segmentation& segmentation);

}  // namespace quadseg::cli
