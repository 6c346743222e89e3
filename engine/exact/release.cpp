#include "exact/release.h"

#include <algorithm>
#include <numbers>

namespace quadseg::exact {

namespace {

constexpr double gentle_least = 0.3 * std::numbers::pi / 180, gentle_most = 30 * std::numbers::pi / 180;
constexpr double mostly = 0.5;
/// Amid free faces a surface needs as many facets as this to be believed.
constexpr std::size_t believable_facets = 12;

struct RegionBorder {
    double perimeter = 0;
    double to_strips = 0;  ///< gentle fold to a planar region
    double to_free = 0;    ///< smooth or gentle to a free face
    std::size_t facets = 0;
};

std::vector<RegionBorder> measure_borders(const Scene& scene, const Explained& state) {
    std::vector<RegionBorder> borders(state.surface.size());
    std::vector<std::int32_t> last_facet(state.surface.size(), -1);
    for (std::size_t facet = 0; facet < scene.facets.count(); ++facet) {
        for (std::size_t j = scene.facets.begin[facet]; j < scene.facets.begin[facet + 1]; ++j) {
            const std::int32_t r = state.region[scene.facets.face[j]];
            if (r < 0 || last_facet[static_cast<std::size_t>(r)] == static_cast<std::int32_t>(facet)) continue;
            last_facet[static_cast<std::size_t>(r)] = static_cast<std::int32_t>(facet);
            ++borders[static_cast<std::size_t>(r)].facets;
        }
    }
    for (std::size_t f = 0; f < state.region.size(); ++f) {
        if (state.region[f] < 0) continue;
        RegionBorder& border = borders[static_cast<std::size_t>(state.region[f])];
        for (int k = 0; k < 3; ++k) {
            const std::int32_t g = scene.mesh.neighbors[f][static_cast<std::size_t>(k)];
            if (g >= 0 && state.region[static_cast<std::size_t>(g)] == state.region[f]) continue;
            const double length = norm(scene.mesh.corner(f, (k + 1) % 3) - scene.mesh.corner(f, k));
            border.perimeter += length;
            if (g < 0) continue;
            const double fold = dihedral(scene.mesh, f, static_cast<std::size_t>(g));
            if (fold > gentle_most) continue;
            const std::int32_t other = state.region[static_cast<std::size_t>(g)];
            if (other < 0) {
                border.to_free += length;
            } else if (fold > gentle_least &&
                       state.surface[static_cast<std::size_t>(other)].type == SurfaceType::plane) {
                border.to_strips += length;
            }
        }
    }
    return borders;
}

}  // namespace

void release_doubtful(const Scene& scene, Explained& state) {
    const std::vector<RegionBorder> borders = measure_borders(scene, state);
    std::vector<std::uint8_t> doubtful(borders.size(), 0);
    for (std::size_t r = 0; r < borders.size(); ++r) {
        const RegionBorder& b = borders[r];
        const bool plane = state.surface[r].type == SurfaceType::plane;
        const bool strip = plane && b.to_strips + b.to_free > mostly * b.perimeter && b.to_strips > 0.25 * b.perimeter;
        const bool crumb = b.to_free > mostly * b.perimeter && b.facets < believable_facets;
        doubtful[r] = strip || crumb ? 1 : 0;
    }
    for (std::int32_t& r : state.region) {
        if (r >= 0 && doubtful[static_cast<std::size_t>(r)] != 0) r = -1;
    }
    separate_parts(scene, state);
}

}  // namespace quadseg::exact
