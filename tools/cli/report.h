// result.json and what else the program prints in JSON. The keys are a contract: tools/result.schema.json.
#pragma once

#include <quadseg/mesh.h>
#include <quadseg/options.h>
#include <quadseg/segmentation.h>

#include <nlohmann/json.hpp>
#include <string>

namespace quadseg::cli {

using Json = nlohmann::ordered_json;

/// `polygons`: faces of the file, where polygons were cut into triangles.
Json input_json(const std::string& file, const Mesh& mesh, const MeshReport& report);
Json options_json(const Options& options);
/// Parameters of a typed surface, by the names of its type.
Json parameters_json(const Surface& surface);
Json result_json(const std::string& file, const Mesh& mesh, const Options& options, const Segmentation& segmentation);
/// Indented, with a newline at its end. Bytes of file names that are no UTF-8 become U+FFFD.
std::string indented(const Json& json);

}  // namespace quadseg::cli
