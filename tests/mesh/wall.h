// An extruded profile of two pieces, as around an engraved letter.
#pragma once

#include "tests/mesh/shapes.h"

namespace quadseg::test {

/// A wall of height .08 over the profile y(x) on [−1, 1], whose pieces meet at x = 0 at an angle of tangent `kink`. Its
/// rims have `below` and `above` edges in each piece.
inline Shape wall(double kink, std::uint32_t below, std::uint32_t above) {
    Shape s;
    const auto add = [&](double x, double z) {
        return s.vertex(x, x < 0 ? 0.3 * x * x - 0.1 * x * x * x : kink * x + 0.15 * x * x + 0.2 * x * x * x, z);
    };
    std::uint32_t bottom = add(-1, 0), top = add(-1, 0.08);
    for (const double start : {-1.0, 0.0}) {
        std::uint32_t i = 0, j = 0;
        while (i < below || j < above) {
            if (i * above + above <= j * below + below && i < below) {
                const std::uint32_t next = add(start + static_cast<double>(++i) / below, 0);
                s.face(bottom, next, top);
                bottom = next;
            } else {
                const std::uint32_t next = add(start + static_cast<double>(++j) / above, 0.08);
                s.face(bottom, next, top);
                top = next;
            }
        }
    }
    return s;
}

}  // namespace quadseg::test
