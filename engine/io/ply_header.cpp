#include "io/ply_header.h"

#include "io/mesh_faults.h"
#include "io/numbers.h"

#include <algorithm>

namespace quadseg::io {
namespace {

struct TypeName {
    std::string_view name;
    PlyType type;
};
constexpr TypeName type_names[] = {
    {"char", PlyType::int8},       {"int8", PlyType::int8},      {"uchar", PlyType::uint8},
    {"uint8", PlyType::uint8},     {"short", PlyType::int16},    {"int16", PlyType::int16},
    {"ushort", PlyType::uint16},   {"uint16", PlyType::uint16},  {"int", PlyType::int32},
    {"int32", PlyType::int32},     {"uint", PlyType::uint32},    {"uint32", PlyType::uint32},
    {"int64", PlyType::int64},     {"uint64", PlyType::uint64},  {"float", PlyType::float32},
    {"float32", PlyType::float32}, {"double", PlyType::float64}, {"float64", PlyType::float64},
};

/// Line by line through the header; lines may end in "\n", "\r\n" or "\r".
class HeaderReader {
  public:
    explicit HeaderReader(const FileContents& file) : file_(file), p_(file.begin()) {}

    PlyHeader read() {
        PlyHeader header;
        if (next_word() != "ply") fail("a PLY file should begin with 'ply', not " + quoted());
        end_line();
        read_format(header);
        for (;;) {
            const std::string_view keyword = next_word();
            if (keyword == "end_header") break;
            if (keyword == "element") {
                read_element(header);
            } else if (keyword == "property") {
                if (header.elements.empty()) fail("a property stands before the first element");
                read_property(header.elements.back());
            } else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty()) {
                fail(quoted() + " is no header keyword of PLY");
            }
            end_line();
        }
        end_line();
        header.body = std::min(p_, file_.end());
        return header;
    }

    [[noreturn]] void fail(const std::string& text) const {
        const auto breaks = [](const char* first, const char* last) {
            std::ptrdiff_t count = 0;
            for (; first < last; ++first) count += *first == '\n' || (*first == '\r' && first[1] != '\n');
            return count;
        };
        file_.fail(ErrorCode::file_format, "line " + std::to_string(1 + breaks(file_.begin(), word_)) + ": " + text);
    }

  private:
    /// Empty at the end of the line.
    std::string_view next_word() {
        while (p_ < file_.end() && (*p_ == ' ' || *p_ == '\t')) ++p_;
        word_ = p_;
        while (p_ < file_.end() && !is_blank(*p_) && *p_ != '\n') ++p_;
        if (word_ >= file_.end()) fail("the file ends within its header; it is truncated");
        return {word_, static_cast<std::size_t>(p_ - word_)};
    }
    std::string quoted() const { return quoted_word(word_); }

    void end_line() {
        while (*p_ != '\n' && *p_ != '\r') ++p_;
        p_ += *p_ == '\r' && p_[1] == '\n' && p_ + 1 < file_.end() ? 2 : 1;
        p_ = std::min(p_, file_.end());
    }

    void read_format(PlyHeader& header) {
        std::string_view keyword = next_word();
        while (keyword == "comment" || keyword == "obj_info") {
            end_line();
            keyword = next_word();
        }
        if (keyword != "format") fail("the line 'format ...' should stand here, not " + quoted());
        const std::string_view encoding = next_word();
        if (encoding == "ascii") {
            header.encoding = PlyEncoding::ascii;
        } else if (encoding == "binary_little_endian") {
            header.encoding = PlyEncoding::little_endian;
        } else if (encoding == "binary_big_endian") {
            header.encoding = PlyEncoding::big_endian;
        } else {
            fail(quoted() + " is no format of PLY (ascii, binary_little_endian, binary_big_endian)");
        }
        if (next_word() != "1.0") fail("version " + quoted() + " of PLY is not known, only 1.0");
        end_line();
    }

    void read_element(PlyHeader& header) {
        PlyElement element;
        element.name = next_word();
        if (element.name.empty()) fail("an element needs a name");
        if (element.name == "tristrips") {
            fail("triangle strips (element tristrips) are not supported; convert the mesh to one with faces");
        }
        for (const PlyElement& other : header.elements) {
            if (other.name == element.name) fail("the element " + quoted() + " stands here a second time");
        }
        const std::string_view digits = next_word();
        const char* p = digits.data();
        std::int64_t count = 0;
        if (digits.empty() || !take_digits(p, count) || p != digits.data() + digits.size() || count < 0) {
            fail("the number of elements should stand here, not " + quoted());
        }
        element.count = static_cast<std::size_t>(count);
        header.elements.push_back(std::move(element));
    }

