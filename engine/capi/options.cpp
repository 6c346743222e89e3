#include <quadseg/options.h>

#include "capi/guard.h"
#include "capi/handles.h"
#include "capi/versioned.h"

#include <cstdint>

namespace quadseg::capi {
namespace {

quadseg_options defaults() noexcept {
    const Options o;
    quadseg_options c{};
    c.struct_size = sizeof c;
    c.preset = static_cast<std::int32_t>(o.preset);
    c.method = static_cast<std::int32_t>(o.method);
    c.smooth = o.smooth;
    c.project = o.project;
    c.project_joint = o.project_joint;
    c.regularities = o.regularities;
    c.smoothing_band = o.smoothing.band;
    c.smoothing_lambda = o.smoothing.lambda;
    c.regions = o.regions;
    c.tolerance = o.tolerance;
    c.detail = o.detail;
    c.feature_angle = o.feature_angle;
    c.weight = o.weight;
    c.seed = o.seed;
    c.coarse = o.coarse;
    c.paper_lloyd_iterations = o.paper.lloyd_iterations;
    c.paper_teleportations = o.paper.teleportations;
    c.paper_merging = o.paper.merging;
    c.paper_teleportation = o.paper.teleportation;
    c.paper_convergence = o.paper.convergence;
    c.paper_plane_tolerance = o.paper.plane_tolerance;
    c.paper_merge_tolerance = o.paper.merge_tolerance;
    c.paper_energy_threshold = o.paper.energy_threshold;
    c.paper_initial_regions = o.paper.initial_regions;
    c.paper_maximum_regions = o.paper.maximum_regions;
    return c;
}

quadseg_status in_range(const char* name, std::int32_t value, std::int32_t last) noexcept {
    if (value >= 0 && value <= last) return QUADSEG_OK;
    return fail(QUADSEG_INVALID_ARGUMENT, "%s: must be 0 to %d, but is %d", name, static_cast<int>(last),
                static_cast<int>(value));
}

}  // namespace

quadseg_status to_options(const quadseg_options* given, Options& o) {
    if (!given) return QUADSEG_OK;
    quadseg_options c = defaults();
    if (const auto status = copy_in("quadseg_options", *given, c)) return status;
    const struct {
        const char* name;
        std::int32_t value, last;
    } choices[]{{"preset", c.preset, QUADSEG_PRESET_PAPER},
                {"method", c.method, QUADSEG_METHOD_HIERARCHICAL},
                {"smooth", c.smooth, 1},
                {"project", c.project, 1},
                {"project_joint", c.project_joint, 1},
                {"regularities", c.regularities, 1},
                {"paper_merging", c.paper_merging, 1},
                {"paper_teleportation", c.paper_teleportation, 1}};
    for (const auto& choice : choices) {
        if (const auto status = in_range(choice.name, choice.value, choice.last)) return status;
    }
    o.preset = static_cast<Preset>(c.preset);
    o.method = static_cast<Method>(c.method);
    o.smooth = c.smooth != 0;
    o.project = c.project != 0;
    o.project_joint = c.project_joint != 0;
    o.regularities = c.regularities != 0;
    o.smoothing.band = c.smoothing_band;
    o.smoothing.lambda = c.smoothing_lambda;
    o.regions = static_cast<std::size_t>(c.regions);
    o.tolerance = c.tolerance;
    o.detail = c.detail;
    o.feature_angle = c.feature_angle;
    o.weight = c.weight;
    o.seed = c.seed;
    o.coarse = c.coarse;
    o.paper.lloyd_iterations = c.paper_lloyd_iterations;
    o.paper.teleportations = c.paper_teleportations;
    o.paper.merging = c.paper_merging != 0;
    o.paper.teleportation = c.paper_teleportation != 0;
    o.paper.convergence = c.paper_convergence;
    o.paper.plane_tolerance = c.paper_plane_tolerance;
    o.paper.merge_tolerance = c.paper_merge_tolerance;
    o.paper.energy_threshold = c.paper_energy_threshold;
    o.paper.initial_regions = static_cast<std::size_t>(c.paper_initial_regions);
    o.paper.maximum_regions = static_cast<std::size_t>(c.paper_maximum_regions);
    return QUADSEG_OK;
}

}  // namespace quadseg::capi

extern "C" quadseg_status quadseg_options_init(quadseg_options* options, size_t struct_size) {
    using namespace quadseg::capi;
    if (!options) return null_pointer("options");
    if (struct_size < first_size<quadseg_options> || struct_size > UINT32_MAX) {
        return wrong_size<quadseg_options>("quadseg_options", struct_size);
    }
    quadseg_options ours = defaults();
    ours.struct_size = static_cast<std::uint32_t>(struct_size);
    write_bytes(ours, options, struct_size);
    return QUADSEG_OK;
}
