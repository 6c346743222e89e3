// Typed fits on 40 tessellation vertices with normals of a jet's quality, and the distances the exact stage asks for.
#include <quadseg/segmentation.h>

#include "bench/micro/machine.h"
#include "surface/evaluate.h"
#include "surface/fit.h"
#include "surface/jets.h"
#include "tests/surface/surface_samples.h"

#include <benchmark/benchmark.h>

namespace {

using namespace quadseg;
using namespace quadseg::surface;
using namespace quadseg::surface::samples;

Surface example(SurfaceType type) {
    const Vec3 axis = normalized(Vec3{.3, -.5, .8}), place{.2, -.1, .4};
    switch (type) {
        case SurfaceType::plane:
            return plane(place, axis);
        case SurfaceType::sphere:
            return sphere(place, .7);
        case SurfaceType::cylinder:
            return cylinder(place, axis, .4);
        case SurfaceType::cone:
            return cone(place, axis, .5);
        default:
            return torus(place, axis, .8, .25);
    }
}

/// So many steps of Levenberg-Marquardt on `points`: distance and derivatives, their products, an evaluation.
double step_operations(SurfaceType type, std::size_t points, int steps) {
    const int k = degrees_of_freedom(type);
    return static_cast<double>(points) * steps * (40 + 10 * k + k * (k + 1));
}
constexpr int usual_steps = 8, steps_of_a_rejection = 5;

void fit_40_points(benchmark::State& state) {
    const Surface s = example(SurfaceType(state.range(0)));
    const Patch patch = grid(s, {0, 1.5, 8}, {.2, 1.2, 5}, .05);
    for (auto _ : state) benchmark::DoNotOptimize(fit(s.type, {patch.points, patch.normals, {}}));
    bench::report(state, 1, static_cast<double>(patch.points.size()) * 2 * sizeof(Vec3),
                  step_operations(s.type, patch.points.size(), usual_steps));
}
BENCHMARK(fit_40_points)->DenseRange(0, 4)->Unit(benchmark::kMicrosecond);

/// Points of a torus offered to every type: what rejecting costs.
void reject_40_points(benchmark::State& state) {
    const Patch patch = grid(example(SurfaceType::torus), {0, 1.5, 8}, {.2, 1.2, 5}, .05);
    FitOptions options;
    options.hopeless = 1e-6;
    const auto type = SurfaceType(state.range(0));
    for (auto _ : state) benchmark::DoNotOptimize(fit(type, {patch.points, patch.normals, {}}, options));
    bench::report(state, 1, static_cast<double>(patch.points.size()) * 2 * sizeof(Vec3),
                  step_operations(type, patch.points.size(), steps_of_a_rejection));
}
BENCHMARK(reject_40_points)->DenseRange(0, 3)->Unit(benchmark::kMicrosecond);

void distance(benchmark::State& state) {
    const Surface s = example(SurfaceType(state.range(0)));
    const SurfaceEvaluator e(s);
    Random random(1);
    std::vector<Vec3> points;
    for (int i = 0; i < 1000; ++i) points.push_back(random.direction());
    for (auto _ : state) {
        double worst = 0;
        for (const Vec3& p : points) worst = std::max(worst, std::abs(e.distance(p)));
        benchmark::DoNotOptimize(worst);
    }
    state.SetItemsProcessed(state.iterations() * 1000);
    bench::report(state, 1000, sizeof(Vec3), 15);
}
BENCHMARK(distance)->DenseRange(0, 4);

void normal(benchmark::State& state) {
    const Surface s = example(SurfaceType(state.range(0)));
    const SurfaceEvaluator e(s);
    Random random(1);
    std::vector<Vec3> points;
    for (int i = 0; i < 1000; ++i) points.push_back(random.direction());
    for (auto _ : state) {
        double sum = 0;
        for (const Vec3& p : points) sum += e.normal(p).x;
        benchmark::DoNotOptimize(sum);
    }
    state.SetItemsProcessed(state.iterations() * 1000);
    bench::report(state, 1000, sizeof(Vec3), 25);
}
BENCHMARK(normal)->DenseRange(0, 4);

void jet_of_30_points(benchmark::State& state) {
    const Patch patch = grid(example(SurfaceType::torus), {0, .5, 6}, {.2, .7, 5});
    for (auto _ : state) benchmark::DoNotOptimize(patch_normals(patch.points, patch.normals[12]));
    // Normal equations of ten monomials, one factorisation.
    const auto points = static_cast<double>(patch.points.size());
    bench::report(state, 1, points * sizeof(Vec3), points * (20 + 10 * 11 + 2 * 10) + 10 * 10 * 10 / 3.0);
}
BENCHMARK(jet_of_30_points)->Unit(benchmark::kMicrosecond);

}  // namespace
