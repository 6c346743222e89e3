#include <quadseg/error.h>
#include <quadseg/segmentation.h>

#include "flow/dispatch.h"
#include "flow/finish.h"
#include "flow/flow.h"
#include "flow/memory_estimate.h"
#include "flow/noise.h"
#include "flow/project.h"
#include "flow/representable.h"
#include "mesh/features.h"
#include "mesh/work_mesh.h"
#include "runtime/parallel.h"
#include "runtime/resources.h"
#include "runtime/run_control.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>

namespace quadseg {

namespace {

using Clock = std::chrono::steady_clock;
using runtime::seconds_since;

int threads_of(const Context* context) {
    const int wanted = context != nullptr ? context->threads() : 0;
    return wanted > 0 ? std::min(wanted, runtime::arena_threads()) : runtime::arena_threads();
}

void check_memory(const MeshView& mesh, const Options& options, const Context* context, flow::Surfaces surfaces) {
    if (!context || context->memory_limit() == 0) return;
    const std::size_t need = flow::estimated_bytes(mesh, options, threads_of(context), surfaces);
    if (need > context->memory_limit()) {
        throw Error(ErrorCode::memory_limit, "segmenting " + std::to_string(mesh.face_count()) + " faces" +
                                                 (surfaces == flow::Surfaces::noisy ? " of a noisy mesh" : "") +
                                                 " needs about " + std::to_string(need >> 20) + " MiB, the limit is " +
                                                 std::to_string(context->memory_limit() >> 20) +
                                                 " MiB; raise the limit or simplify the mesh first");
    }
}

/// Only now can it be told whether the mesh is noisy, which takes more.
void check_memory_of_noise(const MeshView& view, const flow::FlowInput& input, const Context* context) {
    if (!context || context->memory_limit() == 0 || !flow::noise_matters(input.options)) return;
    if (!flow::estimate_noise(input.mesh, input.control).noisy()) return;
    check_memory(view, input.options, context, flow::Surfaces::noisy);
}

/// What a run that was stopped before there was any partition returns: one region of everything.
Segmentation nothing_yet(const MeshView& mesh, bool deadline) {
    Segmentation result;
    result.labels.assign(mesh.face_count(), 0);
    result.regions.resize(mesh.face_count() > 0 ? 1 : 0);
    for (Region& region : result.regions) {
        region.faces = mesh.face_count();
        region.surface.type = SurfaceType::freeform;
        region.valid = false;
    }
    result.partial = true;
    result.stop = deadline ? StopReason::deadline : StopReason::cancelled;
    result.input.faces = mesh.face_count();
    result.input.vertices = mesh.vertex_count();
    return result;
}

Segmentation segment_in_arena(const MeshView& view, const Options& options, const Context* context,
                              const runtime::RunControl& control) {
    const auto start = Clock::now();
    Segmentation result;
    try {
        control.report(Phase::prepare, 0.05);
        const mesh::WorkMesh mesh = mesh::build_work_mesh(view, control);
        flow::require_representable(mesh.report);
        std::optional<mesh::FeatureEdges> features;
        if (options.feature_angle > 0) features = mesh::find_feature_edges(mesh, options.feature_angle, control);
        const double prepared = seconds_since(start);
        control.report(Phase::fine, 0.2);
        const flow::FlowInput input{mesh, features ? &*features : nullptr, options, control};
        check_memory_of_noise(view, input, context);
        flow::FlowResult flow = flow::run_flow(input);
        const double flowed = seconds_since(start);
        control.report(Phase::post, 0.9, flow.regions);
        const double coarse = flow.coarse_seconds;
        result = flow::finish(input, std::move(flow));
        if (options.project) flow::UnusedVertices(mesh, view.positions).restore(result.projected);
        result.seconds.prepare = prepared;
        result.seconds.coarse = coarse;
        result.seconds.fine = flowed - prepared - coarse;
        result.seconds.post = seconds_since(start) - flowed;
        control.report(Phase::post, 1, result.regions.size(), result.energy.total);
    } catch (const runtime::Stopped& stopped) {
        result = nothing_yet(view, stopped.deadline);
    }
    result.seconds.total = seconds_since(start);
    return result;
}

}  // namespace

Segmentation segment(const MeshView& mesh, const Options& options, Context* context) {
    const std::vector<std::string> problems = validate(options);
    if (!problems.empty()) {
        std::string text;
        for (const std::string& problem : problems) text += (text.empty() ? "" : " ") + problem;
        throw Error(ErrorCode::invalid_argument, text);
    }
    check_memory(mesh, options, context, flow::Surfaces::clean);
    const runtime::RunControl control(context);
    Segmentation result;
    runtime::in_arena(context ? context->threads() : 0, [&] {
        result = segment_in_arena(mesh, options, context, control);
        result.threads = runtime::arena_threads();
    });
    // The flows know that they were stopped; why, the context knows best.
    if (result.partial && context) {
        result.stop = context->cancelled() ? StopReason::cancelled : StopReason::deadline;
    }
    result.peak_bytes = runtime::peak_resident_bytes();
    return result;
}

}  // namespace quadseg
