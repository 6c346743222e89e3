// Fits from moments (a call) and of whole regions (a face).
#include "bench/micro/machine.h"
#include "bench/micro/shapes.h"
#include "quadric/face_packs.h"
#include "quadric/fit.h"
#include "quadric/ladder.h"
#include "quadric/moment_buffers.h"

#include <benchmark/benchmark.h>

namespace quadseg {
namespace {

/// `operations`: of the linear algebra, about.
template <class Fit>
void fit_moments(benchmark::State& state, const Fit& fit, double operations) {
    const bench::Patch patch = bench::ellipsoid_patch(288);
    const quadric::Moments about_corner = quadric::soup_moments(patch.soup(), patch.corners[0]);
    const quadric::Spread size = spread(about_corner);
    quadric::Moments local = scaled(shifted(about_corner, size.centroid), 1 / size.radius);
    for (auto _ : state) {
        benchmark::DoNotOptimize(local);
        benchmark::DoNotOptimize(fit(local));
    }
    bench::report(state, 1, sizeof(quadric::Moments), operations);
}

void fit_ladder_of_a_pair(benchmark::State& state) {
    const bench::Patch patch = bench::ellipsoid_patch(288);
    quadric::Moments m = quadric::soup_moments(patch.soup(), patch.corners[0]);
    for (auto _ : state) {
        benchmark::DoNotOptimize(m);
        benchmark::DoNotOptimize(quadric::fit_ladder(m, 0.5, state.range(0) != 0));
    }
    // Shift and scaling 290, plane and quadric with their energies; with the ladder three more models.
    bench::report(state, 1, sizeof(quadric::Moments), 290 + 1900 + (state.range(0) != 0 ? 1500 : 0));
}

void fit_whole_region(benchmark::State& state) {
    const bench::Patch patch = bench::ellipsoid_patch(static_cast<std::size_t>(state.range(0)));
    quadric::RegionFitOptions options;
    options.best_of = state.range(1) != 0;
    for (auto _ : state) benchmark::DoNotOptimize(fit_region(patch.soup(), options));
    // Moments once and again for each reweighted candidate, the energies of each candidate.
    const double candidates = options.best_of ? 5 : 3;
    bench::report(state, static_cast<double>(patch.areas.size()), (1 + 2 * candidates) * 13 * sizeof(double),
                  500 + candidates * (500 + 225) / 2);
    state.SetLabel(options.best_of ? "best of" : "two steps");
}

constexpr double weight = 0.5;
BENCHMARK_CAPTURE(
    fit_moments, plane, [](const quadric::Moments& m) { return fit_plane(m, weight); }, 300);
BENCHMARK_CAPTURE(
    fit_moments, taubin, [](const quadric::Moments& m) { return fit_taubin(m); }, 2500);
BENCHMARK_CAPTURE(
    fit_moments, least_squares, [](const quadric::Moments& m) { return fit_least_squares(m, weight); }, 1500);
BENCHMARK_CAPTURE(
    fit_moments, sphere, [](const quadric::Moments& m) { return fit_sphere_linear(m, weight); }, 400);
BENCHMARK_CAPTURE(
    fit_moments, cylinder, [](const quadric::Moments& m) { return fit_cylinder_linear(m, weight); }, 700);
BENCHMARK_CAPTURE(
    fit_moments, revolution, [](const quadric::Moments& m) { return fit_revolution_linear(m, weight); }, 900);
BENCHMARK(fit_ladder_of_a_pair)->Arg(0)->Arg(1);
BENCHMARK(fit_whole_region)->ArgsProduct({{32, 288, 3200, 100000}, {0, 1}});

}  // namespace
}  // namespace quadseg
