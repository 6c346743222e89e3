// Energies: of one triangle, from moments, and over a region's packs.
#include "bench/micro/machine.h"
#include "bench/micro/shapes.h"
#include "quadric/energy.h"
#include "quadric/face_packs.h"
#include "quadric/fit.h"

#include <benchmark/benchmark.h>

namespace quadseg {
namespace {

/// f and ∇f at three corners (18 and 15 each), three middles 36, the two integrals 90.
constexpr double quadric_operations = 225;
constexpr double plane_operations = 70;  ///< the distances of three corners, one difference of normals
constexpr double face_bytes = 13 * sizeof(double);

void energy_of_a_triangle(benchmark::State& state) {
    const bench::Patch patch = bench::ellipsoid_patch(2000);
    quadric::Proxy proxy = fit_region(patch.soup(), {}).proxy;
    if (state.range(0) == 0) proxy = quadric::plane_proxy(patch.corners[0], patch.normals[0]);
    std::size_t t = 0;
    for (auto _ : state) {
        t = t + 1 < patch.areas.size() ? t + 1 : 0;
        benchmark::DoNotOptimize(triangle_energy(proxy, patch.corners[3 * t], patch.corners[3 * t + 1],
                                                 patch.corners[3 * t + 2], patch.normals[t], patch.areas[t]));
    }
    state.SetLabel(proxy.planar() ? "plane" : "quadric");
    bench::report(state, 1, face_bytes, proxy.planar() ? plane_operations : quadric_operations);
}

void energy_from_moments(benchmark::State& state) {
    const quadric::FacePacks faces(bench::ellipsoid_patch(200).soup());
    const quadric::Coefficients c = fit_taubin(faces.moments()).c;
    for (auto _ : state) benchmark::DoNotOptimize(moment_energy(c, faces.moments()));
    // Two forms over 10 × 10, and the second's assembly from 10 moments.
    bench::report(state, 1, sizeof(quadric::Moments), 2 * 210 + 90);
}

void energy_over_packs(benchmark::State& state) {
    const bench::Patch patch = bench::ellipsoid_patch(static_cast<std::size_t>(state.range(0)));
    quadric::FacePacks faces(patch.soup());
    quadric::Candidate candidate = faces.prepare(fit_taubin(faces.moments()).c);
    for (auto _ : state) {
        faces.evaluate(candidate);
        benchmark::DoNotOptimize(candidate);
    }
    bench::report(state, static_cast<double>(patch.areas.size()), face_bytes, quadric_operations);
}

BENCHMARK(energy_of_a_triangle)->Arg(0)->Arg(1);
BENCHMARK(energy_from_moments);
BENCHMARK(energy_over_packs)->Arg(128)->Arg(100000);

}  // namespace
}  // namespace quadseg
