// Moments: one by one, on packs, streamed from the precomputed buffers; shifting and scaling. Time a face or a call.
#include "bench/micro/machine.h"
#include "bench/micro/shapes.h"
#include "quadric/moment_buffers.h"
#include "quadric/moments.h"

#include <benchmark/benchmark.h>
#include <cstdint>

namespace quadseg {
namespace {

/// Corners, normal and area of a face.
constexpr double face_bytes = 13 * sizeof(double);
/// triangle_moments(): centroid 9, power sums 105, degrees 2 to 4 from them 60, three shifts of 35 multiply-adds 210.
constexpr double triangle_operations = 384;
/// Adding them with two weights: 35 and 12 multiply-adds, the six products of the normal.
constexpr double sum_operations = 70 + 27 + 20;
constexpr double shift_operations = 210 + 18;

void per_face(benchmark::State& state, std::size_t faces, double bytes, double operations) {
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(faces));
    bench::report(state, static_cast<double>(faces), bytes, operations);
}

void moments_one_by_one(benchmark::State& state) {
    const bench::Patch patch = bench::ellipsoid_patch(static_cast<std::size_t>(state.range(0)));
    for (auto _ : state) {
        quadric::Moments m;
        for (std::size_t t = 0; t < patch.areas.size(); ++t) {
            accumulate(m, patch.corners[3 * t], patch.corners[3 * t + 1], patch.corners[3 * t + 2], patch.normals[t],
                       patch.areas[t]);
        }
        benchmark::DoNotOptimize(m);
    }
    per_face(state, patch.areas.size(), face_bytes, triangle_operations + sum_operations);
}

void moments_on_packs(benchmark::State& state) {
    const bench::Patch patch = bench::ellipsoid_patch(static_cast<std::size_t>(state.range(0)));
    for (auto _ : state) benchmark::DoNotOptimize(quadric::soup_moments(patch.soup(), patch.corners[0]));
    per_face(state, patch.areas.size(), face_bytes, triangle_operations + sum_operations);
}

quadric::MomentBuffers buffers_of(const bench::Patch& patch, std::size_t block) {
    std::vector<std::uint32_t> begin;
    for (std::size_t t = 0; t < patch.areas.size(); t += block) begin.push_back(static_cast<std::uint32_t>(t));
    begin.push_back(static_cast<std::uint32_t>(patch.areas.size()));
    return quadric::MomentBuffers(begin);
}

void fill(quadric::MomentBuffers& buffers, const bench::Patch& patch, std::size_t block) {
    const quadric::TriangleSoup all = patch.soup();
    for (std::size_t b = 0; b < buffers.block_count(); ++b) {
        const std::size_t first = b * block, count = buffers.block_size(b);
        buffers.fill(b, {all.corners.subspan(3 * first, 3 * count), all.normals.subspan(first, count),
                         all.areas.subspan(first, count)});
    }
}

void moments_precompute_buffers(benchmark::State& state) {
    const bench::Patch patch = bench::ellipsoid_patch(static_cast<std::size_t>(state.range(0)));
    quadric::MomentBuffers buffers = buffers_of(patch, 128);
    for (auto _ : state) fill(buffers, patch, 128);
    const double bytes = static_cast<double>(buffers.bytes()) / static_cast<double>(patch.areas.size());
    per_face(state, patch.areas.size(), face_bytes + bytes, triangle_operations);
}

void moments_streamed_from_buffers(benchmark::State& state) {
    const bench::Patch patch = bench::ellipsoid_patch(static_cast<std::size_t>(state.range(0)));
    quadric::MomentBuffers buffers = buffers_of(patch, 128);
    fill(buffers, patch, 128);
    const std::vector<double> weights(128, 1.5);
    for (auto _ : state) {
        quadric::Moments m;
        for (std::size_t b = 0; b < buffers.block_count(); ++b) {
            const std::span<const double> w(weights.data(), buffers.block_size(b));
            buffers.accumulate(m, patch.corners[0], b, 0, w, w);
        }
        benchmark::DoNotOptimize(m);
    }
    const double bytes = static_cast<double>(buffers.bytes()) / static_cast<double>(patch.areas.size());
    per_face(state, patch.areas.size(), bytes, sum_operations);
}

quadric::Moments some_moments() {
    const bench::Patch patch = bench::ellipsoid_patch(200);
    return quadric::soup_moments(patch.soup(), patch.corners[0]);
}

void moments_shifted(benchmark::State& state) {
    quadric::Moments m = some_moments();
    for (auto _ : state) {
        benchmark::DoNotOptimize(m);
        benchmark::DoNotOptimize(shifted(m, {0.1, 0.2, 0.3}));
    }
    bench::report(state, 1, 2 * sizeof(quadric::Moments), shift_operations);
}

void moments_scaled(benchmark::State& state) {
    quadric::Moments m = some_moments();
    for (auto _ : state) {
        benchmark::DoNotOptimize(m);
        benchmark::DoNotOptimize(scaled(m, 3));
    }
    bench::report(state, 1, 2 * sizeof(quadric::Moments), 60);
}

BENCHMARK(moments_one_by_one)->Arg(128)->Arg(100000);
BENCHMARK(moments_on_packs)->Arg(128)->Arg(100000);
BENCHMARK(moments_precompute_buffers)->Arg(4096)->Arg(100000);
BENCHMARK(moments_streamed_from_buffers)->Arg(4096)->Arg(100000);
BENCHMARK(moments_shifted);
BENCHMARK(moments_scaled);

}  // namespace
}  // namespace quadseg
