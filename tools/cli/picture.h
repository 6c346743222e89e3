// Pictures of a segmentation, rendered without a display.
#pragma once

#include <quadseg/mesh.h>
#include <quadseg/segmentation.h>

#include <string>

namespace quadseg::cli {

/// Every region in a colour of its own. Throws Error file_write.
void write_region_picture(const std::string& path, const Mesh& mesh, const Segmentation& segmentation);
/// Every surface type in its colour, with a legend.
void write_type_picture(const std::string& path, const Mesh& mesh, const Segmentation& segmentation);

}  // namespace quadseg::cli
