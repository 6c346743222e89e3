// Meshes as PLY, OFF, OBJ and STL.
#include <quadseg/error.h>
#include <quadseg/io.h>

#include "io/atomic_file.h"
#include "io/bytes.h"
#include "io/format_blocks.h"
#include "io/stl.h"

#include <charconv>
#include <cmath>
#include <limits>

namespace quadseg {
namespace {

using io::AtomicFile;
using io::RawBytes;
using io::store_little_endian;
using io::write_blocks;

void check_arrays(const std::string& path, const MeshView& mesh) {
    if (mesh.positions.size() % 3 != 0 || mesh.triangles.size() % 3 != 0) {
        throw Error(ErrorCode::invalid_argument, path + ": positions and triangles must come in threes");
    }
}

/// Positions of 4 bytes when that loses nothing.
bool all_floats(std::span<const double> positions) {
    constexpr std::size_t grain = 65536;
    // Blocks that fail are counted: a vector of bool could not be written to by several tasks.
    return runtime::reduce_blocks(
               positions.size(), grain, 0,
               [&](std::size_t begin, std::size_t end) {
                   bool exact = true;
                   for (std::size_t i = begin; i < end; ++i) {
                       const double x = positions[i];
                       // The conversion of a larger number would be undefined.
                       exact = exact && std::abs(x) <= std::numeric_limits<float>::max() &&
                               static_cast<double>(static_cast<float>(x)) == x;
                   }
                   return exact ? 0 : 1;
               },
               [](int a, int b) { return a + b; }) == 0;
}

template <class Number>
void write_ply_positions(AtomicFile& file, std::span<const double> positions) {
    write_blocks<RawBytes>(file, positions.size(), [&](std::size_t begin, std::size_t end, RawBytes& out) {
        char* p = out.make((end - begin) * sizeof(Number));
        for (std::size_t i = begin; i < end; ++i, p += sizeof(Number)) {
            store_little_endian(p, static_cast<Number>(positions[i]));
        }
    });
}

template <bool Coloured, bool Labelled>
void write_ply_faces(AtomicFile& file, std::span<const std::uint32_t> triangles, const FaceColors& faces) {
    constexpr std::size_t bytes = 13 + (Coloured ? 3 : 0) + (Labelled ? 4 : 0);
    write_blocks<RawBytes>(file, triangles.size() / 3, [&](std::size_t begin, std::size_t end, RawBytes& out) {
        char* p = out.make((end - begin) * bytes);
        for (std::size_t f = begin; f < end; ++f) {
            *p++ = 3;
            for (std::size_t k = 0; k < 3; ++k, p += 4) store_little_endian(p, triangles[3 * f + k]);
            if constexpr (Coloured) {
                for (std::size_t k = 0; k < 3; ++k) *p++ = static_cast<char>(faces.rgb[3 * f + k]);
            }
            if constexpr (Labelled) {
                store_little_endian(p, faces.labels[f]);
                p += 4;
            }
        }
    });
}

std::string ply_header(const MeshView& mesh, const FaceColors& faces, bool floats) {
    const std::string number = floats ? "float" : "double";
    std::string header = "ply\nformat binary_little_endian 1.0\ncomment written by quadseg\nelement vertex " +
                         std::to_string(mesh.vertex_count()) + "\n";
    for (const char* name : {"x", "y", "z"}) header += "property " + number + " " + name + "\n";
    header += "element face " + std::to_string(mesh.face_count()) + "\nproperty list uchar int vertex_indices\n";
    if (!faces.rgb.empty()) {
        for (const char* name : {"red", "green", "blue"}) header += std::string("property uchar ") + name + "\n";
    }
    if (!faces.labels.empty()) header += "property int label\n";
    return header + "end_header\n";
}

/// A number as its shortest text that reads back as the same bits, behind a blank.
void append_number(std::string& out, double value) {
    char text[32];
    out += ' ';
    out.append(text, std::to_chars(text, text + sizeof text, value).ptr);
}
void append_number(std::string& out, std::uint64_t value) {
    char text[24];
    out += ' ';
    out.append(text, std::to_chars(text, text + sizeof text, value).ptr);
}

/// Lines of "prefix x y z" and "prefix a b c".
void write_text_mesh(AtomicFile& file, const MeshView& mesh, const std::string& vertex_prefix,
                     const std::string& face_prefix, std::uint64_t first_index) {
    write_blocks(file, mesh.vertex_count(), [&](std::size_t begin, std::size_t end, std::string& out) {
        out.clear();
        for (std::size_t v = begin; v < end; ++v) {
            const std::size_t line = out.size();
            for (std::size_t k = 0; k < 3; ++k) append_number(out, mesh.positions[3 * v + k]);
            out.replace(line, 1, vertex_prefix);
            out += '\n';
        }
    });
    write_blocks(file, mesh.face_count(), [&](std::size_t begin, std::size_t end, std::string& out) {
        out.clear();
        for (std::size_t f = begin; f < end; ++f) {
            out += face_prefix;
            for (std::size_t k = 0; k < 3; ++k) append_number(out, mesh.triangles[3 * f + k] + first_index);
            out += '\n';
        }
    });
}

void write_off(AtomicFile& file, const MeshView& mesh) {
    file.write("OFF\n" + std::to_string(mesh.vertex_count()) + " " + std::to_string(mesh.face_count()) + " 0\n");
    write_text_mesh(file, mesh, "", "3", 0);
}

void write_obj(AtomicFile& file, const MeshView& mesh) {
    file.write("# written by quadseg\n");
    write_text_mesh(file, mesh, "v ", "f", 1);
}

void write_facet(char* p, const MeshView& mesh, std::size_t face) {
    double corner[3][3], normal[3];
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            corner[i][k] = mesh.positions[3 * std::size_t{mesh.triangles[3 * face + i]} + k];
        }
    }
    double length = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t u = (k + 1) % 3, v = (k + 2) % 3;
        normal[k] = (corner[1][u] - corner[0][u]) * (corner[2][v] - corner[0][v]) -
                    (corner[1][v] - corner[0][v]) * (corner[2][u] - corner[0][u]);
        length += normal[k] * normal[k];
    }
    length = std::sqrt(length);
    for (double& n : normal) n = length > 0 ? n / length : 0;
    for (std::size_t k = 0; k < 3; ++k, p += 4) store_little_endian(p, static_cast<float>(normal[k]));
    for (const auto& position : corner) {
        for (const double x : position) {
            store_little_endian(p, static_cast<float>(x));
            p += 4;
        }
    }
    store_little_endian(p, std::uint16_t{0});
}

