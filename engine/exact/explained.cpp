#include "exact/explained.h"

#include "mesh/connected.h"

#include <algorithm>

namespace quadseg::exact {

void separate_parts(const Scene& scene, Explained& state) {
    if (state.region == state.separate) {
        state.surface.resize(state.separate_count);
        return;
    }
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
    state.separate = state.region;
    state.separate_count = count;
    state.surface = std::move(surfaces);
}

std::vector<std::vector<std::uint32_t>> free_components(const Scene& scene, const Explained& state,
                                                        bool within_creases) {
    if (std::find(state.region.begin(), state.region.end(), -1) == state.region.end()) return {};
    std::vector<std::int32_t> part;
    const std::size_t count = mesh::connected_faces(
        scene.mesh, [&](std::size_t f) { return state.region[f] < 0; },
        [&](std::size_t f, std::size_t k, std::size_t) {
            return !(within_creases && scene.is_crease(f, static_cast<int>(k)));
        },
        [&] { scene.control.check(); }, part);
    std::vector<std::vector<std::uint32_t>> components(count);
    for (std::size_t f = 0; f < part.size(); ++f) {
        if (part[f] >= 0) components[static_cast<std::size_t>(part[f])].push_back(static_cast<std::uint32_t>(f));
    }
    return components;
}

}  // namespace quadseg::exact