    void read_property(PlyElement& element) {
        PlyProperty property;
        std::string_view word = next_word();
        if (word == "list") {
            property.list_size_type = read_type(next_word());
            if (!is_integer(*property.list_size_type)) fail("the size of a list must be an integer, not " + quoted());
            word = next_word();
        }
        property.type = read_type(word);
        property.name = next_word();
        if (property.name.empty()) fail("a property needs a name");
        if (element.find(property.name) != nullptr) fail("the property " + quoted() + " stands here a second time");
        element.properties.push_back(property);
    }

    PlyType read_type(std::string_view word) const {
        for (const TypeName& known : type_names) {
            if (known.name == word) return known.type;
        }
        fail(quoted() + " is no type of PLY (char, uchar, short, ushort, int, uint, float, double)");
    }

    const FileContents& file_;
    const char* p_;
    const char* word_ = nullptr;
};

[[noreturn]] void fail_header(const FileContents& file, const std::string& text) {
    file.fail(ErrorCode::file_format, "header: " + text);
}

std::size_t find_element(const FileContents& file, const PlyHeader& header, std::string_view name,
                         const std::string& otherwise) {
    for (std::size_t e = 0; e < header.elements.size(); ++e) {
        if (header.elements[e].name == name) return e;
    }
    fail_header(file, otherwise);
}

void find_coordinates(const FileContents& file, PlyHeader& header) {
    constexpr std::string_view names[] = {"x", "y", "z"};
    for (std::size_t k = 0; k < 3; ++k) {
        const PlyProperty* property = header.vertices().find(names[k]);
        if (property == nullptr || property->list_size_type) {
            fail_header(file, "the element vertex has no number '" + std::string(names[k]) + "'");
        }
        header.coordinates[k] = static_cast<std::size_t>(property - header.vertices().properties.data());
    }
}

void find_corner_list(const FileContents& file, PlyHeader& header) {
    const PlyElement& faces = header.faces();
    const PlyProperty* list = faces.find("vertex_indices");
    if (list == nullptr) list = faces.find("vertex_index");
    if (list == nullptr || !list->list_size_type || !is_integer(list->type)) {
        fail_header(file, "the element face has no list of integers 'vertex_indices' or 'vertex_index'");
    }
    header.corner_list = static_cast<std::size_t>(list - faces.properties.data());
}

/// Every count against what the file can hold, before anything is allocated by it.
void check_counts(const FileContents& file, const PlyHeader& header) {
    const auto body = static_cast<std::size_t>(file.end() - header.body);
    for (const PlyElement& element : header.elements) {
        std::size_t least = element.properties.size() * 2;  // ascii: a digit and a separator a property
        if (header.encoding != PlyEncoding::ascii) {
            least = element.scalar_bytes();
            for (const PlyProperty& property : element.properties) {
                if (property.list_size_type) least += ply_size(*property.list_size_type);
            }
        }
        // The last number of a text needs no separator behind it.
        if (element.count > 0 && least > 0 && element.count > (body + 1) / least) {
            fail_header(file, std::to_string(element.count) + " elements '" + std::string(element.name) +
                                  "' cannot be in the " + std::to_string(body) +
                                  " bytes that follow; the file is truncated or its header is wrong");
        }
    }
    if (header.vertices().count > largest_count || header.faces().count > largest_count) {
        fail_header(file, "more vertices or faces than 32-bit indices can name");
    }
}

}  // namespace

const PlyProperty* PlyElement::find(std::string_view property) const noexcept {
    const auto found = std::find_if(properties.begin(), properties.end(),
                                    [&](const PlyProperty& candidate) { return candidate.name == property; });
    return found == properties.end() ? nullptr : &*found;
}

bool PlyElement::has_list() const noexcept {
    return std::any_of(properties.begin(), properties.end(),
                       [](const PlyProperty& property) { return property.list_size_type.has_value(); });
}

std::size_t PlyElement::scalar_bytes() const noexcept {
    std::size_t bytes = 0;
    for (const PlyProperty& property : properties) {
        if (!property.list_size_type) bytes += ply_size(property.type);
    }
    return bytes;
}

PlyHeader read_ply_header(const FileContents& file) {
    PlyHeader header = HeaderReader(file).read();
    header.vertex_element = find_element(file, header, "vertex", "there is no element 'vertex'; this is no mesh");
    header.face_element =
        find_element(file, header, "face", "there is no element 'face'; this is a point cloud, not a mesh");
    find_coordinates(file, header);
    find_corner_list(file, header);
    check_counts(file, header);
    return header;
}

}  // namespace quadseg::io
