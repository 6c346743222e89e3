#include "io/ply_binary.h"

#include "io/bytes.h"
#include "io/faces.h"
#include "io/mesh_faults.h"
#include "io/polled_resize.h"
#include "runtime/parallel.h"

#include <atomic>
#include <cmath>
#include <limits>

namespace quadseg::io {
namespace {

constexpr std::size_t block_elements = 16384;

/// Calls body with a null pointer of the type's C++ type.
template <class Body>
decltype(auto) with_type(PlyType type, const Body& body) {
    switch (type) {
        case PlyType::int8:
            return body(static_cast<const std::int8_t*>(nullptr));
        case PlyType::uint8:
            return body(static_cast<const std::uint8_t*>(nullptr));
        case PlyType::int16:
            return body(static_cast<const std::int16_t*>(nullptr));
        case PlyType::uint16:
            return body(static_cast<const std::uint16_t*>(nullptr));
        case PlyType::int32:
            return body(static_cast<const std::int32_t*>(nullptr));
        case PlyType::uint32:
            return body(static_cast<const std::uint32_t*>(nullptr));
        case PlyType::int64:
            return body(static_cast<const std::int64_t*>(nullptr));
        case PlyType::uint64:
            return body(static_cast<const std::uint64_t*>(nullptr));
        case PlyType::float32:
            return body(static_cast<const float*>(nullptr));
        case PlyType::float64:
            return body(static_cast<const double*>(nullptr));
    }
    return body(static_cast<const double*>(nullptr));
}

template <std::endian Order>
class BodyReader {
  public:
    BodyReader(const FileContents& file, const PlyHeader& header, const runtime::RunControl& control)
        : file_(file), header_(header), control_(control) {}

    Mesh read() {
        Mesh mesh;
        const char* p = header_.body;
        const char* vertices = nullptr;
        const char* faces = nullptr;
        for (std::size_t e = 0; e < header_.elements.size(); ++e) {
            if (e == header_.vertex_element) vertices = p;
            if (e == header_.face_element) faces = p;
            // Triangles alone in the last element need no walk to find its end.
            if (e == header_.face_element && e + 1 == header_.elements.size()) break;
            p = behind(header_.elements[e], p);
        }
        read_vertices(vertices, mesh);
        if (!read_triangles(faces, mesh)) read_polygons(faces, mesh);
        return mesh;
    }

  private:
    using Walk = std::vector<const char*>;

    [[noreturn]] void fail_truncated(const char* where, const PlyElement& element, std::size_t index) const {
        file_.fail_at_byte({ErrorCode::file_format, where,
                            std::string(element.name) + " " + std::to_string(index) +
                                " (counted from 0) does not fit into the file; it is truncated or damaged"});
    }
    bool fits(const char* p, std::size_t count, std::size_t bytes) const noexcept {
        return bytes == 0 || count <= static_cast<std::size_t>(file_.end() - p) / bytes;
    }

    static std::int64_t load_integer(PlyType type, const char* p) noexcept {
        switch (type) {
            case PlyType::int8:
                return load<std::int8_t, Order>(p);
            case PlyType::uint8:
                return load<std::uint8_t, Order>(p);
            case PlyType::int16:
                return load<std::int16_t, Order>(p);
            case PlyType::uint16:
                return load<std::uint16_t, Order>(p);
            case PlyType::int32:
                return load<std::int32_t, Order>(p);
            case PlyType::uint32:
                return load<std::uint32_t, Order>(p);
            default:
                break;
        }
        if (type == PlyType::int64) return load<std::int64_t, Order>(p);
        const auto value = load<std::uint64_t, Order>(p);
        constexpr auto limit = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
        return static_cast<std::int64_t>(std::min(value, limit));
    }

    /// Walks over one element and returns where it ends. visit_list(property, size, entries) sees its lists; null if
    /// the element does not fit into the file.
    template <class VisitList>
    const char* walk(const PlyElement& element, const char* p, const VisitList& visit_list) const {
        for (std::size_t k = 0; k < element.properties.size(); ++k) {
            const PlyProperty& property = element.properties[k];
            if (!property.list_size_type) {
                if (!fits(p, 1, ply_size(property.type))) return nullptr;
                p += ply_size(property.type);
                continue;
            }
            if (!fits(p, 1, ply_size(*property.list_size_type))) return nullptr;
            const std::int64_t size = load_integer(*property.list_size_type, p);
            p += ply_size(*property.list_size_type);
            if (size < 0 || !fits(p, static_cast<std::size_t>(size), ply_size(property.type))) return nullptr;
            visit_list(k, size, p);
            p += static_cast<std::size_t>(size) * ply_size(property.type);
        }
        return p;
    }

