#include "io/faces.h"

#include "io/polled_resize.h"
#include "runtime/parallel.h"

#include <algorithm>

namespace quadseg::io {

void append_faces(Mesh& mesh, std::vector<FaceBlock>& blocks, const runtime::RunControl& control) {
    bool all_triangles = true;
    std::vector<std::size_t> first_face(blocks.size()), first_triangle(blocks.size());
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        first_face[b] = blocks[b].faces;
        first_triangle[b] = blocks[b].triangles();
        all_triangles = all_triangles && blocks[b].sizes.empty();
    }
    mesh.file_faces = runtime::exclusive_scan(first_face);
    const std::size_t triangles = runtime::exclusive_scan(first_triangle);
    polled_resize(mesh.triangles, 3 * triangles, control);
    polled_resize(mesh.polygons, all_triangles ? 0 : triangles, control);
    runtime::parallel_for(blocks.size(), 1, [&](std::size_t b) {
        FaceBlock block = std::move(blocks[b]);
        std::uint32_t* out = mesh.triangles.data() + 3 * first_triangle[b];
        std::size_t counter = 0;
        Triangulator triangulator(mesh.positions);
        if (block.sizes.empty()) {
            control.check();
            std::copy(block.corners.begin(), block.corners.end(), out);
        }
        const std::uint32_t* corner = block.corners.data();
        for (const std::uint32_t size : block.sizes) {
            control.check_often(counter);
            triangulator.cut({corner, size}, out);
            corner += size;
            out += 3 * (std::size_t{size} - 2);
        }
        if (all_triangles) return;
        std::uint32_t* polygon = mesh.polygons.data() + first_triangle[b];
        for (std::size_t f = 0; f < block.faces; ++f) {
            const std::size_t count = block.sizes.empty() ? 1 : block.sizes[f] - 2;
            polygon = std::fill_n(polygon, count, static_cast<std::uint32_t>(first_face[b] + f));
        }
    });
}

}  // namespace quadseg::io
