// Order of faces along a space-filling curve: neighbours in space become neighbours in memory (PROTOTYPE: shuffled
// faces cost up to 1.85 times the time of the whole job).
#include "mesh/build.h"
#include "runtime/parallel.h"

#include <algorithm>
#include <cmath>

namespace quadseg::mesh::build {

namespace {

constexpr int bits_per_axis = 21;

/// abc → a00b00c, for 21 bits.
std::uint64_t spread_bits(std::uint64_t x) noexcept {
    x &= 0x1fffff;
    x = (x | x << 32) & 0x1f00000000ffff;
    x = (x | x << 16) & 0x1f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    x = (x | x << 2) & 0x1249249249249249;
    return x;
}

std::uint64_t cell(double unit_coordinate) noexcept {
    constexpr double cells = 1 << bits_per_axis;
    const double x = (unit_coordinate + 0.5) * cells;
    return static_cast<std::uint64_t>(std::clamp(x, 0.0, cells - 1));
}

struct Keyed {
    std::uint64_t key;
    std::uint32_t face;
};

Vec3 position(const MeshView& input, std::uint32_t v) noexcept {
    const double* p = &input.positions[3 * static_cast<std::size_t>(v)];
    return {p[0], p[1], p[2]};
}

/// Faces in one cell of the curve: by the positions of their corners, so that a permuted input gives the same order.
bool before_in_cell(const MeshView& input, std::uint32_t f, std::uint32_t g) noexcept {
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 a = position(input, input.triangles[3 * std::size_t{f} + k]);
        const Vec3 b = position(input, input.triangles[3 * std::size_t{g} + k]);
        for (int i = 0; i < 3; ++i) {
            if (a[i] != b[i]) return a[i] < b[i];
        }
    }
    return f < g;
}

}  // namespace

std::vector<std::uint32_t> morton_order(const MeshView& input, const UnitFrame& frame,
                                        const runtime::RunControl& control) {
    std::vector<Keyed> keyed(input.face_count());
    const std::size_t proper = runtime::reduce_blocks(
        keyed.size(), block, std::size_t{0},
        [&](std::size_t begin, std::size_t end) {
            control.check();
            std::size_t count = 0;
            for (std::size_t f = begin; f < end; ++f) {
                const std::uint32_t* t = &input.triangles[3 * f];
                // Faces that are left out go to the end, whose key no centroid has (it has 64 bits, centroids 63).
                std::uint64_t key = ~std::uint64_t{0};
                if (!has_repeated_index(t)) {
                    const Vec3 c = (frame.to_unit(position(input, t[0])) + frame.to_unit(position(input, t[1])) +
                                    frame.to_unit(position(input, t[2]))) /
                                   3.0;
                    key = spread_bits(cell(c.x)) << 2 | spread_bits(cell(c.y)) << 1 | spread_bits(cell(c.z));
                    ++count;
                }
                keyed[f] = {key, static_cast<std::uint32_t>(f)};
            }
            return count;
        },
        [](std::size_t a, std::size_t b) { return a + b; });
    control.check();
    runtime::parallel_sort(keyed.begin(), keyed.end(), [&](const Keyed& a, const Keyed& b) {
        return a.key != b.key ? a.key < b.key : before_in_cell(input, a.face, b.face);
    });
    control.check();
    std::vector<std::uint32_t> order(proper);
    runtime::parallel_for(proper, block, [&](std::size_t i) { order[i] = keyed[i].face; });
    return order;
}

}  // namespace quadseg::mesh::build
