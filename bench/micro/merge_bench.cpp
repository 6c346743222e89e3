// Bottom-up stages on a generated plate: leaves, leaf moments, initial pair fits with the merge loop.
#include "bench/micro/machine.h"
#include "datasets/generate.h"
#include "mesh/work_mesh.h"
#include "partition/leaves.h"
#include "partition/pair_merge.h"
#include "quadric/ladder.h"

#include <benchmark/benchmark.h>

namespace quadseg {
namespace {

const runtime::RunControl free_run(nullptr);

mesh::WorkMesh plate(const benchmark::State& state) {
    return mesh::build_work_mesh(datasets::generate("plate", static_cast<std::size_t>(state.range(0))).mesh.view(),
                                 free_run);
}
partition::Scorer scorer(bool ladder) {
    return [ladder](const quadric::Moments& m) {
        const quadric::LadderFit fit = quadric::fit_ladder(m, 0.5, ladder);
        return partition::RegionScore{fit.cost, fit.energy, fit.dof};
    };
}
void count_faces(benchmark::State& state, const mesh::WorkMesh& mesh, double bytes_a_face, double operations_a_face) {
    const auto faces = static_cast<double>(mesh.face_count());
    bench::report(state, faces, bytes_a_face, operations_a_face);
}

void leaves(benchmark::State& state) {
    const mesh::WorkMesh mesh = plate(state);
    const partition::Passage passage{&mesh};
    std::size_t count = 0;
    for (auto _ : state) count = partition::grow_leaves(passage, {}, free_run).count;
    state.counters["leaves"] = static_cast<double>(count);
    count_faces(state, mesh, 48, 20);  // normal, area, neighbours, label
}

void leaf_moments(benchmark::State& state) {
    const mesh::WorkMesh mesh = plate(state);
    const partition::Passage passage{&mesh};
    const partition::Leaves leaves = partition::grow_leaves(passage, {}, free_run);
    const partition::Scorer fit = scorer(true);
    for (auto _ : state) {
        benchmark::DoNotOptimize(partition::measure_regions(mesh, leaves.labels, leaves.count, fit, free_run));
    }
    count_faces(state, mesh, 124, 500);  // corners through indices, normal, area
}

void merging(benchmark::State& state) {
    const mesh::WorkMesh mesh = plate(state);
    const partition::Passage passage{&mesh};
    const partition::Leaves leaves = partition::grow_leaves(passage, {}, free_run);
    const partition::Scorer fit = scorer(state.range(1) != 0);
    const auto regions = partition::measure_regions(mesh, leaves.labels, leaves.count, fit, free_run);
    const auto pairs = partition::region_pairs(passage, leaves.labels, free_run);
    partition::MergeRules rules;
    rules.misfit = 0.5 * 0.006;
    for (auto _ : state) benchmark::DoNotOptimize(partition::merge_pairs(regions, pairs, rules, fit, free_run));
    state.SetLabel(state.range(1) != 0 ? "ladder" : "plane or quadric");
    state.counters["leaves"] = static_cast<double>(leaves.count);
    state.counters["s/leaf"] = benchmark::Counter(
        static_cast<double>(leaves.count), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
    // About four pair fits a leaf: two sets of moments each, shifted, added, fitted; the heap's entries besides.
    const double fits = 4 * static_cast<double>(leaves.count) / static_cast<double>(mesh.face_count());
    count_faces(state, mesh, fits * (2 * sizeof(partition::MergeRegion) + 64), fits * (2 * 230 + 3700));
}

BENCHMARK(leaves)->Arg(100000)->Arg(1000000)->Unit(benchmark::kMillisecond);
BENCHMARK(leaf_moments)->Arg(100000)->Arg(1000000)->Unit(benchmark::kMillisecond);
BENCHMARK(merging)->Args({100000, 0})->Args({100000, 1})->Args({1000000, 1})->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace quadseg