    /// Where all of an element ends; `starts` gets the place of every block_elements-th one.
    const char* behind(const PlyElement& element, const char* p, Walk* starts = nullptr) const {
        if (!element.has_list()) {
            const std::size_t bytes = element.scalar_bytes();
            if (!fits(p, element.count, bytes)) {
                const auto whole = static_cast<std::size_t>(file_.end() - p) / bytes;
                fail_truncated(p + whole * bytes, element, whole);
            }
            return p + element.count * bytes;
        }
        for (std::size_t i = 0; i < element.count; ++i) {
            if (i % block_elements == 0) {
                control_.check();
                if (starts != nullptr) starts->push_back(p);
            }
            const char* next = walk(element, p, [](std::size_t, std::int64_t, const char*) {});
            if (next == nullptr) fail_truncated(p, element, i);
            p = next;
        }
        return p;
    }

    /// One coordinate of consecutive vertices without lists.
    static bool load_coordinates(PlyType type, const char* p, std::size_t stride, std::size_t count, double* out) {
        return with_type(type, [&]<class T>(const T*) {
            bool finite = true;
            for (std::size_t i = 0; i < count; ++i) {
                const auto value = static_cast<double>(load<T, Order>(p + i * stride));
                finite = finite && std::isfinite(value);
                out[3 * i] = value;
            }
            return finite;
        });
    }

    void read_vertices(const char* p, Mesh& mesh) const {
        const PlyElement& element = header_.vertices();
        polled_resize(mesh.positions, 3 * element.count, control_);
        Walk starts;
        const std::size_t stride = element.has_list() ? 0 : element.scalar_bytes();
        if (stride == 0) behind(element, p, &starts);
        std::vector<std::optional<Fault>> faults((element.count + block_elements - 1) / block_elements);
        runtime::parallel_blocks(element.count, block_elements, [&](std::size_t begin, std::size_t end) {
            control_.check();
            const std::size_t b = begin / block_elements;
            double* out = &mesh.positions[3 * begin];
            if (stride == 0) {
                load_vertices_with_lists(starts[b], end - begin, out);
            } else {
                for (std::size_t k = 0; k < 3; ++k) {
                    const std::size_t property = header_.coordinates[k];
                    load_coordinates(element.properties[property].type, p + begin * stride + offset(element, property),
                                     stride, end - begin, out + k);
                }
            }
            for (std::size_t v = begin; v < end && !faults[b]; ++v) {
                const double* x = &mesh.positions[3 * v];
                if (std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2])) continue;
                faults[b] = not_finite(stride == 0 ? starts[b] : p + v * stride, v);
            }
        });
        report_first(faults);
    }

