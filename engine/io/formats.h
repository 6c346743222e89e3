// One reader a format. All throw Error file_format, invalid_mesh and runtime::Stopped.
#pragma once

#include <quadseg/mesh.h>

#include "io/file_contents.h"
#include "runtime/run_control.h"

namespace quadseg::io {

enum class Format { unknown, off, obj, ply, stl_ascii, stl_binary };

/// By content, then by extension.
Format recognise(const FileContents& file);

/// Of any format; throws Error empty_mesh too.
Mesh read_contents(FileContents& file, const runtime::RunControl& control);

Mesh read_off(const FileContents& file, const runtime::RunControl& control);
Mesh read_obj(const FileContents& file, const runtime::RunControl& control);
Mesh read_ply(const FileContents& file, const runtime::RunControl& control);
Mesh read_stl_ascii(const FileContents& file, const runtime::RunControl& control);
Mesh read_stl_binary(const FileContents& file, const runtime::RunControl& control);

/// "OFF" after its optional prefixes: STOFF, COFF, NOFF, CNOFF …
bool is_off_keyword(std::string_view word) noexcept;

}  // namespace quadseg::io
