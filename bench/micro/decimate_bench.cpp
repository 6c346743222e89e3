// Decimation against OpenMesh's: faces a second, and the error that the speed costs (RMS over both directions).
#include "bench/micro/machine.h"
#include "simplify/decimate.h"
#include "tests/simplify/mesh_distance.h"
#include "tests/simplify/openmesh_reference.h"
#include "tests/simplify/small_meshes.h"

#include <benchmark/benchmark.h>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace {

using namespace quadseg;
using namespace quadseg::simplify;

/// A wavy torus of 4·n² faces: smooth, closed, curved everywhere, nothing to gain from planes.
SmallMesh wavy_torus(std::int64_t n) {
    SmallMesh mesh = torus(static_cast<std::uint32_t>(2 * n), static_cast<std::uint32_t>(n), 0.4);
    for (Vec3& p : mesh.positions) p.z += 0.02 * std::sin(8 * p.x) * std::cos(9 * p.y);
    return mesh;
}

void report(benchmark::State& state, const SmallMesh& mesh, const Decimated& result) {
    constexpr std::size_t samples = 50000;
    const MeshDistance distance =
        symmetric_distance(mesh.positions, mesh.faces, result.positions, result.faces, samples);
    state.counters["faces/s"] =
        benchmark::Counter(static_cast<double>(mesh.faces.size()), benchmark::Counter::kIsIterationInvariantRate);
    state.counters["faces"] = static_cast<double>(mesh.faces.size());
    // A collapse removes two faces and measures about 12 edges anew: two quadrics of 10, a 3 × 3 system, two errors.
    bench::report(state, static_cast<double>(mesh.faces.size()), 6 * (2 * 80 + 48 + 16), 6 * 120);
    state.counters["kept"] = static_cast<double>(result.faces.size());
    state.counters["rms"] = distance.rms;
}

/// To a fiftieth, in the arena as it is: wall time is what counts.
void decimate_to_fiftieth(benchmark::State& state) {
    const SmallMesh mesh = wavy_torus(state.range(0));
    DecimateOptions options;
    options.target_faces = mesh.faces.size() / 50;
    Decimated result;
    for (auto _ : state) result = decimate(mesh.positions, mesh.faces, options);
    report(state, mesh, result);
}
BENCHMARK(decimate_to_fiftieth)->Arg(57)->Arg(158)->Arg(500)->Unit(benchmark::kMillisecond)->UseRealTime();

void openmesh_to_fiftieth(benchmark::State& state) {
    const SmallMesh mesh = wavy_torus(state.range(0));
    Decimated result;
    for (auto _ : state) result = decimate_openmesh(mesh.positions, mesh.faces, mesh.faces.size() / 50);
    report(state, mesh, result);
}
BENCHMARK(openmesh_to_fiftieth)->Arg(57)->Arg(158)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
