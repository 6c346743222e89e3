#include <quadseg/io.h>

#include "io/formats.h"
#include "io/numbers.h"
#include "io/stl.h"
#include "runtime/parallel.h"

#include <algorithm>
#include <array>

namespace quadseg {
namespace io {
namespace {

std::string lower_case(std::string_view text) {
    std::string lower(text);
    for (char& c : lower) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    return lower;
}

std::string extension(const std::string& path) {
    const std::size_t dot = path.find_last_of("./");
    return dot == std::string::npos || path[dot] == '/' ? "" : lower_case(path.substr(dot + 1));
}

/// The first word of the text that is no comment.
std::string_view first_word(const FileContents& file) {
    for (const char* p = file.begin(); p < file.end(); p = next_line(p, file.end())) {
        skip_blanks(p);
        if (*p != '\n' && *p != '#') return take_word(p);
    }
    return {};
}

bool begins_obj(std::string_view word) noexcept {
    constexpr std::array<std::string_view, 12> keywords{"v", "vt", "vn", "vp", "f",      "l",
                                                        "p", "g",  "o",  "s",  "mtllib", "usemtl"};
    return std::find(keywords.begin(), keywords.end(), word) != keywords.end();
}

constexpr std::size_t inspected_bytes = 512;

bool looks_binary(const FileContents& file) noexcept {
    return file.text().substr(0, inspected_bytes).find('\0') != std::string_view::npos;
}
bool is_text(const FileContents& file) noexcept {
    const std::string_view text = file.text();
    if (text.starts_with("ply") && text.substr(0, inspected_bytes).find("format binary") != std::string_view::npos) {
        return false;
    }
    return !looks_binary(file) && !has_binary_stl_size(text);
}

/// What an unreadable file is likely to be, for the message.
std::string foreign_format(const FileContents& file) {
    const std::string_view text = file.text();
    if (text.starts_with("\x1f\x8b")) return "it is compressed by gzip; unpack it first";
    if (text.starts_with("PK\x03\x04")) return "it is a ZIP archive (3MF?); convert it first";
    if (text.starts_with("glTF")) return "it is binary glTF; convert it first";
    if (text.starts_with("ISO-10303-21")) return "it is a STEP file, not a mesh; tessellate it first";
    if (looks_binary(file)) return "it is binary data of an unknown kind";
    return "its first word is " + quoted_word(first_word(file).empty() ? file.end() : first_word(file).data());
}

}  // namespace

Format recognise(const FileContents& file) {
    const std::string_view text = file.text();
    const std::string ending = extension(file.path());
    if (text.starts_with("ply") && (text.size() == 3 || is_blank(text[3]) || text[3] == '\n')) return Format::ply;
    if (has_binary_stl_size(text)) return Format::stl_binary;
    const std::string_view word = first_word(file);
    if (is_off_keyword(word)) return Format::off;
    // A truncated binary file may begin so too.
    if (lower_case(word) == "solid") return looks_binary(file) ? Format::stl_binary : Format::stl_ascii;
    if (begins_obj(word)) return Format::obj;
    if (ending == "off") return Format::off;
    if (ending == "obj") return Format::obj;
    if (ending == "ply") return Format::ply;
    if (ending == "stl") return Format::stl_binary;
    return Format::unknown;
}

Mesh read_contents(FileContents& file, const runtime::RunControl& control) {
    if (is_text(file)) file.unify_text();
    const Format format = recognise(file);
    Mesh mesh;
    switch (format) {
        case Format::off:
            mesh = read_off(file, control);
            break;
        case Format::obj:
            mesh = read_obj(file, control);
            break;
        case Format::ply:
            mesh = read_ply(file, control);
            break;
        case Format::stl_ascii:
            mesh = read_stl_ascii(file, control);
            break;
        case Format::stl_binary:
            mesh = read_stl_binary(file, control);
            break;
        case Format::unknown:
            file.fail(ErrorCode::file_format, "line 1: is none of OFF, OBJ, PLY, STL: " + foreign_format(file));
    }
    if (mesh.triangles.empty()) {
        file.fail(ErrorCode::empty_mesh, "has " + std::to_string(mesh.positions.size() / 3) +
                                             " vertices but no face; there is nothing to segment");
    }
    return mesh;
}

}  // namespace io

Mesh read_mesh(const std::string& path, Context* context) {
    const runtime::RunControl control(context);
    Mesh mesh;
    try {
        runtime::in_arena(context != nullptr ? context->threads() : 0, [&] {
            control.check();
            control.report(Phase::read, 0);
            io::FileContents file(path, control, context != nullptr ? context->memory_limit() : 0);
            control.report(Phase::read, 0.3);
            mesh = io::read_contents(file, control);
            control.report(Phase::read, 1);
        });
    } catch (const runtime::Stopped& stopped) {
        throw Error(ErrorCode::cancelled,
                    path + ": reading was stopped " + (stopped.deadline ? "by the deadline" : "by the caller"));
    }
    return mesh;
}

}  // namespace quadseg
