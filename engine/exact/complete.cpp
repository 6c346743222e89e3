#include "exact/complete.h"

#include "exact/face_fit.h"
#include "exact/grow.h"
#include "runtime/parallel.h"
#include "surface/fit.h"

#include <algorithm>
#include <numbers>
#include <queue>

namespace quadseg::exact {

namespace {

constexpr double crease_share = 0.6;
constexpr double least_crease = 17 * std::numbers::pi / 180;
constexpr std::size_t few_facets = 6;

Surface plane_of(const Facet& facet) {
    Surface s;
    s.type = SurfaceType::plane;
    s.axis = to_array(facet.normal);
    s.point = to_array(facet.normal * facet.offset);
    return s;
}

/// Share of a facet's perimeter that is a crease sharper than `angle`, a border, or explained beyond.
double bounded_share(const Scene& scene, const Explained& state, std::size_t facet, double angle) {
    double perimeter = 0, bounded = 0;
    for (std::size_t j = scene.facets.begin[facet]; j < scene.facets.begin[facet + 1]; ++j) {
        const std::uint32_t f = scene.facets.face[j];
        for (int k = 0; k < 3; ++k) {
            const std::int32_t g = scene.mesh.neighbors[f][static_cast<std::size_t>(k)];
            if (g >= 0 && scene.facets.of_face[static_cast<std::size_t>(g)] == static_cast<std::int32_t>(facet))
                continue;
            const double length = norm(scene.mesh.corner(f, (k + 1) % 3) - scene.mesh.corner(f, k));
            perimeter += length;
            if (g < 0 || state.region[static_cast<std::size_t>(g)] >= 0 ||
                dihedral(scene.mesh, f, static_cast<std::size_t>(g)) > angle) {
                bounded += length;
            }
        }
    }
    return perimeter > 0 ? bounded / perimeter : 1;
}

void claim_facet(const Scene& scene, Explained& state, std::size_t facet) {
    const std::int32_t region = state.add(plane_of(scene.facets.facet[facet]));
    for (std::size_t j = scene.facets.begin[facet]; j < scene.facets.begin[facet + 1]; ++j) {
        const std::uint32_t f = scene.facets.face[j];
        if (state.region[f] < 0) state.region[f] = region;
    }
}

bool is_free(const Scene& scene, const Explained& state, std::size_t facet) {
    for (std::size_t j = scene.facets.begin[facet]; j < scene.facets.begin[facet + 1]; ++j) {
        if (state.region[scene.facets.face[j]] >= 0) return false;
    }
    return true;
}

/// Fans of slivers close the ends of rows: their vertices turn far round the surface, and their normals with them, but
/// lie on it to the last digit.
bool is_exact_sliver(const Scene& scene, std::size_t f, const FaceFit& fit) {
    constexpr double largest_tilt = 45 * std::numbers::pi / 180;
    const double height = static_cast<double>(scene.heights[f]);
    return fit.distance <= scene.tolerances.fit && fit.angle <= largest_tilt &&
           2 * scene.mesh.areas[f] > 5 * height * height;
}

}  // namespace

void add_planes(const Scene& scene, double largest_step, Explained& state) {
    const double angle = std::max(1.2 * largest_step, least_crease);
    std::vector<std::size_t> planes;
    for (std::size_t facet = 0; facet < scene.facets.count(); ++facet) {
        scene.control.check();
        if (!(scene.facets.facet[facet].area > 0) || !is_free(scene, state, facet)) continue;
        if (bounded_share(scene, state, facet, angle) >= crease_share) planes.push_back(facet);
    }
    for (const std::size_t facet : planes) {
        scene.control.check();
        claim_facet(scene, state, facet);
    }
    for (const auto& component : free_components(scene, state, false)) {
        scene.control.check();
        std::vector<std::int32_t> facets;
        facets.reserve(component.size());
        for (const std::uint32_t f : component) facets.push_back(scene.facets.of_face[f]);
        std::sort(facets.begin(), facets.end());
        facets.erase(std::unique(facets.begin(), facets.end()), facets.end());
        if (facets.size() > few_facets || component.size() < 2 * facets.size()) continue;
        for (const std::int32_t facet : facets) {
            if (scene.facets.facet[static_cast<std::size_t>(facet)].area > 0) {
                claim_facet(scene, state, static_cast<std::size_t>(facet));
            }
        }
    }
}

void extend_to_borders(const Scene& scene, double largest_step, Explained& state) {
    struct Offer {
        double cost;
        std::uint32_t face;
        std::int32_t region;
        bool operator<(const Offer& b) const {
            return cost != b.cost ? cost > b.cost : face != b.face ? face > b.face : region > b.region;
        }
    };
    std::vector<FaceFitter> fitters;
    fitters.reserve(state.surface.size());
    for (const Surface& s : state.surface) fitters.emplace_back(scene, s);
    std::priority_queue<Offer> offers;
    const auto offer_neighbours = [&](std::uint32_t f) {
        const std::int32_t region = state.region[f];
        for (const std::int32_t g : scene.mesh.neighbors[f]) {
            if (g < 0 || state.region[static_cast<std::size_t>(g)] >= 0) continue;
            const FaceFit fit = fitters[static_cast<std::size_t>(region)](static_cast<std::size_t>(g));
            const bool curved = state.surface[static_cast<std::size_t>(region)].type != SurfaceType::plane;
            const bool lies_on = fit.within(scene.tolerances.border) && !(curved && fit.step > 1.7 * largest_step);
            if (!lies_on && !(curved && is_exact_sliver(scene, static_cast<std::size_t>(g), fit))) continue;
            offers.push({fit.distance, static_cast<std::uint32_t>(g), region});
        }
    };
    // All threads look for faces of regions that have free ones beside them.
    constexpr std::size_t block = 16384;
    const auto find_ends = [&](std::size_t begin, std::size_t end, std::vector<std::uint32_t>& ends) {
        scene.control.check();
        const auto is_free = [&](std::int32_t g) { return g >= 0 && state.region[static_cast<std::size_t>(g)] < 0; };
        for (std::size_t f = begin; f < end; ++f) {
            const auto& neighbors = scene.mesh.neighbors[f];
            if (state.region[f] >= 0 && std::any_of(neighbors.begin(), neighbors.end(), is_free))
                ends.push_back(static_cast<std::uint32_t>(f));
        }
    };
    std::size_t polls = 0;
    for (const std::uint32_t f : runtime::collect_blocks<std::uint32_t>(state.region.size(), block, find_ends)) {
        scene.control.check_often(polls);
        offer_neighbours(f);
    }
    while (!offers.empty()) {
        scene.control.check_often(polls);
        const Offer offer = offers.top();
        offers.pop();
        if (state.region[offer.face] >= 0) continue;
        state.region[offer.face] = offer.region;
        offer_neighbours(offer.face);
    }
}

}  // namespace quadseg::exact
