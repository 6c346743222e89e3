// Binary STL, and what it shares with the text form.
#include "io/bytes.h"
#include "io/formats.h"
#include "io/mesh_faults.h"
#include "io/polled_resize.h"
#include "io/stl.h"
#include "io/weld.h"

#include <cmath>
#include <optional>

namespace quadseg::io {
namespace {

constexpr std::size_t corner_bytes = 12;
constexpr std::size_t grain = 16384;

std::uint32_t announced_facets(std::string_view bytes) noexcept {
    return load<std::uint32_t, std::endian::little>(bytes.data() + stl_header_bytes);
}

std::size_t checked_facets(const FileContents& file) {
    const std::string size = std::to_string(file.size());
    if (file.size() < stl_prefix_bytes) {
        file.fail_at_byte(
            {ErrorCode::file_format, file.end(),
             "a binary STL file begins with 84 bytes, this one has " + size + "; it is truncated or no STL"});
    }
    const std::size_t facets = announced_facets(file.text());
    const std::size_t room = (file.size() - stl_prefix_bytes) / stl_facet_bytes;
    if (facets > room) {
        file.fail_at_byte({ErrorCode::file_format, file.end(),
                           "the file announces " + std::to_string(facets) + " facets but ends after " +
                               std::to_string(room) + "; it is truncated or no STL"});
    }
    // A few padding bytes are common; whole facets that nobody announced are not.
    if (facets < room) {
        file.fail_at_byte({ErrorCode::file_format, file.begin() + stl_header_bytes,
                           "the file announces " + std::to_string(facets) + " facets but has room for " +
                               std::to_string(room) + "; its header is wrong or it is no STL"});
    }
    if (3 * facets > largest_count) {
        file.fail(ErrorCode::file_format, "has more corners than 32-bit indices can name");
    }
    return facets;
}

}  // namespace

bool has_binary_stl_size(std::string_view bytes) noexcept {
    return bytes.size() >= stl_prefix_bytes &&
           bytes.size() == stl_prefix_bytes + stl_facet_bytes * std::size_t{announced_facets(bytes)};
}

Mesh read_stl_binary(const FileContents& file, const runtime::RunControl& control) {
    const std::size_t facets = checked_facets(file);
    const char* first = file.begin() + stl_prefix_bytes;
    const auto place_of = [first](std::size_t corner) {
        const auto c = static_cast<std::uint32_t>(corner);  // divides in fewer cycles
        return first + std::size_t{c / 3} * stl_facet_bytes + (c % 3 + 1) * corner_bytes;
    };
    const auto position_of = [&](std::size_t corner) {
        const char* p = place_of(corner);
        std::array<float, 3> position;
        for (std::size_t k = 0; k < 3; ++k) position[k] = load<float, std::endian::little>(p + 4 * k);
        return position;
    };
    std::vector<std::optional<Fault>> faults((facets + grain - 1) / grain);
    runtime::parallel_blocks(facets, grain, [&](std::size_t begin, std::size_t end) {
        control.check();
        for (std::size_t c = 3 * begin; c < 3 * end; ++c) {
            const auto x = position_of(c);
            if (std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2])) continue;
            faults[begin / grain] =
                Fault{ErrorCode::invalid_mesh, place_of(c),
                      "vertex " + std::to_string(c % 3) + " of face " + std::to_string(c / 3) +
                          " (counted from 0) has a coordinate that is NaN or infinite; repair the mesh"};
            return;
        }
    });
    for (const auto& fault : faults) {
        if (fault) file.fail_at_byte(*fault);
    }
    Weld welded = weld(
        3 * facets, [&](std::size_t corner) { return position_key(position_of(corner).data()); }, control);
    Mesh mesh;
    mesh.triangles = std::move(welded.vertex_of);
    mesh.file_faces = facets;
    mesh.welded_vertices = 3 * facets - welded.first_corner.size();
    polled_resize(mesh.positions, 3 * welded.first_corner.size(), control);
    runtime::parallel_blocks(welded.first_corner.size(), grain, [&](std::size_t begin, std::size_t end) {
        control.check();
        for (std::size_t v = begin; v < end; ++v) {
            const auto x = position_of(welded.first_corner[v]);
            for (std::size_t k = 0; k < 3; ++k) mesh.positions[3 * v + k] = static_cast<double>(x[k]);
        }
    });
    return mesh;
}

}  // namespace quadseg::io
