// Exact foot points on general quadrics: the projection promises 2 million points a second on a core.
#include "bench/micro/machine.h"
#include "surface/quadric_projector.h"
#include "tests/surface/surface_samples.h"

#include <benchmark/benchmark.h>

namespace {

using namespace quadseg;
using namespace quadseg::surface;

// Ellipsoid, one and two sheets, both paraboloids, elliptic cone, elliptic cylinder, a general one.
constexpr quadric::Coefficients examples[] = {
    {-1, 0, 0, 0, 1, 0, 0, 2, 0, 3}, {-1, 0, 0, 0, 1, 0, 0, 2, 0, -1},           {1, 0, 0, 0, 1, 0, 0, 2, 0, -1},
    {0, 0, 0, -1, 1, 0, 0, 2, 0, 0}, {0, 0, 0, -1, 1, 0, 0, -2, 0, 0},           {0, 0, 0, 0, 1, 0, 0, 2, 0, -1},
    {-1, 0, 0, 0, 1, 0, 0, 2, 0, 0}, {-.3, .2, -.5, .1, 1, .3, -.2, .4, .6, -.7}};

/// share of the extent that points are off the surface: 1 for anywhere in space, 0.01 for a mesh's vertices.
void foot_point(benchmark::State& state) {
    const QuadricProjector projector(examples[state.range(0)]);
    const double share = state.range(1) == 0 ? 1 : 0.01;
    samples::Random random(1);
    std::vector<Vec3> points;
    for (int i = 0; i < 1000; ++i) {
        const Vec3 direction = random.direction();
        const Vec3 p = 2 * random.uniform(0, 1) * direction;
        points.push_back(share * p + (1 - share) * projector.foot_point(p));
    }
    for (auto _ : state)
        for (const Vec3& p : points) benchmark::DoNotOptimize(projector.foot_point(p));
    state.SetItemsProcessed(state.iterations() * 1000);
    // Into and out of the principal frame 45, f and ∇f 30, a Newton step 25 with three divisions, 3 to 8 of them.
    bench::report(state, 1000, 2 * sizeof(Vec3), 75 + 5 * 25);
}
BENCHMARK(foot_point)->ArgsProduct({{0, 1, 2, 3, 4, 5, 6, 7}, {0, 1}});

}  // namespace
