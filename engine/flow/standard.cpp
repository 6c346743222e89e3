#include "flow/standard.h"

#include "exact/exact.h"
#include "flow/divided.h"
#include "flow/fast.h"
#include "flow/freeform.h"
#include "flow/noise.h"
#include "flow/noisy.h"
#include "partition/leaves.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace quadseg::flow {

namespace {

/// Share of the area below which exact surfaces are accidents: the mesh is one without.
constexpr double little = 0.1;

/// Numbers regions by first face; surfaces of regions that have no faces any more go.
void drop_empty_regions(FlowResult& result) {
    std::vector<std::int32_t> renumbered;
    result.regions = partition::compact(result.labels, renumbered);
    std::vector<Surface> surfaces(result.regions);
    for (std::size_t r = 0; r < renumbered.size(); ++r) {
        if (renumbered[r] >= 0) surfaces[static_cast<std::size_t>(renumbered[r])] = result.surfaces[r];
    }
    result.surfaces = std::move(surfaces);
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
void look_beneath_divisions(const FlowInput& input, FlowResult& result) {
    std::optional<DividedSurfaces> divided = find_divided(input, result.labels, result.surfaces);
    if (!divided) return;
    result.labels = std::move(divided->labels);
    result.surfaces = std::move(divided->surfaces);
    result.on_facets = std::move(divided->on_facets);
    drop_empty_regions(result);
}

}  // namespace

FlowResult run_standard(const FlowInput& input) {
    // A wanted number or tolerance is an energy question; only the choice of their own makes surfaces the question.
    if (input.options.regions > 0 || input.options.tolerance > 0) return run_fast(input, fast_options(input.options));
    exact::ExactSurfaces exact;
    try {
        const NoiseEstimate noise = estimate_noise(input.mesh, input.control);
        if (noise.noisy() && !noise.doubtful()) return run_noisy(input, noise);
        exact = exact::find_exact_surfaces(input.mesh, input.control);
        const bool exact_after_all = !noise.noisy() || exact.partial || shows_exact_surfaces(input.mesh, exact);
        if (!exact_after_all) return run_noisy(input, noise);
    } catch (const runtime::Stopped&) {
        return run_fast(input, fast_options(input.options));
    }
    FlowResult result;
    result.labels = std::move(exact.labels);
    result.surfaces = std::move(exact.surfaces);
    result.regions = result.surfaces.size();
    result.noise = exact.noise;
    result.partial = exact.partial;
    if (result.partial) result.stop = input.control.cancelled() ? StopReason::cancelled : StopReason::deadline;
    FlowResult rest;
    try {
        if (!result.partial) look_beneath_divisions(input, result);
        if (std::find(result.labels.begin(), result.labels.end(), -1) == result.labels.end()) return result;
        rest = group_freeform(input, result.surfaces, result.labels);
    } catch (const runtime::Stopped& stopped) {
        rest.labels.resize(result.labels.size());
        std::transform(result.labels.begin(), result.labels.end(), rest.labels.begin(),
                       [](std::int32_t label) { return label < 0 ? 0 : -1; });
        rest.regions = partition::connected_parts({&input.mesh, input.features, {}}, rest.labels);
        rest.partial = true;
        rest.stop = stopped.deadline ? StopReason::deadline : StopReason::cancelled;
    }
    drop_empty_regions(result);
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
