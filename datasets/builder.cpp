#include "datasets/builder.h"

#include "datasets/surfaces.h"

namespace quadseg::datasets {

void Builder::flat_ring(const Loop& inner, const Loop& outer, std::uint32_t rows, std::int32_t surface) {
    const auto at = [&](const Loop& loop, double s) {
        const auto n = static_cast<double>(loop.size());
        if (s < 0) s += n;
        const double whole = std::floor(s);
        const auto i = static_cast<std::size_t>(whole) % loop.size();
        const Vec3 p = position(loop[i]);
        const Vec3 q = position(loop[(i + 1) % loop.size()]);
        return p + (q - p) * (s - whole);
    };
    ring(
        inner, outer, rows,
        [&](double s, double t) {
            const Vec3 p = at(inner, s);
            return p + (at(outer, s) - p) * t;
        },
        [&](std::size_t) { return surface; });
}

Generated Builder::take() {
    Generated result;
    result.surfaces = std::move(surfaces_);
    for (std::size_t k = 0; k < result.surfaces.size(); ++k) {
        auto& s = result.surfaces[k];
        s.analytic = static_cast<std::int32_t>(k);
        for (std::size_t j = 0; j < k; ++j) {
            if (same_surface(result.surfaces[j].surface, s.surface)) {
                s.analytic = result.surfaces[j].analytic;
                break;
            }
        }
    }
    Vec3 low = position(0);
    Vec3 high = low;
    for (std::size_t i = 0; i < positions_.size(); i += 3) {
        for (int a = 0; a < 3; ++a) {
            const double x = positions_[i + static_cast<std::size_t>(a)];
            low[a] = std::min(low[a], x);
            high[a] = std::max(high[a], x);
        }
    }
    result.diagonal = norm(high - low);
    for (std::size_t f = 0; f < truth_.size(); ++f) {
        const Vec3 a = position(triangles_[3 * f]);
        const Vec3 b = position(triangles_[3 * f + 1]);
        const Vec3 c = position(triangles_[3 * f + 2]);
        auto& s = result.surfaces[static_cast<std::size_t>(truth_[f])];
        ++s.triangles;
        s.area += norm(cross(b - a, c - a)) / 2;
    }
    result.mesh.positions = std::move(positions_);
    result.mesh.triangles = std::move(triangles_);
    result.truth = std::move(truth_);
    result.mesh.file_faces = result.truth.size();
    return result;
}

}  // namespace quadseg::datasets
