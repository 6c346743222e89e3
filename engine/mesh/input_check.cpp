#include <quadseg/error.h>

#include "mesh/build.h"
#include "runtime/parallel.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <string>

namespace quadseg::mesh::build {

namespace {

constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

std::size_t first_of(std::size_t a, std::size_t b) {
    return std::min(a, b);
}

void check_shape(const MeshView& input) {
    const auto wrong = [](const std::string& text) { throw Error(ErrorCode::invalid_argument, text); };
    if (input.positions.size() % 3 != 0) {
        wrong("positions: must hold 3 numbers a vertex, but holds " + std::to_string(input.positions.size()));
    }
    if (input.triangles.size() % 3 != 0) {
        wrong("triangles: must hold 3 indices a face, but holds " + std::to_string(input.triangles.size()));
    }
    if (!input.polygons.empty() && input.polygons.size() != input.face_count()) {
        wrong("polygons: must be empty or hold a number a face (" + std::to_string(input.face_count()) +
              "), but holds " + std::to_string(input.polygons.size()));
    }
    // Half-edges are numbered 3f + k in 32 bits.
    constexpr std::size_t most_faces = std::numeric_limits<std::uint32_t>::max() / 3 - 1;
    if (input.face_count() > most_faces) {
        wrong("triangles: at most " + std::to_string(most_faces) + " faces are supported, but there are " +
              std::to_string(input.face_count()));
    }
    if (input.face_count() == 0) throw Error(ErrorCode::empty_mesh, "the mesh has no faces");
}

}  // namespace

std::vector<std::uint8_t> check_input(const MeshView& input, const runtime::RunControl& control) {
    check_shape(input);
    const std::size_t vertices = input.vertex_count();
    std::vector<std::uint8_t> used(vertices, 0);
    const std::size_t bad_corner = runtime::reduce_blocks(
        input.triangles.size(), 3 * block, none,
        [&](std::size_t begin, std::size_t end) {
            control.check();
            for (std::size_t i = begin; i < end; ++i) {
                const std::uint32_t v = input.triangles[i];
                if (v >= vertices) return i;
                std::atomic_ref<std::uint8_t>(used[v]).store(1, std::memory_order_relaxed);
            }
            return none;
        },
        first_of);
    if (bad_corner != none) {
        throw Error(ErrorCode::invalid_mesh, "face " + std::to_string(bad_corner / 3) + ": vertex index " +
                                                 std::to_string(input.triangles[bad_corner]) +
                                                 " is out of range, there are " + std::to_string(vertices) +
                                                 " vertices");
    }
    const std::size_t bad_vertex = runtime::reduce_blocks(
        vertices, block, none,
        [&](std::size_t begin, std::size_t end) {
            control.check();
            for (std::size_t v = begin; v < end; ++v) {
                const double* p = &input.positions[3 * v];
                if (used[v] && !(std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]))) return v;
            }
            return none;
        },
        first_of);
    if (bad_vertex != none) {
        throw Error(ErrorCode::invalid_mesh,
                    "vertex " + std::to_string(bad_vertex) + ": a coordinate is not a finite number");
    }
    return used;
}

void measure_box(const MeshView& input, const std::vector<std::uint8_t>& used, WorkMesh& mesh,
                 const runtime::RunControl& control) {
    struct Box {
        Vec3 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
                 std::numeric_limits<double>::infinity()};
        Vec3 high = -low;
        std::size_t vertices = 0;
    };
    const Box box = runtime::reduce_blocks(
        used.size(), block, Box{},
        [&](std::size_t begin, std::size_t end) {
            control.check();
            Box b;
            for (std::size_t v = begin; v < end; ++v) {
                if (!used[v]) continue;
                ++b.vertices;
                for (int k = 0; k < 3; ++k) {
                    const double x = input.positions[3 * v + static_cast<std::size_t>(k)];
                    b.low[k] = std::min(b.low[k], x);
                    b.high[k] = std::max(b.high[k], x);
                }
            }
            return b;
        },
        [](Box a, const Box& b) {
            for (int k = 0; k < 3; ++k) {
                a.low[k] = std::min(a.low[k], b.low[k]);
                a.high[k] = std::max(a.high[k], b.high[k]);
            }
            a.vertices += b.vertices;
            return a;
        });
    const Vec3 extents = box.high - box.low;
    const double largest = std::max({extents.x, extents.y, extents.z});
    if (!std::isfinite(largest) || !std::isfinite(3 * largest)) {
        throw Error(ErrorCode::invalid_mesh, "the extent of the mesh exceeds the range of double numbers");
    }
    if (!std::isnormal(largest) || !std::isfinite(1 / largest)) {
        throw Error(ErrorCode::empty_mesh, "no face has an area: all vertices are at one position");
    }
    mesh.frame.centre = box.low + extents * 0.5;
    mesh.frame.scale = 1 / largest;
    mesh.frame.diagonal = norm(extents * mesh.frame.scale);

    MeshReport& report = mesh.report;
    report.faces = input.face_count();
    report.vertices = input.vertex_count();
    report.isolated_vertices = input.vertex_count() - box.vertices;
    report.diagonal = mesh.frame.diagonal * largest;
    report.offset = norm(mesh.frame.centre * mesh.frame.scale) / mesh.frame.diagonal;
    report.box_min = to_array(box.low);
    report.box_max = to_array(box.high);
}

}  // namespace quadseg::mesh::build
