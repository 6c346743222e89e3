// Reading and writing files. Readers keep the face order of the file.
#pragma once

#include <quadseg/context.h>
#include <quadseg/export.h>
#include <quadseg/mesh.h>
#include <quadseg/segmentation.h>

#include <cstdint>
#include <span>
#include <string>

namespace quadseg {

/// Reads OFF, OBJ, PLY (ascii, binary of both endians) or STL (ascii, binary), recognised by content, then by
/// extension. Polygons are cut into triangles that follow one another; STL corners at the same position are welded.
/// Messages name the line or byte. Throws Error file_open, file_format, invalid_mesh, empty_mesh (no face at all),
/// memory_limit, cancelled. Thread-safe.
QUADSEG_API Mesh read_mesh(const std::string& path, Context* context = nullptr);

/// Colours and labels of the faces of a PLY.
struct FaceColors {
    std::span<const std::int32_t> labels;  ///< F, written as property int label; empty: none
    std::span<const std::uint8_t> rgb;     ///< 3F, written as property uchar red, green, blue; empty: none
};

/// Writes binary little-endian PLY (double positions where they need it, else float) under a temporary name, then
/// renames. Nothing is left under the final name on failure. Throws Error file_write.
QUADSEG_API void write_ply(const std::string& path, const MeshView& mesh, const FaceColors& faces = {});
/// By extension: .ply (binary), .off, .obj, .stl (binary).
QUADSEG_API void write_mesh(const std::string& path, const MeshView& mesh);
/// One integer a line. With `polygons` of the mesh not empty: one line a polygon.
QUADSEG_API void write_labels(const std::string& path, std::span<const std::int32_t> labels,
                              std::span<const std::uint32_t> polygons = {});
/// Writes a text file the same careful way: temporary name, flush to disk, rename.
QUADSEG_API void write_text(const std::string& path, const std::string& text);

}  // namespace quadseg
