// What the fuzz targets of the readers share: any bytes must end in a sound mesh or in an Error.
#pragma once

#include <quadseg/error.h>

#include "cpu_limit.h"
#include "io/file_contents.h"
#include "io/formats.h"
#include "runtime/run_control.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace quadseg::fuzz {

inline void require(bool condition) {
    if (!condition) __builtin_trap();
}

inline void require_sound(const Mesh& mesh) {
    require(mesh.positions.size() % 3 == 0 && mesh.triangles.size() % 3 == 0);
    require(mesh.polygons.empty() || mesh.polygons.size() == mesh.triangles.size() / 3);
    for (const std::uint32_t v : mesh.triangles) require(v < mesh.positions.size() / 3);
    for (const std::uint32_t p : mesh.polygons) require(p < mesh.file_faces);
    for (const double x : mesh.positions) require(std::isfinite(x));
}

/// read(file, control) may throw Error and nothing else, and a few kilobytes take no second.
template <class Read>
int run(const std::uint8_t* data, std::size_t size, const char* name, const Read& read) {
    const CpuLimit limit(2);
    const runtime::RunControl control(nullptr);
    try {
        io::FileContents file(std::string_view(reinterpret_cast<const char*>(data), size), name);
        require_sound(read(file, control));
    } catch (const Error& error) {
        require(error.code() != ErrorCode::internal && std::string_view(error.what()).starts_with(name));
    }
    return 0;
}

}  // namespace quadseg::fuzz
