// Flood, face metric and the whole Lloyd step on a wavy sheet: nanoseconds a face.
#include "bench/micro/machine.h"
#include "flow/paper_loop.h"
#include "partition/flood.h"
#include "partition/insert.h"

#include <benchmark/benchmark.h>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

namespace {

using namespace quadseg;

mesh::WorkMesh wavy_sheet(std::uint32_t n) {
    std::vector<double> positions;
    std::vector<std::uint32_t> triangles;
    for (std::uint32_t j = 0; j <= n; ++j) {
        for (std::uint32_t i = 0; i <= n; ++i) {
            const double x = static_cast<double>(i) / n, y = static_cast<double>(j) / n;
            positions.insert(positions.end(), {x, y, 0.05 * std::sin(12 * x) * std::cos(9 * y)});
        }
    }
    for (std::uint32_t j = 0; j < n; ++j) {
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t a = j * (n + 1) + i, b = a + 1, c = b + n, d = c + 1;
            triangles.insert(triangles.end(), {a, b, d, a, d, c});
        }
    }
    return mesh::build_work_mesh({positions, triangles}, runtime::RunControl(nullptr));
}

/// Corners through indices, normal, area.
constexpr double face_bytes = 12 + 72 + 24 + 8;
/// f and ∇f at three corners (18 and 15 each), the two integrals 90.
constexpr double energy_operations = 190;
/// A face is met by about one proxy that enters the queue: neighbours, offer, entry pushed and popped, label, density.
constexpr double queue_bytes = 12 + 16 + 16 + 4 + 8;

void per_face(benchmark::State& state, std::size_t faces, double bytes, double operations) {
    bench::report(state, static_cast<double>(faces), bytes, operations);
}

/// Arguments: squares a side, regions.
void flood(benchmark::State& state) {
    const mesh::WorkMesh mesh = wavy_sheet(static_cast<std::uint32_t>(state.range(0)));
    const partition::Labels one(mesh.face_count(), 0);
    const auto seeds = partition::random_seeds(mesh, one, 1, static_cast<std::size_t>(state.range(1)), 1);
    std::vector<quadric::Proxy> proxies;
    for (const std::uint32_t s : seeds) proxies.push_back(quadric::plane_proxy(mesh.centroid(s), mesh.normals[s]));
    std::vector<partition::SeededRegion> regions;
    for (std::size_t i = 0; i < seeds.size(); ++i) {
        regions.push_back({static_cast<std::int32_t>(i), seeds[i], &proxies[i]});
    }
    std::vector<std::uint32_t> faces(mesh.face_count());
    std::iota(faces.begin(), faces.end(), 0U);
    partition::Flood flood({&mesh, nullptr, {}});
    const runtime::RunControl control(nullptr);
    std::vector<double> density(mesh.face_count(), 0);
    partition::Labels labels;
    for (auto _ : state) {
        labels.assign(mesh.face_count(), -1);
        flood.run(regions, faces, {}, labels, density, control);
        benchmark::DoNotOptimize(labels.data());
    }
    per_face(state, mesh.face_count(), face_bytes + queue_bytes, energy_operations);
}
BENCHMARK(flood)->Args({80, 22})->Args({230, 300})->Unit(benchmark::kMillisecond);

void error_density(benchmark::State& state) {
    const mesh::WorkMesh mesh = wavy_sheet(static_cast<std::uint32_t>(state.range(0)));
    quadric::Proxy proxy;
    proxy.c = {0.01, 0.02, 0.03, 1, 0.3, -0.2, 0.1, 0.4, 0.2, -0.1};
    for (auto _ : state) {
        double sum = 0;
        for (std::size_t f = 0; f < mesh.face_count(); ++f) sum += partition::error_density(mesh, f, proxy, {});
        benchmark::DoNotOptimize(sum);
    }
    per_face(state, mesh.face_count(), face_bytes, energy_operations);
}
BENCHMARK(error_density)->Arg(80)->Arg(230)->Unit(benchmark::kMillisecond);

/// Flood, fits of all changed regions, seeds: one iteration from random seeds each time.
void lloyd_step(benchmark::State& state) {
    const mesh::WorkMesh mesh = wavy_sheet(static_cast<std::uint32_t>(state.range(0)));
    Options options;
    options.preset = Preset::paper;
    const runtime::RunControl control(nullptr);
    flow::VariationalLoop loop({mesh, nullptr, options, control});
    loop.start_from_seeds(static_cast<std::size_t>(state.range(1)));
    const flow::LoopState start = loop.state();
    for (auto _ : state) {
        state.PauseTiming();
        loop.restore(start);
        state.ResumeTiming();
        loop.lloyd(1, flow::FloodScope::all, false);
    }
    // Flood, then the paper's two fits: three passes of moments and energies each.
    per_face(state, mesh.face_count(), 4 * face_bytes + queue_bytes, energy_operations + 3 * (500 + 225));
}
BENCHMARK(lloyd_step)->Args({80, 22})->Args({230, 300})->Unit(benchmark::kMillisecond);

}  // namespace