    void load_vertices_with_lists(const char* p, std::size_t count, double* out) const {
        const PlyElement& element = header_.vertices();
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t k = 0; k < element.properties.size(); ++k) {
                const PlyProperty& property = element.properties[k];
                if (property.list_size_type) {
                    const auto size = static_cast<std::size_t>(load_integer(*property.list_size_type, p));
                    p += ply_size(*property.list_size_type) + size * ply_size(property.type);
                    continue;
                }
                for (std::size_t c = 0; c < 3; ++c) {
                    if (header_.coordinates[c] == k) load_coordinates(property.type, p, 0, 1, out + 3 * i + c);
                }
                p += ply_size(property.type);
            }
        }
    }

    static std::size_t offset(const PlyElement& element, std::size_t property) noexcept {
        std::size_t bytes = 0;
        for (std::size_t k = 0; k < property; ++k) bytes += ply_size(element.properties[k].type);
        return bytes;
    }

    void report_first(const std::vector<std::optional<Fault>>& faults) const {
        for (const auto& fault : faults) {
            if (fault) file_.fail_at_byte(*fault);
        }
    }

    /// The common case: one list of three indices, so that every face has the same size. False if it is not so.
    bool read_triangles(const char* p, Mesh& mesh) const {
        const PlyElement& element = header_.faces();
        for (std::size_t k = 0; k < element.properties.size(); ++k) {
            if (k != header_.corner_list && element.properties[k].list_size_type) return false;
        }
        const PlyProperty& list = element.properties[header_.corner_list];
        const std::size_t size_bytes = ply_size(*list.list_size_type);
        const std::size_t stride = element.scalar_bytes() + size_bytes + 3 * ply_size(list.type);
        if (!fits(p, element.count, stride)) return false;
        const char* first = p + offset(element, header_.corner_list);
        if (element.count > 0 && load_integer(*list.list_size_type, first) != 3) return false;
        std::atomic<bool> uniform{true};
        polled_resize(mesh.triangles, 3 * element.count, control_);
        std::vector<std::optional<Fault>> faults((element.count + block_elements - 1) / block_elements);
        runtime::parallel_blocks(element.count, block_elements, [&](std::size_t begin, std::size_t end) {
            control_.check();
            if (!uniform.load(std::memory_order_relaxed)) return;
            const char* face = first + begin * stride;
            bool triangles = true;
            for (std::size_t f = begin; f < end; ++f, face += stride) {
                triangles = triangles && load_integer(*list.list_size_type, face) == 3;
            }
            if (!triangles) {
                uniform.store(false, std::memory_order_relaxed);
                return;
            }
            face = first + begin * stride + size_bytes;
            std::uint32_t* out = &mesh.triangles[3 * begin];
            const std::size_t bad = load_corners(list.type, face, stride, end - begin, out);
            if (bad < end - begin)
                faults[begin / block_elements] = find_bad_corner(face + bad * stride, 3, begin + bad);
        });
        if (!uniform) return false;
        report_first(faults);
        mesh.file_faces = element.count;
        return true;
    }

    /// The first face with an index out of range, `count` if there is none.
    std::size_t load_corners(PlyType type, const char* p, std::size_t stride, std::size_t count,
                             std::uint32_t* out) const {
        const std::uint64_t vertices = header_.vertices().count;
        return with_type(type, [&]<class T>(const T*) {
            std::size_t bad = count;
            for (std::size_t i = 0; i < count; ++i) {
                for (std::size_t k = 0; k < 3; ++k) {
                    // A negative index becomes a huge one.
                    const auto index = static_cast<std::uint64_t>(
                        static_cast<std::int64_t>(load<T, Order>(p + i * stride + k * sizeof(T))));
                    if (index >= vertices && bad == count) bad = i;
                    out[3 * i + k] = static_cast<std::uint32_t>(index);
                }
            }
            return bad;
        });
    }

    /// `entries` are the corners of a face of which one is out of range.
    Fault find_bad_corner(const char* entries, std::size_t size, std::size_t face) const {
        const PlyType type = header_.faces().properties[header_.corner_list].type;
        const auto vertices = static_cast<std::int64_t>(header_.vertices().count);
        std::size_t k = 0;
        std::int64_t index = 0;
        for (; k < size; ++k) {
            index = load_integer(type, entries + k * ply_size(type));
            if (index < 0 || index >= vertices) break;
        }
        return index_out_of_range(entries + k * ply_size(type), face, index, header_.vertices().count, 0);
    }

    void read_polygons(const char* p, Mesh& mesh) const {
        mesh.triangles = {};
        const PlyElement& element = header_.faces();
        Walk starts;
        behind(element, p, &starts);
        std::vector<FaceBlock> blocks(starts.size());
        std::vector<std::optional<Fault>> faults(starts.size());
        runtime::parallel_blocks(element.count, block_elements, [&](std::size_t begin, std::size_t end) {
            control_.check();
            const std::size_t b = begin / block_elements;
            const char* face = starts[b];
            blocks[b].corners.reserve(4 * (end - begin));
            for (std::size_t f = begin; f < end && !faults[b]; ++f) {
                face = walk(element, face, [&](std::size_t property, std::int64_t size, const char* entries) {
                    if (property == header_.corner_list) faults[b] = add_face(entries, size, f, blocks[b]);
                });
            }
        });
        report_first(faults);
        append_faces(mesh, blocks, control_);
    }

    std::optional<Fault> add_face(const char* entries, std::int64_t size, std::size_t face, FaceBlock& block) const {
        if (size < 3) return too_few_corners(entries, face, size);
        const PlyType type = header_.faces().properties[header_.corner_list].type;
        const auto vertices = static_cast<std::int64_t>(header_.vertices().count);
        const auto corners = static_cast<std::size_t>(size);
        for (std::size_t k = 0; k < corners; ++k) {
            const std::int64_t index = load_integer(type, entries + k * ply_size(type));
            if (index < 0 || index >= vertices) return find_bad_corner(entries, corners, face);
            block.corners.push_back(static_cast<std::uint32_t>(index));
        }
        block.close_face(corners);
        return {};
    }

    const FileContents& file_;
    const PlyHeader& header_;
    const runtime::RunControl& control_;
};

}  // namespace

Mesh read_ply_binary(const FileContents& file, const PlyHeader& header, const runtime::RunControl& control) {
    return header.encoding == PlyEncoding::little_endian ? BodyReader<std::endian::little>(file, header, control).read()
                                                         : BodyReader<std::endian::big>(file, header, control).read();
}

}  // namespace quadseg::io
