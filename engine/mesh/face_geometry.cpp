#include "mesh/build.h"
#include "runtime/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace quadseg::mesh::build {

void measure_faces(WorkMesh& mesh, const runtime::RunControl& control) {
    const double scale = mesh.frame.scale;
    double largest = 0;
    for (int k = 0; k < 3; ++k) {
        const auto axis = static_cast<std::size_t>(k);
        largest = std::max({largest, std::abs(mesh.report.box_min[axis]), std::abs(mesh.report.box_max[axis])});
    }
    // A face whose height is within the rounding of its coordinates has no normal. Slivers of aspect 1e5 do.
    const double coordinate_rounding = 4 * std::numeric_limits<double>::epsilon() * largest * scale;
    const double coordinate_rounding2 = coordinate_rounding * coordinate_rounding;
    constexpr double flat2 = 1e-28;  // (height / longest edge)²
    // Fresh memory costs as much as the arithmetic: let two threads touch it.
    runtime::parallel_invoke([&] { mesh.normals.resize(mesh.face_count()); },
                             [&] { mesh.areas.resize(mesh.face_count()); });
    struct Sum {
        double area = 0;
        std::size_t degenerate = 0;
    };
    const Sum sum = runtime::reduce_blocks(
        mesh.face_count(), block, Sum{},
        [&](std::size_t begin, std::size_t end) {
            control.check();
            Sum s;
            for (std::size_t f = begin; f < end; ++f) {
                // Differences of input coordinates are nearly exact; those in the unit frame are not. Scaled before
                // they are multiplied, they cannot overflow.
                const Vec3 a = mesh.corner(f, 0), b = mesh.corner(f, 1), c = mesh.corner(f, 2);
                const Vec3 u = (b - a) * scale, v = (c - a) * scale, w = (c - b) * scale;
                const Vec3 n = cross(u, v);
                const double length2 = squared_norm(n);
                const double longest2 = std::max({squared_norm(u), squared_norm(v), squared_norm(w)});
                if (length2 > longest2 * std::max(flat2 * longest2, coordinate_rounding2)) {
                    const double length = std::sqrt(length2);
                    mesh.normals[f] = n * (1 / length);
                    mesh.areas[f] = 0.5 * length;
                    s.area += mesh.areas[f];
                } else {
                    mesh.normals[f] = {};
                    mesh.areas[f] = 0;
                    ++s.degenerate;
                }
            }
            return s;
        },
        [](Sum a, const Sum& b) {
            return Sum{a.area + b.area, a.degenerate + b.degenerate};
        });
    mesh.total_area = sum.area;
    mesh.report.degenerate_faces += sum.degenerate;
    mesh.report.area = sum.area / scale / scale;
}

}  // namespace quadseg::mesh::build
