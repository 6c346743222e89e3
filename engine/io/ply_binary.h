// The body of a binary PLY file.
#pragma once

#include <quadseg/mesh.h>

#include "io/ply_header.h"
#include "runtime/run_control.h"

namespace quadseg::io {

Mesh read_ply_binary(const FileContents& file, const PlyHeader& header, const runtime::RunControl& control);

}  // namespace quadseg::io
