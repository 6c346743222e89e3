// Wavefront OBJ: positions and faces; groups, materials, normals, texture coordinates, lines, points and free-form
// surfaces are skipped.
#include "io/faces.h"
#include "io/formats.h"
#include "io/mesh_faults.h"
#include "io/polled_resize.h"
#include "io/text_blocks.h"
#include "runtime/parallel.h"

#include <algorithm>
#include <cmath>

namespace quadseg::io {
namespace {

/// A negative index counts back from the vertices read so far, some of which are in earlier blocks.
struct RelativeCorner {
    std::size_t corner = 0;
    std::int64_t vertex = 0;  ///< from the first vertex of the block
};

struct Block {
    std::vector<double> positions;
    FaceBlock faces;
    std::vector<RelativeCorner> relative;
    std::optional<Fault> fault;
};

/// Blanks, and line ends behind a backslash.
void skip_space(const char*& p, const char* end) noexcept {
    for (;;) {
        skip_blanks(p);
        if (*p != '\\') return;
        const char* q = p + 1;
        if (*q == '\r') ++q;
        if (q >= end || *q != '\n') return;
        p = q + 1;
    }
}
const char* next_statement(const char* p, const char* end) noexcept {
    for (;;) {
        const char* next = next_line(p, end);
        const char* last = next - 1;
        if (last > p && last[-1] == '\r') --last;
        if (last == p || last[-1] != '\\' || next >= end) return next;
        p = next;
    }
}
bool is_end_of_statement(char c) noexcept {
    return c == '\n' || c == '#';
}
bool is_end_of_word(const char* p) noexcept {
    return is_separator(*p) || *p == '\\';
}

bool take_coordinate(const char*& p, const char* end, double& value) noexcept {
    skip_space(p, end);
    const char* first = p;
    if (*first == '+' && first[1] != '-') ++first;
    const auto result = fast_float::from_chars(first, end, value);
    if (result.ec == std::errc::invalid_argument || !is_end_of_word(result.ptr)) return false;
    p = result.ptr;
    return true;
}

void read_vertex(const char* p, const char* end, Block& block) {
    double position[3];
    for (double& coordinate : position) {
        if (!take_coordinate(p, end, coordinate)) {
            block.fault = Fault{ErrorCode::file_format, p, "a vertex needs three coordinates; found " + quoted_word(p)};
            return;
        }
    }
    if (!std::isfinite(position[0]) || !std::isfinite(position[1]) || !std::isfinite(position[2])) {
        // The number of the vertex is known later only.
        block.fault = Fault{ErrorCode::invalid_mesh, p, {}};
        return;
    }
    block.positions.insert(block.positions.end(), position, position + 3);
}

/// "/texture/normal" behind a vertex index, of which either may be missing.
bool skip_references(const char*& p) noexcept {
    for (int k = 0; k < 2 && *p == '/'; ++k) {
        ++p;
        std::int64_t ignored = 0;
        if (*p != '/' && !is_end_of_word(p) && !take_digits(p, ignored)) return false;
    }
    return is_end_of_word(p);
}

void read_face(const char* p, const char* end, Block& block) {
    const char* start = p;
    std::size_t size = 0;
    for (;; ++size) {
        skip_space(p, end);
        if (is_end_of_statement(*p)) break;
        const char* where = p;
        std::int64_t index = 0;
        if (!take_digits(p, index) || !skip_references(p)) {
            block.fault = Fault{ErrorCode::file_format, where,
                                quoted_word(where) + " is no face corner (v, v/vt, v//vn or v/vt/vn)"};
            return;
        }
        if (index == 0) {
            block.fault = Fault{ErrorCode::invalid_mesh, where,
                                "a face names vertex 0, but vertices are counted from 1; repair the mesh"};
            return;
        }
        if (index < 0) {
            const auto vertices = static_cast<std::int64_t>(block.positions.size() / 3);
            block.relative.push_back({block.faces.corners.size(), vertices + index});
            index = 1;
        }
        // Clamped indices are out of range all the same: there are fewer vertices than this.
        block.faces.corners.push_back(
            static_cast<std::uint32_t>(std::min(index - 1, static_cast<std::int64_t>(largest_count))));
    }
    if (size < 3) {
        block.fault = Fault{ErrorCode::file_format, start,
                            "a face has " + std::to_string(size) + " corners; it needs at least 3"};
        return;
    }
    block.faces.close_face(size);
}

bool is_vertex(const char* p) noexcept {
    return p[0] == 'v' && (is_blank(p[1]) || p[1] == '\n' || p[1] == '\\');
}
/// 'fo' is the 'f' of the first version of the format.
bool is_face(const char* p) noexcept {
    return p[0] == 'f' && (is_blank(p[1]) || p[1] == '\n' || p[1] == '\\' || (p[1] == 'o' && is_blank(p[2])));
}
/// Any statement of the format or of its dialects begins with a word; garbage does not.
bool is_keyword(std::string_view word) noexcept {
    const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
    return word.size() <= 32 && letter(word[0]) &&
           std::all_of(word.begin(), word.end(), [&](char c) { return letter(c) || (c >= '0' && c <= '9'); });
}

void read_block(const TextBlock& text, const char* end, Block& block) {
    for (const char* p = text.begin; p < text.end && !block.fault; p = next_statement(p, end)) {
        skip_blanks(p);
        if (is_vertex(p)) {
            read_vertex(p + 1, end, block);
        } else if (is_face(p)) {
            read_face(p + (p[1] == 'o' ? 2 : 1), end, block);
        } else if (!is_end_of_statement(*p) && *p != '\\') {
            const char* q = p;
            if (!is_keyword(take_word(q))) {
                block.fault = Fault{ErrorCode::file_format, p, quoted_word(p) + " is no OBJ statement"};
            }
        }
    }
}

/// Where the face stands, for a message.
const char* find_face(const TextBlock& text, const char* end, std::size_t face) noexcept {
    for (const char* p = text.begin; p < text.end; p = next_statement(p, end)) {
        skip_blanks(p);
        if (is_face(p) && face-- == 0) return p;
    }
    return text.begin;
}

/// The position in `block` of the corner that is out of range, if any; resolves relative indices.
std::optional<Fault> resolve(const TextBlock& text, const char* end, Block& block, std::size_t first_vertex,
                             std::size_t first_face, std::size_t vertices) {
    std::size_t bad_corner = block.faces.corners.size();
    std::int64_t bad_index = 0;
    for (std::size_t c = 0; c < block.faces.corners.size(); ++c) {
        if (block.faces.corners[c] >= vertices) {
            bad_corner = c;
            bad_index = std::int64_t{block.faces.corners[c]} + 1;
            break;
        }
    }
    for (const RelativeCorner& relative : block.relative) {
        const std::int64_t vertex = static_cast<std::int64_t>(first_vertex) + relative.vertex;
        if (vertex < 0 || vertex >= static_cast<std::int64_t>(vertices)) {
            if (relative.corner <= bad_corner) {
                bad_corner = relative.corner;
                bad_index = vertex + 1;
            }
            break;
        }
        block.faces.corners[relative.corner] = static_cast<std::uint32_t>(vertex);
    }
    if (bad_corner == block.faces.corners.size()) return {};
    std::size_t face = bad_corner / 3;
    if (!block.faces.sizes.empty()) {
        face = 0;
        for (std::size_t c = block.faces.sizes[0]; c <= bad_corner; c += block.faces.sizes[face]) ++face;
    }
    return index_out_of_range(find_face(text, end, face), first_face + face, bad_index, vertices, 1);
}

}  // namespace

Mesh read_obj(const FileContents& file, const runtime::RunControl& control) {
    const std::vector<TextBlock> texts = cut_text(file.begin(), file.end(), Continuation::backslash);
    std::vector<Block> blocks(texts.size());
    runtime::parallel_for(texts.size(), 1, [&](std::size_t b) {
        control.check();
        read_block(texts[b], file.end(), blocks[b]);
    });
    control.check();
    std::vector<std::size_t> first_vertex(blocks.size()), first_face(blocks.size());
    std::size_t vertices = 0, face_count = 0;
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        first_vertex[b] = vertices;
        first_face[b] = face_count;
        vertices += blocks[b].positions.size() / 3;
        face_count += blocks[b].faces.faces;
        if (!blocks[b].fault) continue;
        Fault fault = *blocks[b].fault;
        if (fault.text.empty()) fault = not_finite(fault.where, vertices);
        file.fail_at_line(fault);
    }
    if (vertices > largest_count || face_count > largest_count) {
        file.fail(ErrorCode::file_format, "has more vertices or faces than 32-bit indices can name");
    }
    Mesh mesh;
    polled_resize(mesh.positions, 3 * vertices, control);
    std::vector<FaceBlock> faces(blocks.size());
    std::vector<std::optional<Fault>> faults(blocks.size());
    runtime::parallel_for(blocks.size(), 1, [&](std::size_t b) {
        control.check();
        std::copy(blocks[b].positions.begin(), blocks[b].positions.end(),
                  mesh.positions.begin() + static_cast<std::ptrdiff_t>(3 * first_vertex[b]));
        blocks[b].positions = {};
        faults[b] = resolve(texts[b], file.end(), blocks[b], first_vertex[b], first_face[b], vertices);
        faces[b] = std::move(blocks[b].faces);
    });
    if (const Fault* fault = first_fault(faults)) file.fail_at_line(*fault);
    append_faces(mesh, faces, control);
    return mesh;
}

}  // namespace quadseg::io
