#include "flow/standard.h"

#include "exact/exact.h"
#include "flow/accidents.h"
#include "flow/divided.h"
#include "flow/fast.h"
#include "flow/freeform.h"
#include "flow/noise.h"
#include "flow/noisy_coarse.h"
#include "partition/leaves.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace quadseg::flow {

namespace {

/// Share of the area below which exact surfaces are accidents: the mesh is one without.
constexpr double little = 0.1;

/// Numbers regions by first face; surfaces of regions that have no faces any more go.
void drop_empty_regions(partition::Labels& labels, std::vector<Surface>& surfaces) {
    std::vector<std::int32_t> renumbered;
    std::vector<Surface> kept(partition::compact(labels, renumbered));
    for (std::size_t r = 0; r < renumbered.size(); ++r) {
        if (renumbered[r] >= 0) kept[static_cast<std::size_t>(renumbered[r])] = surfaces[r];
    }
    surfaces = std::move(kept);
}

/// Surfaces that noise would never let through, on a good part of the mesh. Planes do not count: scans have bases.
bool shows_exact_surfaces(const mesh::WorkMesh& mesh, const exact::ExactSurfaces& exact) {
    constexpr double enough = 0.05;
    double curved = 0;
    for (std::size_t f = 0; f < exact.labels.size(); ++f) {
        if (exact.labels[f] < 0) continue;
        const Surface& surface = exact.surfaces[static_cast<std::size_t>(exact.labels[f])];
        if (surface.type != SurfaceType::plane) curved += mesh.areas[f];
    }
    return curved > enough * mesh.total_area;
}

/// Surfaces of divided tessellations take the place of the planes that their facets are.
void look_beneath_divisions(const FlowInput& input, exact::ExactSurfaces& exact, std::vector<std::uint8_t>& on_facets) {
    std::optional<DividedSurfaces> divided = find_divided(input, exact);
    if (!divided) return;
    exact.labels = std::move(divided->labels);
    exact.surfaces = std::move(divided->surfaces);
    drop_empty_regions(exact.labels, exact.surfaces);
    on_facets = std::move(divided->on_facets);
}

}  // namespace

FlowResult run_standard(const FlowInput& input) {
    // A wanted number or tolerance is an energy question; only the choice of their own makes surfaces the question.
    if (input.options.regions > 0 || input.options.tolerance > 0) return run_fast(input, fast_options(input.options));
    exact::ExactSurfaces exact;
    try {
        const NoiseEstimate noise = estimate_noise(input.mesh, input.control);
        if (noise.noisy() && !noise.doubtful()) return run_noisy_coarse(input, noise);
        exact = exact::find_exact_surfaces(input.mesh, input.control);
        const bool exact_after_all = !noise.noisy() || exact.partial || shows_exact_surfaces(input.mesh, exact);
        if (!exact_after_all) return run_noisy_coarse(input, noise);
    } catch (const runtime::Stopped&) {
        return run_fast(input, fast_options(input.options));
    }
    FlowResult result, rest;
    result.noise = exact.noise;
    result.partial = exact.partial;
    if (result.partial) result.stop = input.control.cancelled() ? StopReason::cancelled : StopReason::deadline;
    if (exact.covered < little) release_accidents(exact.labels);
    bool free = true;
    try {
        if (!result.partial) look_beneath_divisions(input, exact, result.on_facets);
        free = std::find(exact.labels.begin(), exact.labels.end(), -1) != exact.labels.end();
        if (free) rest = group_freeform(input, exact.surfaces, exact.labels);
    } catch (const runtime::Stopped& stopped) {
        rest.labels.resize(exact.labels.size());
        std::transform(exact.labels.begin(), exact.labels.end(), rest.labels.begin(),
                       [](std::int32_t label) { return label < 0 ? 0 : -1; });
        rest.regions = partition::connected_parts({&input.mesh, input.features, {}}, rest.labels);
        rest.partial = true;
        rest.stop = stopped.deadline ? StopReason::deadline : StopReason::cancelled;
    }
    if (free) drop_empty_regions(exact.labels, exact.surfaces);
    result.labels = std::move(exact.labels);
    result.surfaces = std::move(exact.surfaces);
    result.regions = result.surfaces.size();
    if (!free) return result;
    const auto first = static_cast<std::int32_t>(result.regions);
    for (std::size_t f = 0; f < result.labels.size(); ++f) {
        if (result.labels[f] < 0) result.labels[f] = first + rest.labels[f];
    }
    result.faceted.assign(result.regions, 0);
    result.faceted.insert(result.faceted.end(), rest.faceted.begin(), rest.faceted.end());
    result.regions += rest.regions;
    if (exact.covered < little) std::fill(result.faceted.begin() + first, result.faceted.end(), std::uint8_t{1});
    result.faceted.resize(result.regions, 0);
    Surface freeform;
    freeform.type = SurfaceType::freeform;
    result.surfaces.resize(result.regions, freeform);
    result.stop = rest.stop;
    result.partial = rest.partial;
    result.history = std::move(rest.history);
    return result;
}

}  // namespace quadseg::flow
