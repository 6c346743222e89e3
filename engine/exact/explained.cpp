#include "exact/explained.h"

#include "mesh/connected.h"

namespace quadseg::exact {

namespace {

/// Flood over faces for which same(f, g) holds; visit(f) for each, seeds ascending; start(seed) begins a component.
template <class Wanted, class Same, class Start, class Visit>
void flood_components(const Scene& scene, const Wanted& wanted, const Same& same, const Start& start,
                      const Visit& visit) {
    std::vector<std::uint8_t> seen(scene.mesh.face_count(), 0);
    std::vector<std::uint32_t> stack;
    std::size_t polls = 0;
    for (std::size_t seed = 0; seed < seen.size(); ++seed) {
        if (seen[seed] || !wanted(seed)) continue;
        start(seed);
        seen[seed] = 1;
        stack.assign(1, static_cast<std::uint32_t>(seed));
        while (!stack.empty()) {
            scene.control.check_often(polls);
            const std::uint32_t f = stack.back();
            stack.pop_back();
            visit(f);
            for (int k = 0; k < 3; ++k) {
                const std::int32_t g = scene.mesh.neighbors[f][static_cast<std::size_t>(k)];
                if (g < 0 || seen[static_cast<std::size_t>(g)] || !same(f, k, static_cast<std::uint32_t>(g))) continue;
                seen[static_cast<std::size_t>(g)] = 1;
                stack.push_back(static_cast<std::uint32_t>(g));
            }
        }
    }
}

}  // namespace

void separate_parts(const Scene& scene, Explained& state) {
    std::vector<std::int32_t> part;
    const std::vector<std::int32_t>& old = state.region;
    const std::size_t count = mesh::connected_faces(
        scene.mesh, [&](std::size_t f) { return old[f] >= 0; },
        [&](std::size_t f, std::size_t, std::size_t g) { return old[f] == old[g]; }, [&] { scene.control.check(); },
        part);
    std::vector<Surface> surfaces;
    surfaces.reserve(count);
    for (std::size_t f = 0; surfaces.size() < count; ++f) {  // parts are numbered by first face
        if (part[f] == static_cast<std::int32_t>(surfaces.size()))
            surfaces.push_back(state.surface[static_cast<std::size_t>(old[f])]);
    }
    state.region = std::move(part);
    state.surface = std::move(surfaces);
}

std::vector<std::vector<std::uint32_t>> free_components(const Scene& scene, const Explained& state,
                                                        bool within_creases) {
    std::vector<std::vector<std::uint32_t>> components;
    flood_components(
        scene, [&](std::size_t f) { return state.region[f] < 0; },
        [&](std::uint32_t f, int k, std::uint32_t g) {
            return state.region[g] < 0 && !(within_creases && scene.is_crease(f, k));
        },
        [&](std::size_t) { components.emplace_back(); }, [&](std::uint32_t f) { components.back().push_back(f); });
    return components;
}

}  // namespace quadseg::exact
