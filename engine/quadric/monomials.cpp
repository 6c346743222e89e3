#include "quadric/monomials.h"

namespace quadseg::quadric {

Coefficients to_local(const Coefficients& c, const Vec3& origin, double scale) noexcept {
    const double r = 1 / scale, r2 = r * r;
    const Vec3 g = gradient(c, origin);
    return {value(c, origin), g.x * r,   g.y * r,   g.z * r,   c[4] * r2,
            c[5] * r2,        c[6] * r2, c[7] * r2, c[8] * r2, c[9] * r2};
}

Coefficients from_local(const Coefficients& c, const Vec3& origin, double scale) noexcept {
    const double s2 = scale * scale;
    const Coefficients about_origin{c[0],      scale * c[1], scale * c[2], scale * c[3], s2 * c[4],
                                    s2 * c[5], s2 * c[6],    s2 * c[7],    s2 * c[8],    s2 * c[9]};
    return to_local(about_origin, -origin, 1);
}

}  // namespace quadseg::quadric