void write_stl(const std::string& path, AtomicFile& file, const MeshView& mesh) {
    if (mesh.face_count() > std::numeric_limits<std::uint32_t>::max()) {
        throw Error(ErrorCode::file_write, path + ": STL cannot hold more than 4294967295 facets; write PLY");
    }
    std::string prefix(io::stl_prefix_bytes, '\0');
    constexpr std::string_view title = "binary STL written by quadseg";
    prefix.replace(0, title.size(), title);
    store_little_endian(prefix.data() + io::stl_header_bytes, static_cast<std::uint32_t>(mesh.face_count()));
    file.write(prefix);
    write_blocks<RawBytes>(file, mesh.face_count(), [&](std::size_t begin, std::size_t end, RawBytes& out) {
        char* const facets = out.make((end - begin) * io::stl_facet_bytes);
        for (std::size_t f = begin; f < end; ++f) write_facet(facets + (f - begin) * io::stl_facet_bytes, mesh, f);
    });
}

bool ends_with(const std::string& path, std::string_view ending) {
    if (path.size() < ending.size()) return false;
    return std::equal(ending.begin(), ending.end(), path.end() - static_cast<std::ptrdiff_t>(ending.size()),
                      [](char a, char b) { return a == (b >= 'A' && b <= 'Z' ? b - 'A' + 'a' : b); });
}

}  // namespace

void write_ply(const std::string& path, const MeshView& mesh, const FaceColors& faces) {
    check_arrays(path, mesh);
    if (!faces.labels.empty() && faces.labels.size() != mesh.face_count()) {
        throw Error(ErrorCode::invalid_argument, path + ": there must be one label a face");
    }
    if (!faces.rgb.empty() && faces.rgb.size() != 3 * mesh.face_count()) {
        throw Error(ErrorCode::invalid_argument, path + ": there must be three colour values a face");
    }
    AtomicFile file(path);
    const bool floats = all_floats(mesh.positions);
    file.write(ply_header(mesh, faces, floats));
    if (floats) {
        write_ply_positions<float>(file, mesh.positions);
    } else {
        write_ply_positions<double>(file, mesh.positions);
    }
    const bool coloured = !faces.rgb.empty(), labelled = !faces.labels.empty();
    if (coloured && labelled) {
        write_ply_faces<true, true>(file, mesh.triangles, faces);
    } else if (coloured) {
        write_ply_faces<true, false>(file, mesh.triangles, faces);
    } else if (labelled) {
        write_ply_faces<false, true>(file, mesh.triangles, faces);
    } else {
        write_ply_faces<false, false>(file, mesh.triangles, faces);
    }
    file.commit();
}

void write_mesh(const std::string& path, const MeshView& mesh) {
    check_arrays(path, mesh);
    if (ends_with(path, ".ply")) {
        write_ply(path, mesh);
        return;
    }
    const bool off = ends_with(path, ".off"), obj = ends_with(path, ".obj"), stl = ends_with(path, ".stl");
    if (!off && !obj && !stl) {
        throw Error(ErrorCode::invalid_argument, path + ": the name must end in .ply, .off, .obj or .stl");
    }
    AtomicFile file(path);
    if (off) write_off(file, mesh);
    if (obj) write_obj(file, mesh);
    if (stl) write_stl(path, file, mesh);
    file.commit();
}

}  // namespace quadseg
