// Meshes that nobody should make and everybody has.
#pragma once

#include "datasets/generate.h"
#include "tests/golden/shapes.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace quadseg::test {

struct NamedShape {
    std::string name;
    Shape shape;
};

inline void PrintTo(const NamedShape& s, std::ostream* out) {
    *out << s.name;
}

inline Shape of_part(const char* name, std::size_t faces, double noise = 0) {
    const datasets::Generated part = datasets::generate(name, faces, noise);
    return {part.mesh.positions, part.mesh.triangles, {}};
}

/// All faces share vertex 0. `height`: of the hub above the rim.
inline Shape fan(std::uint32_t spokes, double height) {
    Shape s;
    s.vertex(0, 0, height);
    for (std::uint32_t i = 0; i < spokes; ++i) {
        const double t = 2 * std::acos(-1.0) * i / spokes;
        s.vertex(std::cos(t), std::sin(t), 0);
    }
    for (std::uint32_t i = 0; i < spokes; ++i) s.face(0, 1 + i, 1 + (i + 1) % spokes);
    return s;
}

/// `pages` faces at one edge.
inline Shape book(std::uint32_t pages) {
    Shape s;
    s.vertex(0, 0, 0);
    s.vertex(0, 0, 1);
    for (std::uint32_t i = 0; i < pages; ++i) {
        const double t = 2 * std::acos(-1.0) * i / pages;
        s.face(0, 1, s.vertex(std::cos(t), std::sin(t), 0.5));
    }
    return s;
}

/// Triangles 1e7 times as long as wide, edge to edge.
inline Shape needles(std::uint32_t count) {
    Shape s;
    s.vertex(0, 0, 0);
    s.vertex(1, 0, 0);
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t v = s.vertex(i % 2 == 0 ? 0 : 1, 1e-7 * (i + 1), 1e-9 * (i % 7));
        if (i % 2 == 0) {
            s.face(v - 2, v - 1, v);
        } else {
            s.face(v - 2, v, v - 1);
        }
    }
    return s;
}

/// Random triangles in the unit cube, vertices of their own or of a small pool.
inline Shape random_soup(std::size_t faces, std::size_t pool, std::uint64_t seed) {
    Shape s;
    Random random{seed};
    const auto coordinate = [&] { return static_cast<double>(random.next() >> 11) * 0x1p-53; };
    const auto fresh = [&] {
        const double x = coordinate(), y = coordinate();
        return s.vertex(x, y, coordinate());
    };
    for (std::size_t i = 0; i < pool; ++i) fresh();
    const auto corner = [&] { return pool > 0 ? static_cast<std::uint32_t>(random.below(pool)) : fresh(); };
    for (std::size_t f = 0; f < faces; ++f) {
        const std::uint32_t a = corner(), b = corner();
        s.face(a, b, corner());
    }
    return s;
}

inline Shape scaled(Shape s, double factor, double offset = 0) {
    for (double& x : s.positions) x = x * factor + offset;
    return s;
}

/// Every other face turned over.
inline Shape flipped_half(Shape s) {
    for (std::size_t f = 0; f < s.faces(); f += 2) std::swap(s.triangles[3 * f], s.triangles[3 * f + 1]);
    return s;
}

inline Shape with_duplicates(Shape s) {
    const std::vector<std::uint32_t> once = s.triangles;
    for (std::size_t f = 0; f < once.size() / 3; f += 2) {
        s.face(once[3 * f + 1], once[3 * f + 2], once[3 * f]);
        s.face(once[3 * f + 1], once[3 * f], once[3 * f + 2]);
    }
    return s;
}

inline Shape with_degenerate(Shape s) {
    const std::size_t faces = s.faces();
    for (std::size_t f = 0; f < faces; f += 3) {
        s.face(s.triangles[3 * f], s.triangles[3 * f], s.triangles[3 * f + 1]);
        s.face(s.triangles[3 * f], s.triangles[3 * f + 1], s.triangles[3 * f + 1]);
    }
    return s;
}

