// Boundary relaxation from merged labels, with surfaces from moments and with complete fits.
#include "bench/micro/machine.h"
#include "datasets/generate.h"
#include "flow/fast.h"
#include "mesh/work_mesh.h"
#include "partition/pair_merge.h"
#include "partition/relax.h"

#include <benchmark/benchmark.h>

namespace quadseg {
namespace {

const runtime::RunControl free_run(nullptr);

void relaxation(benchmark::State& state) {
    const mesh::WorkMesh mesh = mesh::build_work_mesh(
        datasets::generate("plate", static_cast<std::size_t>(state.range(0))).mesh.view(), free_run);
    const partition::Passage passage{&mesh};
    const Options options;
    flow::FastOptions fast = flow::fast_options(options);
    fast.moment_steps = 0;
    fast.relax_steps = 0;
    const flow::FlowResult merged = flow::run_fast({mesh, nullptr, options, free_run}, fast);
    const auto regions = partition::measure_regions(
        mesh, merged.labels, merged.regions, [](const quadric::Moments&) { return partition::RegionScore{}; },
        free_run);
    partition::RelaxOptions relax;
    relax.moment_steps = static_cast<int>(state.range(1));
    relax.steps = static_cast<int>(state.range(2));
    double energy = 0;
    for (auto _ : state) {
        partition::Labels labels = merged.labels;
        energy = partition::relax(passage, labels, regions, relax, free_run).energy;
    }
    state.counters["energy"] = energy;
    // A step looks at labels and neighbours of all faces; complete fits visit all faces of the regions that changed,
    // most of them in the first step.
    const double steps = static_cast<double>(state.range(1) + state.range(2));
    const double complete = state.range(2) > 0 ? 2 : 0;
    bench::report(state, static_cast<double>(mesh.face_count()), steps * 16 + complete * 104 * 11,
                  complete * (500 + 5 * 725 / 2.0));
}

void complete_flow(benchmark::State& state) {
    const mesh::WorkMesh mesh = mesh::build_work_mesh(
        datasets::generate("plate", static_cast<std::size_t>(state.range(0))).mesh.view(), free_run);
    const Options options;
    for (auto _ : state) {
        benchmark::DoNotOptimize(flow::run_fast({mesh, nullptr, options, free_run}, flow::fast_options(options)));
    }
    // Leaves, their moments, merging, two steps on moments and three complete ones, as counted one by one.
    bench::report(state, static_cast<double>(mesh.face_count()), 48 + 124 + 74 + 2368, 20 + 500 + 290 + 4625);
}

BENCHMARK(relaxation)->Args({100000, 6, 0})->Args({100000, 0, 6})->Args({100000, 2, 3})->Unit(benchmark::kMillisecond);
BENCHMARK(complete_flow)->Arg(10000)->Arg(100000)->Arg(1000000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace quadseg
