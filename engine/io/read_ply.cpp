// PLY, dispatched by encoding, and its text form: one element a line.
#include "io/faces.h"
#include "io/formats.h"
#include "io/mesh_faults.h"
#include "io/ply_binary.h"
#include "io/ply_header.h"
#include "io/polled_resize.h"
#include "io/text_blocks.h"
#include "runtime/parallel.h"

#include <algorithm>
#include <cmath>

namespace quadseg::io {
namespace {

std::string name_of(const PlyElement& element, std::size_t index) {
    return std::string(element.name) + " " + std::to_string(index) + " (counted from 0)";
}

Fault bad_value(const char* where, const PlyElement& element, std::size_t index, const PlyProperty& property) {
    return {ErrorCode::file_format, where,
            name_of(element, index) + " needs a number for '" + std::string(property.name) + "'; found " +
                quoted_word(where)};
}

/// The lines of one element.
class TextElement {
  public:
    TextElement(const FileContents& file, const PlyElement& element) : end_(file.end()), element_(element) {}

    /// Parses a line; visit_scalar(property, value, where) and visit_list(property, size, entry, index, where) may
    /// return a fault.
    template <class VisitScalar, class VisitEntry>
    std::optional<Fault> parse(const char* p, std::size_t index, const VisitScalar& visit_scalar,
                               const VisitEntry& visit_entry) const {
        for (std::size_t k = 0; k < element_.properties.size(); ++k) {
            const PlyProperty& property = element_.properties[k];
            skip_blanks(p);
            const char* where = p;
            if (!property.list_size_type) {
                double value = 0;
                if (!take_real(p, end_, value)) return bad_value(where, element_, index, property);
                if (auto fault = visit_scalar(k, value, where)) return fault;
                continue;
            }
            std::int64_t size = 0;
            if (!take_integer(p, size) || size < 0) return bad_value(where, element_, index, property);
            for (std::int64_t i = 0; i < size; ++i) {
                skip_blanks(p);
                if (*p == '\n') return bad_value(p, element_, index, property);
                if (auto fault = visit_entry(k, size, i, p)) return fault;
                skip_word(p);
            }
            if (size == 0) {
                if (auto fault = visit_entry(k, 0, -1, where)) return fault;
            }
        }
        skip_blanks(p);
        if (*p != '\n') {
            return Fault{ErrorCode::file_format, p,
                         name_of(element_, index) + " should end here, not go on with " + quoted_word(p)};
        }
        return {};
    }

  private:
    const char* end_;
    const PlyElement& element_;
};

std::optional<Fault> read_vertex(const FileContents& file, const PlyHeader& header, const char* line,
                                 std::size_t vertex, double* out) {
    return TextElement(file, header.vertices())
        .parse(
            line, vertex,
            [&](std::size_t property, double value, const char* where) -> std::optional<Fault> {
                for (int k = 0; k < 3; ++k) {
                    if (header.coordinates[k] != property) continue;
                    if (!std::isfinite(value)) return not_finite(where, vertex);
                    out[k] = value;
                }
                return {};
            },
            [](std::size_t, std::int64_t, std::int64_t, const char*) -> std::optional<Fault> { return {}; });
}

std::optional<Fault> read_face(const FileContents& file, const PlyHeader& header, const char* line, std::size_t face,
                               FaceBlock& block) {
    const std::size_t vertices = header.vertices().count;
    return TextElement(file, header.faces())
        .parse(
            line, face, [](std::size_t, double, const char*) -> std::optional<Fault> { return {}; },
            [&](std::size_t property, std::int64_t size, std::int64_t i, const char* where) -> std::optional<Fault> {
                if (property != header.corner_list) return {};
                if (size < 3) return too_few_corners(where, face, size);
                std::int64_t index = 0;
                const char* p = where;
                if (!take_integer(p, index)) {
                    return bad_value(where, header.faces(), face, header.faces().properties[property]);
                }
                if (index < 0 || static_cast<std::size_t>(index) >= vertices) {
                    return index_out_of_range(where, face, index, vertices, 0);
                }
                block.corners.push_back(static_cast<std::uint32_t>(index));
                if (i + 1 == size) block.close_face(static_cast<std::size_t>(size));
                return {};
            });
}

/// Elements without properties have no lines.
std::size_t lines_of(const PlyElement& element) noexcept {
    return element.properties.empty() ? 0 : element.count;
}

Mesh read_text(const FileContents& file, const PlyHeader& header, const runtime::RunControl& control) {
    std::vector<TextBlock> blocks = cut_text(header.body, file.end());
    const std::size_t lines = count_data_lines(blocks, file.end(), false, control);
    std::size_t first_vertex = 0, first_face = 0, needed = 0;
    for (std::size_t e = 0; e < header.elements.size(); ++e) {
        if (e == header.vertex_element) first_vertex = needed;
        if (e == header.face_element) first_face = needed;
        needed += lines_of(header.elements[e]);
    }
    if (lines < needed) {
        file.fail_at_line({ErrorCode::file_format, file.end(),
                           "the file ends after " + std::to_string(lines) + " of the " + std::to_string(needed) +
                               " lines that its header announces; it is truncated"});
    }
    const std::size_t vertices = header.vertices().count, faces = header.faces().count;
    Mesh mesh;
    polled_resize(mesh.positions, 3 * vertices, control);
    std::vector<FaceBlock> face_blocks(blocks.size());
    std::vector<std::optional<Fault>> faults(blocks.size());
    runtime::parallel_for(blocks.size(), 1, [&](std::size_t b) {
        control.check();
        for_data_lines(blocks[b], file.end(), false, std::min(first_vertex, first_face),
                       std::max(first_vertex + vertices, first_face + faces), [&](const char* p, std::size_t item) {
                           if (item >= first_vertex && item < first_vertex + vertices) {
                               const std::size_t v = item - first_vertex;
                               faults[b] = read_vertex(file, header, p, v, &mesh.positions[3 * v]);
                           } else if (item >= first_face && item < first_face + faces) {
                               faults[b] = read_face(file, header, p, item - first_face, face_blocks[b]);
                           }
                           return !faults[b];
                       });
    });
    if (const Fault* fault = first_fault(faults)) file.fail_at_line(*fault);
    append_faces(mesh, face_blocks, control);
    return mesh;
}

}  // namespace

Mesh read_ply(const FileContents& file, const runtime::RunControl& control) {
    const PlyHeader header = read_ply_header(file);
    return header.encoding == PlyEncoding::ascii ? read_text(file, header, control)
                                                 : read_ply_binary(file, header, control);
}

}  // namespace quadseg::io
