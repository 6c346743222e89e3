#include "flow/regularities_report.h"

#include "surface/regularities.h"
#include "surface/surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace quadseg::flow {

namespace {

/// Positions of surfaces are never known better than this, unit frame: coordinates in files have 7 digits or more.
constexpr double rounding = 1e-9;
/// Regions lie on one surface when their vertices miss each other's by at most this multiple of the noise.
constexpr double same_surface_noises = 4;
/// What is not known to be exact is only compared up to this size: beyond, O(n²) of nothing in common.
constexpr std::size_t most_general_surfaces = 400;
/// Every surface is compared with every group: of more, the largest are looked at.
constexpr std::size_t most_regular_surfaces = 1000;
/// Pairs looked at and pairs compared on points: a soup has as many surfaces as faces, with nothing in common.
constexpr std::size_t most_pairs = 4'000'000, most_comparisons = 400'000;

bool analytic(SurfaceType type) {
    return type <= SurfaceType::torus;
}

double tolerance_of(const FinalSurface& s, double noise) {
    return std::max(2 * s.rms, same_surface_noises * std::max(noise, rounding));
}

struct Entry {
    std::uint32_t region;
    SurfaceType type;
    double size;       ///< what two equal surfaces share: radius, half angle, distance from the origin
    double tolerance;  ///< of the points
    double blur;       ///< of the size
};

double size_of(const Surface& s) {
    switch (s.type) {
        case SurfaceType::plane:
            return std::abs(dot(to_vec3(s.axis), to_vec3(s.point)));
        case SurfaceType::sphere:
        case SurfaceType::cylinder:
            return s.radius;
        case SurfaceType::cone:
            return s.half_angle;
        case SurfaceType::torus:
            return s.minor_radius;
        default:
            return 0;
    }
}

}  // namespace

std::vector<Regularity> snap_regularities(std::vector<FinalSurface>& surfaces, const std::vector<double>& areas,
                                          double noise) {
    std::vector<std::uint32_t> eligible;
    for (std::size_t r = 0; r < surfaces.size(); ++r) {
        const FinalSurface& s = surfaces[r];
        if (analytic(s.surface.type) && s.evidence >= 3 && s.extent > 0) {
            eligible.push_back(static_cast<std::uint32_t>(r));
        }
    }
    if (eligible.size() > most_regular_surfaces) {
        std::sort(eligible.begin(), eligible.end(),
                  [&](std::uint32_t a, std::uint32_t b) { return areas[a] != areas[b] ? areas[a] > areas[b] : a < b; });
        eligible.resize(most_regular_surfaces);
        std::sort(eligible.begin(), eligible.end());
    }
    std::vector<surface::RegularSurface> regular;
    std::vector<std::uint32_t> place(surfaces.size(), std::numeric_limits<std::uint32_t>::max());
    for (const std::uint32_t r : eligible) {
        const FinalSurface& s = surfaces[r];
        place[r] = static_cast<std::uint32_t>(regular.size());
        surface::RegularSurface entry;
        entry.surface = s.surface;
        entry.region = static_cast<std::int32_t>(r);
        entry.area = areas[r];
        entry.centroid = s.centroid;
        entry.extent = s.extent;
        entry.noise = std::max(s.rms, noise) / std::sqrt(static_cast<double>(s.evidence));
        regular.push_back(entry);
    }
    surface::RegularityResult found = surface::find_regularities(regular);
    std::vector<std::uint8_t> snapped(surfaces.size(), 0);
    for (std::size_t r = 0; r < surfaces.size(); ++r) {
        if (place[r] >= regular.size()) continue;
        FinalSurface& s = surfaces[r];
        const Surface& candidate = found.snapped[place[r]];
        const double before = surface::max_distance(s.surface, s.points);
        const double allowed = std::max({1.25 * before, before + noise, before + rounding * s.extent});
        if (!(surface::max_distance(candidate, s.points) <= allowed)) continue;
        const quadric::Coefficients coefficients = s.surface.coefficients;
        s.surface = candidate;
        if (s.surface.type == SurfaceType::torus) {
            s.surface.coefficients = coefficients;
        } else {
            (void)quadric_of(s.surface, s.centroid, s.quadric);
        }
        snapped[r] = 1;
    }
    for (Regularity& group : found.groups) {
        group.snapped = std::all_of(group.regions.begin(), group.regions.end(),
                                    [&](std::int32_t r) { return snapped[static_cast<std::size_t>(r)] != 0; });
    }
    return std::move(found.groups);
}

std::vector<std::int32_t> analytic_surface_ids(const std::vector<FinalSurface>& surfaces, double noise) {
    std::vector<std::int32_t> ids(surfaces.size());
    std::iota(ids.begin(), ids.end(), 0);
    std::vector<Entry> entries;
    std::size_t general = 0;
    for (std::size_t r = 0; r < surfaces.size(); ++r) {
        const FinalSurface& s = surfaces[r];
        if (s.surface.type >= SurfaceType::blend || s.points.empty()) continue;
        if (!analytic(s.surface.type) && ++general > most_general_surfaces) continue;
        const double tolerance = tolerance_of(s, noise);
        // Sizes are blurred by what the vertices leave open beyond the region: up to half the model is away.
        const double lever = s.extent > 0 ? 1 + 1 / s.extent : 1;
        entries.push_back({static_cast<std::uint32_t>(r), s.surface.type, size_of(s.surface), tolerance,
                           std::min(4 * tolerance * lever, 0.05)});
    }
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
        if (a.type != b.type) return a.type < b.type;
        return a.size != b.size ? a.size < b.size : a.region < b.region;
    });
    // Every region asks those before it in order of size; ids are the smallest index of a chain of equal surfaces.
    std::vector<std::int32_t> parent = ids;
    const auto root = [&](std::int32_t r) {
        while (parent[static_cast<std::size_t>(r)] != r) {
            std::int32_t& up = parent[static_cast<std::size_t>(r)];
            up = parent[static_cast<std::size_t>(up)];  // halves the path
            r = up;
        }
        return r;
    };
    double widest = 0;
    for (const Entry& e : entries) widest = std::max(widest, e.blur);
    const std::size_t shares = std::max<std::size_t>(1, entries.size());
    const std::size_t window = std::max<std::size_t>(8, most_pairs / shares);
    const std::size_t most_tries = std::max<std::size_t>(4, most_comparisons / shares);
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const Entry& a = entries[i];
        const FinalSurface& sa = surfaces[a.region];
        const std::size_t last = i > window ? i - window : 0;
        std::size_t tries = 0;
        for (std::size_t j = i; j-- > last && tries < most_tries;) {
            const Entry& b = entries[j];
            if (b.type != a.type || a.size - b.size > a.blur + widest) break;
            if (a.size - b.size > a.blur + b.blur) continue;
            const FinalSurface& sb = surfaces[b.region];
            const auto ra = root(static_cast<std::int32_t>(a.region)), rb = root(static_cast<std::int32_t>(b.region));
            if (ra == rb) continue;
            ++tries;
            if (!surface::same_surface(sa.surface, sa.points, sb.surface, sb.points,
                                       std::max(a.tolerance, b.tolerance)))
                continue;
            parent[static_cast<std::size_t>(std::max(ra, rb))] = std::min(ra, rb);
        }
    }
    for (std::size_t r = 0; r < ids.size(); ++r) ids[r] = root(static_cast<std::int32_t>(r));
    return ids;
}

}  // namespace quadseg::flow
