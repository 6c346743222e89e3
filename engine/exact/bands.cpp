#include "exact/bands.h"

#include "exact/face_fit.h"
#include "exact/search.h"

#include <algorithm>
#include <cmath>

namespace quadseg::exact {

namespace {

constexpr double uneven = 1.3;
constexpr std::size_t fewest_rims = 3, most_rims = 5, fewest_on_rim = 3;
constexpr double same_rim = 1e-3;  ///< share of the angle of all bands
/// Of the faces of the torus that its bands' own surfaces must explain.
constexpr double nearly_all = 0.9;

/// Angles around the tube, ascending, of the vertices.
std::vector<double> tube_angles(const Scene& scene, const Candidate& candidate) {
    const Surface& s = candidate.surface;
    const Vec3 centre = to_vec3(s.point), axis = to_vec3(s.axis);
    std::vector<std::uint32_t> vertices;
    for (const std::uint32_t f : candidate.faces) {
        vertices.insert(vertices.end(), scene.mesh.faces[f].begin(), scene.mesh.faces[f].end());
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    std::vector<double> outwards, along;
    double x = 0, y = 0;
    for (const std::uint32_t v : vertices) {
        const Vec3 d = scene.mesh.positions[v] - centre;
        const double z = dot(d, axis);
        const double distance = norm(d - axis * z);
        // Beyond the axis of a torus that crosses itself the tube is the other way.
        const bool beyond = std::abs(std::hypot(distance + s.radius, z) - s.minor_radius) <
                            std::abs(std::hypot(distance - s.radius, z) - s.minor_radius);
        outwards.push_back(beyond ? -distance - s.radius : distance - s.radius);
        along.push_back(z);
        x += outwards.back();
        y += z;
    }
    const double length = std::hypot(x, y);
    std::vector<double> angles;
    if (!(length > 0)) return angles;
    for (std::size_t i = 0; i < along.size(); ++i) {
        angles.push_back(
            std::atan2((x * along[i] - y * outwards[i]) / length, (x * outwards[i] + y * along[i]) / length));
    }
    std::sort(angles.begin(), angles.end());
    return angles;
}

}  // namespace

bool has_uneven_bands(const Scene& scene, const Candidate& candidate) {
    if (candidate.surface.type != SurfaceType::torus || candidate.faces.empty()) return false;
    const std::vector<double> angles = tube_angles(scene, candidate);
    if (angles.empty()) return false;
    const double apart = same_rim * (angles.back() - angles.front());
    std::vector<double> rims{angles.front()};
    std::size_t on_rim = 0;
    for (std::size_t i = 0; i < angles.size(); ++i) {
        if (i == 0 || angles[i] - angles[i - 1] <= apart) {
            ++on_rim;
            continue;
        }
        if (on_rim < fewest_on_rim || rims.size() == most_rims) return false;
        rims.push_back(angles[i]);
        on_rim = 1;
    }
    if (on_rim < fewest_on_rim || rims.size() < fewest_rims) return false;
    double narrowest = rims[1] - rims[0], widest = narrowest;
    for (std::size_t i = 2; i < rims.size(); ++i) {
        narrowest = std::min(narrowest, rims[i] - rims[i - 1]);
        widest = std::max(widest, rims[i] - rims[i - 1]);
    }
    return widest > uneven * narrowest;
}

void split_uneven_bands(const Scene& scene, std::vector<Candidate>& candidates) {
    std::vector<std::size_t> suspects;
    std::vector<std::uint8_t> covered(scene.mesh.face_count(), explained);
    for (std::size_t c = 0; c < candidates.size(); ++c) {
        if (!has_uneven_bands(scene, candidates[c])) continue;
        suspects.push_back(c);
        for (const std::uint32_t f : candidates[c].faces) covered[f] = 0;
    }
    if (suspects.empty()) return;
    std::vector<Candidate> bands =
        search_surfaces(scene, {.rows_only = true, .most_step = largest_facet_turn}, covered);
    scene.control.check();
    std::erase_if(bands, [&](const Candidate& band) { return has_uneven_bands(scene, band); });
    std::vector<std::uint8_t> in_band(scene.mesh.face_count(), 0);
    for (const Candidate& band : bands) {
        for (const std::uint32_t f : band.faces) in_band[f] = 1;
    }
    for (const std::size_t c : suspects) {
        const auto inside = std::count_if(candidates[c].faces.begin(), candidates[c].faces.end(),
                                          [&](std::uint32_t f) { return in_band[f] != 0; });
        if (static_cast<double>(inside) < nearly_all * static_cast<double>(candidates[c].faces.size())) continue;
        candidates[c].faces.clear();
    }
    std::erase_if(candidates, [](const Candidate& candidate) { return candidate.faces.empty(); });
    for (Candidate& band : bands) candidates.push_back(std::move(band));
}

}  // namespace quadseg::exact