inline Shape with_isolated(Shape s) {
    s.vertex(1e12, -1e12, 1e12);
    s.vertex(std::numeric_limits<double>::quiet_NaN(), 0, std::numeric_limits<double>::infinity());
    return s;
}

/// Boxes that meet at single corners.
inline Shape corner_chain(std::uint32_t boxes) {
    Shape s;
    std::uint32_t last = 0;
    for (std::uint32_t i = 0; i < boxes; ++i) {
        Shape one = cube();
        for (double& x : one.positions) x += i;
        const auto offset = static_cast<std::uint32_t>(s.positions.size() / 3);
        s = joined(s, one);
        if (i > 0) {
            for (std::size_t c = 0; c < s.triangles.size(); ++c) {
                if (s.triangles[c] == offset) s.triangles[c] = last;
            }
        }
        last = offset + 7;
    }
    return s;
}

/// Small enough for every preset and option.
inline std::vector<NamedShape> nasty_shapes() {
    Shape one, two, flat = grid(6, 6), line, noisy_floor = grid(12, 12);
    one.vertex(0, 0, 0);
    one.vertex(1, 0, 0);
    one.vertex(0, 1, 0);
    one.face(0, 1, 2);
    two = one;
    two.vertex(1, 1, 0.3);
    two.face(1, 3, 2);
    for (double& x : line.positions) x = 0;
    for (std::uint32_t i = 0; i < 30; ++i) line.vertex(i, 2.0 * i, 3.0 * i);
    for (std::uint32_t i = 0; i + 2 < 30; ++i) line.face(i, i + 1, i + 2);
    Random random{3};
    for (std::size_t v = 2; v < noisy_floor.positions.size(); v += 3) {
        noisy_floor.positions[v] = 1e-300 * static_cast<double>(random.below(1000));
    }
    Shape same_place = grid(5, 5);
    for (double& x : same_place.positions) x = 1.25;
    Shape spike = box(4);
    spike.positions[0] = -1e15;
    Shape folded = grid(10, 10);
    for (std::size_t v = 0; v < folded.positions.size(); v += 3) {
        if (folded.positions[v] > 5) folded.positions[v] = 10 - folded.positions[v];
    }
    return {
        {"one_face", one},
        {"two_faces", two},
        {"thousand_faces_apart", soup(of_part("plate", 1000))},
        {"flat", flat},
        {"line", line},
        {"one_place", same_place},
        {"denormal_heights", noisy_floor},
        {"denormal", scaled(box(3), 1e-310)},
        {"tiny", scaled(of_part("shaft", 1000), 1e-30)},
        {"huge", scaled(of_part("shaft", 1000), 1e30)},
        {"beyond_squares", scaled(of_part("shaft", 1000), 1e200)},
        {"below_squares", scaled(of_part("shaft", 1000), 1e-200)},
        {"far_off", scaled(of_part("shaft", 1000), 1, 1e9)},
        {"too_far_off", scaled(of_part("shaft", 1000), 1, 1e17)},
        {"spike", spike},
        {"moebius", band(60, true)},
        {"book", book(64)},
        {"fan", fan(2000, 0.5)},
        {"needles", needles(400)},
        {"soup", random_soup(400, 0, 1)},
        {"tangle", random_soup(500, 40, 2)},
        {"tight_tangle", random_soup(300, 8, 3)},
        {"flipped_half", flipped_half(of_part("flange", 1500))},
        {"duplicates", with_duplicates(of_part("plate", 1000))},
        {"degenerate", with_degenerate(of_part("plate", 1000))},
        {"isolated", with_isolated(of_part("plate", 1000))},
        {"corner_chain", corner_chain(12)},
        {"folded", folded},
        {"many_boxes",
         [] {
             Shape s;
             for (int i = 0; i < 40; ++i) s = joined(s, box(1, 2.0 * i));
             return s;
         }()},
        {"very_noisy", of_part("plate", 1000, 0.05)},
        {"noise_only", of_part("rounded_octahedron", 1000, 0.1)},
    };
}

}  // namespace quadseg::test
