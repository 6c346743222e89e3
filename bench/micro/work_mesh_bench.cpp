// The working mesh: time, bytes read and written a face, one and two threads, faces as generated and shuffled.
#include "bench/micro/machine.h"
#include "mesh/features.h"
#include "mesh/work_mesh.h"
#include "runtime/parallel.h"

#include <benchmark/benchmark.h>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace {

using namespace quadseg;

struct Arrays {
    std::vector<double> positions;
    std::vector<std::uint32_t> triangles;
    MeshView view() const { return {positions, triangles}; }
    std::size_t faces() const { return triangles.size() / 3; }
};

std::uint64_t next_random(std::uint64_t& state) {
    std::uint64_t z = state += 0x9e3779b97f4a7c15ULL;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
}

/// A wavy grid of about `faces` faces, in rows or in random order of faces and vertices.
Arrays wavy_grid(std::size_t faces, bool shuffled) {
    const auto n = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(faces) / 2));
    Arrays a;
    std::vector<std::uint32_t> vertex((n + 1) * (n + 1));
    for (std::uint32_t i = 0; i < vertex.size(); ++i) vertex[i] = i;
    std::uint64_t state = 7;
    if (shuffled) {
        for (std::size_t i = vertex.size(); i > 1; --i) std::swap(vertex[i - 1], vertex[next_random(state) % i]);
    }
    a.positions.resize(3 * vertex.size());
    for (std::uint32_t j = 0, v = 0; j <= n; ++j) {
        for (std::uint32_t i = 0; i <= n; ++i, ++v) {
            double* p = &a.positions[3 * std::size_t{vertex[v]}];
            p[0] = i;
            p[1] = j;
            p[2] = std::sin(0.037 * i) * std::cos(0.021 * j) * 20;
        }
    }
    a.triangles.reserve(6 * std::size_t{n} * n);
    for (std::uint32_t j = 0; j < n; ++j) {
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t v = j * (n + 1) + i;
            for (const std::uint32_t c : {v, v + 1, v + n + 2, v, v + n + 2, v + n + 1})
                a.triangles.push_back(vertex[c]);
        }
    }
    if (shuffled) {
        for (std::size_t i = a.faces(); i > 1; --i) {
            const std::size_t j = next_random(state) % i;
            for (std::size_t k = 0; k < 3; ++k) std::swap(a.triangles[3 * (i - 1) + k], a.triangles[3 * j + k]);
        }
    }
    return a;
}

void per_face(benchmark::State& state, std::size_t faces, double bytes, double operations = 0) {
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(faces));
    bench::report(state, static_cast<double>(faces), bytes, operations);
}

/// Arguments: faces, threads, shuffled.
void build(benchmark::State& state) {
    const Arrays arrays = wavy_grid(static_cast<std::size_t>(state.range(0)), state.range(2) != 0);
    const runtime::RunControl control(nullptr);
    for (auto _ : state) {
        runtime::in_arena(static_cast<int>(state.range(1)),
                          [&] { benchmark::DoNotOptimize(mesh::build_work_mesh(arrays.view(), control)); });
    }
    // Input 12 + 12, keys 3 passes of 2 · 16 + 16, faces, neighbors and chains 3 · 12 twice, normal and area 32,
    // other 40. Centroid and its cell 24, normal and area 26, half a vertex into the unit frame 3.
    per_face(state, arrays.faces(), 24 + 112 + 72 + 32 + 40, 24 + 26 + 3);
}
BENCHMARK(build)
    ->ArgNames({"faces", "threads", "shuffled"})
    ->ArgsProduct({{10'000, 100'000, 1'000'000}, {1, 2}, {0, 1}})
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

void features(benchmark::State& state) {
    const Arrays arrays = wavy_grid(static_cast<std::size_t>(state.range(0)), false);
    const runtime::RunControl control(nullptr);
    const mesh::WorkMesh work = mesh::build_work_mesh(arrays.view(), control);
    for (auto _ : state) {
        runtime::in_arena(static_cast<int>(state.range(1)), [&] {
            benchmark::DoNotOptimize(mesh::find_feature_edges(work, static_cast<double>(state.range(2)), control));
        });
    }
    per_face(state, work.face_count(), 24 + 12 + 3, 1.5 * 6);  // a product of normals an edge
}
/// 3 degrees: a good part of the edges is sharp and tested.
BENCHMARK(features)
    ->ArgNames({"faces", "threads", "degrees"})
    ->ArgsProduct({{100'000, 1'000'000}, {1, 2}, {3, 30}})
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);

void vertex_fans(benchmark::State& state) {
    const Arrays arrays = wavy_grid(static_cast<std::size_t>(state.range(0)), false);
    const mesh::WorkMesh work = mesh::build_work_mesh(arrays.view(), runtime::RunControl(nullptr));
    for (auto _ : state) benchmark::DoNotOptimize(mesh::vertex_faces(work));
    per_face(state, work.face_count(), 12 + 12 + 12 + 4);
}
BENCHMARK(vertex_fans)->Arg(100'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

}  // namespace
