#include "flow/standard.h"

#include "exact/exact.h"
#include "flow/fast.h"
#include "flow/noise.h"
#include "flow/noisy.h"
#include "partition/leaves.h"

#include <algorithm>

namespace quadseg::flow {

namespace {

/// Free-form faces are grouped by energy with a wide misfit: few and stable patches (PROTOTYPE_TRUTH.md 1.14: τ = .03).
constexpr double freeform_misfit_angle = 14;
constexpr double crease_degrees = 30;

FlowResult group_freeform(const FlowInput& input, const partition::Labels& explained) {
    std::vector<std::uint8_t> active(explained.size());
    std::transform(explained.begin(), explained.end(), active.begin(),
                   [](std::int32_t label) { return static_cast<std::uint8_t>(label < 0 ? 1 : 0); });
    FastOptions options = fast_options(input.options);
    options.misfit_angle = freeform_misfit_angle;
    options.active = active;
    if (input.features) return run_fast(input, options);
    // On a clean mesh a crease is a border that the designer meant.
    const mesh::FeatureEdges creases = mesh::find_feature_edges(input.mesh, crease_degrees, input.control);
    return run_fast({input.mesh, &creases, input.options, input.control}, options);
}

}  // namespace

FlowResult run_standard(const FlowInput& input) {
    // A wanted number or tolerance is an energy question; only the choice of their own makes surfaces the question.
    if (input.options.regions > 0 || input.options.tolerance > 0) return run_fast(input, fast_options(input.options));
    exact::ExactSurfaces exact;
    try {
        const NoiseEstimate noise = estimate_noise(input.mesh, input.control);
        if (noise.noisy()) return run_noisy(input, noise);
        exact = exact::find_exact_surfaces(input.mesh, input.control);
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
    if (std::find(result.labels.begin(), result.labels.end(), -1) == result.labels.end()) return result;

    FlowResult rest;
    try {
        rest = group_freeform(input, result.labels);
    } catch (const runtime::Stopped& stopped) {
        rest.labels.resize(result.labels.size());
        std::transform(result.labels.begin(), result.labels.end(), rest.labels.begin(),
                       [](std::int32_t label) { return label < 0 ? 0 : -1; });
        rest.regions = partition::connected_parts({&input.mesh, input.features, {}}, rest.labels);
        rest.partial = true;
        rest.stop = stopped.deadline ? StopReason::deadline : StopReason::cancelled;
    }
    const auto first = static_cast<std::int32_t>(result.regions);
    for (std::size_t f = 0; f < result.labels.size(); ++f) {
        if (result.labels[f] < 0) result.labels[f] = first + rest.labels[f];
    }
    result.regions += rest.regions;
    Surface freeform;
    freeform.type = SurfaceType::freeform;
    result.surfaces.resize(result.regions, freeform);
    result.stop = rest.stop;
    result.partial = rest.partial;
    result.history = std::move(rest.history);
    return result;
}

}  // namespace quadseg::flow
