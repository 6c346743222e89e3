#include <quadseg/error.h>
#include <quadseg/segmenter.h>

#include "flow/dispatch.h"
#include "flow/final_surfaces.h"
#include "flow/finish.h"
#include "flow/paper_loop.h"
#include "flow/project.h"
#include "flow/representable.h"
#include "flow/smooth_borders.h"
#include "mesh/features.h"
#include "mesh/work_mesh.h"
#include "runtime/parallel.h"
#include "runtime/run_control.h"

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace quadseg {

namespace {

[[noreturn]] void reject(const std::string& text) {
    throw Error(ErrorCode::invalid_argument, text);
}

void check_options(const Options& options) {
    std::string text;
    for (const std::string& problem : validate(options)) text += (text.empty() ? "" : " ") + problem;
    if (!text.empty()) reject(text);
}

}  // namespace

struct Segmenter::Impl {
    Impl(const MeshView& view, const Options& chosen, Context* given)
        : options(chosen), context(given != nullptr ? *given : Context()) {
        const runtime::RunControl control(&context);
        in_arena([&] {
            auto prepared = std::make_shared<Prepared>();
            prepared->mesh = mesh::build_work_mesh(view, control);
            flow::require_representable(prepared->mesh.report);
            prepared->unused = flow::UnusedVertices(prepared->mesh, view.positions);
            shared = std::move(prepared);
            start(control, nullptr);
        });
    }

    /// The mesh and the partition of another one, under other options.
    Impl(const Impl& other, const Options& chosen) : options(chosen), context(other.context), shared(other.shared) {
        const runtime::RunControl control(&context);
        in_arena([&] { start(control, &other.loop->state().labels); });
    }

    /// `labels` null: one region a component.
    void start(const runtime::RunControl& control, const partition::Labels* labels) {
        if (options.feature_angle > 0) features = mesh::find_feature_edges(mesh(), options.feature_angle, control);
        loop.emplace(flow_input(control));
        if (labels != nullptr) {
            adopt(*labels);
        } else {
            loop->start_from_components();
        }
        loop->set_control(never);
        update_labels();
    }

    const mesh::WorkMesh& mesh() const noexcept { return shared->mesh; }

    flow::FlowInput flow_input(const runtime::RunControl& control) const {
        return {mesh(), features ? &*features : nullptr, options, control};
    }

    template <class Body>
    void in_arena(const Body& body) const {
        try {
            runtime::in_arena(context.threads(), body);
        } catch (const runtime::Stopped& stopped) {
            throw Error(ErrorCode::cancelled, stopped.deadline ? "the operation ran out of time; nothing was changed"
                                                               : "the operation was cancelled; nothing was changed");
        }
    }

    /// Runs an operation that changes the partition. It is undone as a whole when it throws.
    template <class Body>
    void change(const Body& body) {
        flow::LoopState before = loop->state();
        const runtime::RunControl control(&context);
        loop->set_control(control);
        try {
            in_arena([&] { body(control); });
        } catch (...) {
            loop->set_control(never);
            loop->restore(before);
            throw;
        }
        loop->set_control(never);
        history.push_back(std::move(before));
        update_labels();
    }

    void update_labels() {
        input_labels = mesh::labels_to_input(mesh(), loop->state().labels);
        classified.reset();
    }

    /// The current partition as a flow returns it, with the surfaces that the last run verified while they hold.
    flow::FlowResult current() const {
        if (last_run && last_run->labels == loop->state().labels) return *last_run;
        flow::FlowResult flow;
        flow.labels = loop->state().labels;
        flow.regions = loop->state().regions();
        return flow;
    }

    std::vector<flow::FinalSurface> surfaces(const flow::FlowResult& flow, const runtime::RunControl& control) const {
        return flow::final_surfaces(flow_input(control), partition::region_faces(flow.labels, flow.regions), flow);
    }

    /// Splits regions at borders and features where they need it; true when the labels stayed as they were.
    bool adopt(partition::Labels labels) {
        partition::Labels parts = labels;
        const std::size_t count = partition::connected_parts(loop->passage(), parts);
        const auto regions = static_cast<std::size_t>(*std::max_element(labels.begin(), labels.end()) + 1);
        const bool whole = count == regions;
        loop->start_from_labels(whole ? labels : parts);
        return whole;
    }

    std::uint32_t work_face(std::size_t face) const {
        if (face >= mesh().label_source.size()) {
            reject("face " + std::to_string(face) + " does not exist: the mesh has " +
                   std::to_string(mesh().label_source.size()) + " faces");
        }
        if (mesh().label_source[face] == mesh::no_face) {
            reject("face " + std::to_string(face) + " is degenerate and belongs to no region");
        }
        return static_cast<std::uint32_t>(mesh().label_source[face]);
    }

    void insert_at(std::uint32_t face) {
        if (!loop->insert(face)) reject("a region of one face cannot be split");
        loop->lloyd(1, flow::FloodScope::affected, false);
    }

    std::pair<std::uint32_t, std::uint32_t> adjacent(std::int32_t a, std::int32_t b) const {
        const auto count = loop->state().regions();
        for (const std::int32_t r : {a, b}) {
            if (r < 0 || static_cast<std::size_t>(r) >= count) {
                reject("region " + std::to_string(r) + " does not exist: there are " + std::to_string(count));
            }
        }
        const auto low = static_cast<std::uint32_t>(std::min(a, b)), high = static_cast<std::uint32_t>(std::max(a, b));
        const auto pairs = partition::region_pairs(loop->passage(), loop->state().labels, never);
        const bool touch = std::any_of(pairs.begin(), pairs.end(),
                                       [&](const partition::RegionPair& p) { return p.a == low && p.b == high; });
        if (!touch) {
            reject("regions " + std::to_string(a) + " and " + std::to_string(b) +
                   " share no edge that a region may cross");
        }
        return {low, high};
    }

    Options options;
    Context context;
    struct Prepared {
        mesh::WorkMesh mesh;
        flow::UnusedVertices unused;
    };
    std::shared_ptr<const Prepared> shared;  ///< does not depend on the options
    std::optional<mesh::FeatureEdges> features;
    runtime::RunControl never{nullptr};
    std::optional<flow::VariationalLoop> loop;
    std::vector<flow::LoopState> history;
    std::vector<std::int32_t> input_labels;
    std::optional<std::vector<flow::FinalSurface>> classified;  ///< of the current labels
    std::optional<flow::FlowResult> last_run;                   ///< holds for as long as the labels are its own
};

Segmenter::Segmenter(const MeshView& mesh, const Options& options, Context* context) {
    check_options(options);
    impl_ = std::make_unique<Impl>(mesh, options, context);
}
Segmenter::~Segmenter() = default;
Segmenter::Segmenter(Segmenter&&) noexcept = default;
Segmenter& Segmenter::operator=(Segmenter&&) noexcept = default;

std::size_t Segmenter::region_count() const noexcept {
    return impl_->loop->state().regions();
}

std::span<const std::int32_t> Segmenter::labels() const {
    return impl_->input_labels;
}

Energy Segmenter::energy() const {
    return impl_->loop->energy_terms();
}

const MeshReport& Segmenter::input() const noexcept {
    return impl_->mesh().report;
}

void Segmenter::set_labels(std::span<const std::int32_t> labels) {
    if (labels.size() != impl_->mesh().label_source.size()) {
        reject("labels: " + std::to_string(labels.size()) + " given for " +
               std::to_string(impl_->mesh().label_source.size()) + " faces");
    }
    partition::Labels work = mesh::labels_from_input(impl_->mesh(), labels);
    std::map<std::int32_t, std::int32_t> numbers;  // the caller's integers in ascending order become 0, 1, …
    for (const std::int32_t label : work) numbers.emplace(label, 0);
    std::int32_t next = 0;
    for (auto& [label, number] : numbers) number = next++;
    for (std::int32_t& label : work) label = numbers[label];
    impl_->change([&](const runtime::RunControl&) { impl_->adopt(std::move(work)); });
}

void Segmenter::set_context(Context* context) {
    impl_->context = context != nullptr ? *context : Context();
}

void Segmenter::set_options(const Options& options) {
    check_options(options);
    impl_ = std::make_unique<Impl>(*impl_, options);
}

StopReason Segmenter::run() {
    StopReason stop = StopReason::converged;
    impl_->change([&](const runtime::RunControl& control) {
        flow::FlowResult flow = flow::run_flow(impl_->flow_input(control));
        stop = flow.stop;
        impl_->loop->set_control(impl_->never);  // a partial partition is taken over, whatever stopped it
        if (impl_->adopt(flow.labels)) {
            impl_->last_run = std::move(flow);
        } else {
            impl_->last_run.reset();
        }
    });
    return stop;
}

std::int32_t Segmenter::insert(std::size_t face) {
    const std::uint32_t seed = impl_->work_face(face);
    impl_->change([&](const runtime::RunControl&) { impl_->insert_at(seed); });
    return static_cast<std::int32_t>(region_count()) - 1;
}

std::int32_t Segmenter::insert() {
    const auto order = impl_->loop->regions_to_split();
    const auto face = order.empty() ? std::nullopt : impl_->loop->face_to_split(order.front());
    if (!face) reject("every region has one face: nothing can be inserted");
    impl_->change([&](const runtime::RunControl&) { impl_->insert_at(*face); });
    return static_cast<std::int32_t>(region_count()) - 1;
}

void Segmenter::merge(std::int32_t a, std::int32_t b) {
    const auto pair = impl_->adjacent(a, b);
    impl_->change([&](const runtime::RunControl&) { impl_->loop->merge(pair.first, pair.second); });
}

Segmenter::MergeCandidate Segmenter::merge_candidate(std::int32_t a, std::int32_t b) const {
    const auto pair = impl_->adjacent(a, b);
    const auto candidate = impl_->loop->merge_candidate(pair.first, pair.second);
    return {candidate.increase, candidate.valid};
}

double Segmenter::relax(int iterations) {
    if (iterations < 1) reject("iterations must be at least 1");
    impl_->change([&](const runtime::RunControl&) { impl_->loop->lloyd(iterations, flow::FloodScope::all, true); });
    return impl_->loop->state().energy;
}

void Segmenter::smooth() {
    impl_->change([&](const runtime::RunControl& control) {
        flow::FlowResult flow = impl_->current();
        const auto surfaces = impl_->classified ? *impl_->classified : impl_->surfaces(flow, control);
        const bool changed = flow::smooth_borders(impl_->flow_input(control), flow, surfaces);
        control.check();
        if (changed) impl_->adopt(std::move(flow.labels));
    });
}

void Segmenter::classify() {
    impl_->in_arena([&] {
        const runtime::RunControl control(&impl_->context);
        control.check();
        impl_->classified = impl_->surfaces(impl_->current(), control);
    });
}

std::vector<double> Segmenter::project() const {
    std::vector<double> projected;
    impl_->in_arena([&] {
        const runtime::RunControl control(&impl_->context);
        control.check();
        const flow::FlowResult flow = impl_->current();
        const auto surfaces = impl_->classified ? *impl_->classified : impl_->surfaces(flow, control);
        projected = flow::projected_positions(impl_->flow_input(control), flow.labels, surfaces);
    });
    impl_->shared->unused.restore(projected);
    return projected;
}

bool Segmenter::undo() {
    if (impl_->history.empty()) return false;
    impl_->loop->restore(impl_->history.back());
    impl_->history.pop_back();
    impl_->update_labels();
    return true;
}

Segmentation Segmenter::result() const {
    flow::FlowResult flow = impl_->current();
    Segmentation result;
    runtime::in_arena(impl_->context.threads(), [&] {
        result = flow::finish(impl_->flow_input(impl_->never), std::move(flow));
        result.threads = runtime::arena_threads();
    });
    impl_->shared->unused.restore(result.projected);
    return result;
}

}  // namespace quadseg
