// Geomview's Object File Format, text. One vertex or face a line; colours, normals and texture coordinates behind the
// position are ignored.
#include "io/faces.h"
#include "io/formats.h"
#include "io/mesh_faults.h"
#include "io/polled_resize.h"
#include "io/text_blocks.h"
#include "runtime/parallel.h"

#include <array>
#include <cmath>

namespace quadseg::io {
namespace {

struct Header {
    std::size_t vertices = 0, faces = 0;
    const char* body = nullptr;
};

/// Moves p over blanks, line ends and comments.
void skip_to_data(const char*& p, const char* end) noexcept {
    for (;;) {
        skip_blanks(p);
        if (*p == '#') {
            p = next_line(p, end) - 1;
        }
        if (*p != '\n' || p >= end) return;
        ++p;
        if (p >= end) return;
    }
}

std::size_t take_count(const FileContents& file, const char*& p, const char* name) {
    skip_to_data(p, file.end());
    const char* where = p;
    std::int64_t count = 0;
    if (p >= file.end() || !take_integer(p, count) || count < 0) {
        file.fail_at_line({ErrorCode::file_format, where,
                           std::string("the number of ") + name + " should stand here, not " +
                               (where >= file.end() ? "the end of the file" : quoted_word(where))});
    }
    // A vertex or face takes two bytes at the very least.
    if (static_cast<std::size_t>(count) > file.size() / 2 || static_cast<std::uint64_t>(count) > largest_count) {
        file.fail_at_line({ErrorCode::file_format, where,
                           std::to_string(count) + " " + name + " cannot be in a file of " +
                               std::to_string(file.size()) + " bytes; it is truncated or its counts are wrong"});
    }
    return static_cast<std::size_t>(count);
}

Header read_header(const FileContents& file) {
    const char* p = file.begin();
    skip_to_data(p, file.end());
    const char* where = p;
    const char* after = p;
    const std::string_view keyword = take_word(after);
    if (is_off_keyword(keyword)) {
        p = after;
        const char* option = p;
        if (take_word(option) == "BINARY") {
            file.fail_at_line({ErrorCode::file_format, where,
                               "binary OFF is not supported; convert the mesh to text OFF or binary PLY"});
        }
        if (keyword.find('4') != std::string_view::npos || keyword.find('n') != std::string_view::npos) {
            file.fail_at_line(
                {ErrorCode::file_format, where,
                 "vertices of " + quoted_word(where) + " are not three-dimensional; convert the mesh to OFF"});
        }
    }
    Header header;
    header.vertices = take_count(file, p, "vertices");
    header.faces = take_count(file, p, "faces");
    std::int64_t edges = 0;  // often left out, never needed
    take_integer(p, edges);
    skip_blanks(p);
    if (*p != '\n' && *p != '#') {
        file.fail_at_line(
            {ErrorCode::file_format, p, "the line of the counts should end here, not go on with " + quoted_word(p)});
    }
    header.body = std::min(next_line(p, file.end()), file.end());
    return header;
}

std::optional<Fault> read_vertex(const char* p, const char* end, std::size_t vertex, double* out) {
    for (int k = 0; k < 3; ++k) {
        if (!take_real(p, end, out[k])) {
            return Fault{ErrorCode::file_format, p,
                         "vertex " + std::to_string(vertex) + " (counted from 0) needs three coordinates; found " +
                             quoted_word(p)};
        }
    }
    if (!std::isfinite(out[0]) || !std::isfinite(out[1]) || !std::isfinite(out[2])) return not_finite(p, vertex);
    return {};
}

/// A size of three and as many indices in range, plainly written; else nothing is taken.
bool read_triangle(const char* p, std::size_t vertices, FaceBlock& block) {
    std::uint32_t size = 0;
    if (!take_plain_index(p, size) || size != 3) return false;
    std::array<std::uint32_t, 3> corners;
    for (std::uint32_t& corner : corners) {
        if (!take_plain_index(p, corner) || corner >= vertices) return false;
    }
    for (const std::uint32_t corner : corners) block.corners.push_back(corner);
    block.close_face(3);
    return true;
}

std::optional<Fault> read_face(const char* p, std::size_t face, std::size_t vertices, FaceBlock& block) {
    if (read_triangle(p, vertices, block)) return {};
    std::int64_t size = 0;
    if (!take_integer(p, size)) {
        return Fault{
            ErrorCode::file_format, p,
            "face " + std::to_string(face) + " (counted from 0) needs its number of corners; found " + quoted_word(p)};
    }
    if (size < 3) return too_few_corners(p, face, size);
    for (std::int64_t k = 0; k < size; ++k) {
        std::int64_t index = 0;
        if (!take_integer(p, index)) {
            return Fault{ErrorCode::file_format, p,
                         "face " + std::to_string(face) + " (counted from 0) needs " + std::to_string(size) +
                             " vertex indices; found " + quoted_word(p)};
        }
        if (index < 0 || static_cast<std::size_t>(index) >= vertices) {
            return index_out_of_range(p, face, index, vertices, 0);
        }
        block.corners.push_back(static_cast<std::uint32_t>(index));
    }
    block.close_face(static_cast<std::size_t>(size));
    return {};
}

}  // namespace

bool is_off_keyword(std::string_view word) noexcept {
    for (const std::string_view prefix : {"ST", "C", "N", "4", "n"}) {
        if (word.substr(0, prefix.size()) == prefix) word.remove_prefix(prefix.size());
    }
    return word == "OFF";
}

Mesh read_off(const FileContents& file, const runtime::RunControl& control) {
    const Header header = read_header(file);
    std::vector<TextBlock> blocks = cut_text(header.body, file.end());
    const std::size_t lines = count_data_lines(blocks, file.end(), true, control);
    if (lines < header.vertices + header.faces) {
        file.fail_at_line({ErrorCode::file_format, file.end(),
                           "the file ends after " + std::to_string(lines) + " of " + std::to_string(header.vertices) +
                               " vertex and " + std::to_string(header.faces) +
                               " face lines; it is truncated, or not one vertex or face a line"});
    }
    Mesh mesh;
    polled_resize(mesh.positions, 3 * header.vertices, control);
    std::vector<FaceBlock> faces(blocks.size());
    std::vector<std::optional<Fault>> faults(blocks.size());
    runtime::parallel_for(blocks.size(), 1, [&](std::size_t b) {
        control.check();
        for_data_lines(
            blocks[b], file.end(), true, 0, header.vertices + header.faces, [&](const char* p, std::size_t item) {
                faults[b] = item < header.vertices ? read_vertex(p, file.end(), item, &mesh.positions[3 * item])
                                                   : read_face(p, item - header.vertices, header.vertices, faces[b]);
                return !faults[b];
            });
    });
    if (const Fault* fault = first_fault(faults)) file.fail_at_line(*fault);
    append_faces(mesh, faces, control);
    return mesh;
}

}  // namespace quadseg::io
