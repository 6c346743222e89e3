// Boundary smoothing: the whole of it on a mesh of many regions, and its cuts by the two maximum-flow algorithms of
// Boost on the same bands.
#include "bench/micro/machine.h"
#include "datasets/generate.h"
#include "mesh/work_mesh.h"
#include "partition/flow_network.h"
#include "partition/leaves.h"
#include "partition/smooth.h"
#include "runtime/run_control.h"

#include <benchmark/benchmark.h>
#include <boost/graph/push_relabel_max_flow.hpp>
#include <cmath>

namespace {

using namespace quadseg;

const runtime::RunControl free_run(nullptr);

struct Scene {
    mesh::WorkMesh mesh;
    partition::Labels labels;
    std::size_t count = 0;
};

/// A part in leaves of at most `largest` faces: many short, jagged borders.
Scene make_scene(std::size_t faces, std::size_t largest) {
    const datasets::Generated part = datasets::generate("plate", faces);
    Scene scene{mesh::build_work_mesh(part.mesh.view(), free_run), {}, 0};
    partition::LeafOptions options;
    options.angle = 25;
    options.largest = largest;
    options.smallest_coplanar = 0;
    partition::Leaves leaves = partition::grow_leaves({&scene.mesh}, options, free_run);
    scene.labels = std::move(leaves.labels);
    scene.count = leaves.count;
    return scene;
}

/// Some distance that tells regions apart, as cheap as a plane's.
partition::FaceDistance distance_to_planes(const Scene& scene) {
    std::vector<Vec3> normal(scene.count), point(scene.count);
    for (std::size_t f = 0; f < scene.labels.size(); ++f) {
        const auto r = static_cast<std::size_t>(scene.labels[f]);
        normal[r] = scene.mesh.normals[f];
        point[r] = scene.mesh.centroid(f);
    }
    return [&scene, normal, point](std::uint32_t f, std::int32_t r) {
        const auto region = static_cast<std::size_t>(r);
        return std::abs(dot(scene.mesh.centroid(f) - point[region], normal[region]));
    };
}

void smooth_100k_faces(benchmark::State& state) {
    const Scene scene = make_scene(100000, static_cast<std::size_t>(state.range(0)));
    const partition::FaceDistance distance = distance_to_planes(scene);
    partition::SmoothRules rules;
    rules.band = static_cast<int>(state.range(1));
    for (auto _ : state) {
        partition::Labels labels = scene.labels;
        benchmark::DoNotOptimize(
            partition::smooth_borders({&scene.mesh}, labels, scene.count, distance, rules, free_run));
    }
    state.counters["regions"] = static_cast<double>(scene.count);
    // A face: label read and written, neighbours, corners; two distances to planes and the lengths of its edges.
    bench::report(state, static_cast<double>(scene.mesh.face_count()), 2 * 4 + 12 + 12 + 3 * sizeof(Vec3),
                  2 * 12 + 3 * 9);
}
BENCHMARK(smooth_100k_faces)->Args({128, 2})->Args({1000, 2})->Args({1000, 5})->Unit(benchmark::kMillisecond);

std::vector<partition::BandGraph> band_graphs(const Scene& scene, int width) {
    const partition::FaceDistance distance = distance_to_planes(scene);
    const partition::BorderBands bands = partition::find_border_bands({&scene.mesh}, scene.labels, width, free_run);
    partition::SmoothRules rules;
    rules.band = width;
    std::vector<std::int32_t> local(scene.labels.size(), -1);
    const double edge = partition::mean_edge_length(scene.mesh);
    const double area = scene.mesh.total_area / static_cast<double>(scene.mesh.face_count());
    std::vector<partition::BandGraph> graphs;
    for (std::size_t i = 0; i < bands.pairs.size(); ++i) {
        graphs.push_back(
            partition::band_graph({&scene.mesh}, scene.labels, bands, i, distance, rules, edge, area, local));
    }
    return graphs;
}

/// A node of the dual graph: label, and three arcs with their reverses of target, capacity, residue and reverse index;
/// a comparison and a subtraction an arc, once.
void report_cut(benchmark::State& state, const std::vector<partition::BandGraph>& graphs) {
    std::size_t nodes = 0;
    for (const auto& g : graphs) nodes += g.nodes.size();
    state.counters["bands"] = static_cast<double>(graphs.size());
    state.counters["nodes"] = static_cast<double>(nodes);
    bench::report(state, static_cast<double>(nodes), 4 + 6 * (4 + 8 + 8 + 8), 6 * 2);
}

void cut_boykov_kolmogorov(benchmark::State& state) {
    const Scene scene = make_scene(100000, static_cast<std::size_t>(state.range(0)));
    const auto graphs = band_graphs(scene, static_cast<int>(state.range(1)));
    for (auto _ : state) {
        for (const auto& g : graphs) benchmark::DoNotOptimize(partition::minimum_cut(g.graph));
    }
    report_cut(state, graphs);
}
BENCHMARK(cut_boykov_kolmogorov)->Args({128, 2})->Args({1000, 2})->Args({1000, 5})->Unit(benchmark::kMillisecond);

void cut_push_relabel(benchmark::State& state) {
    const Scene scene = make_scene(100000, static_cast<std::size_t>(state.range(0)));
    const auto graphs = band_graphs(scene, static_cast<int>(state.range(1)));
    for (auto _ : state) {
        for (const auto& g : graphs) {
            if (g.nodes.empty()) continue;
            partition::FlowNetwork network(g.graph);
            benchmark::DoNotOptimize(boost::push_relabel_max_flow(
                network.graph, network.source(), network.sink(), network.capacity_map(), network.residual_map(),
                network.reverse_map(), boost::get(boost::vertex_index, network.graph)));
        }
    }
    report_cut(state, graphs);
}
BENCHMARK(cut_push_relabel)->Args({128, 2})->Args({1000, 2})->Args({1000, 5})->Unit(benchmark::kMillisecond);

/// What both share: Boost's form of the graph.
void build_networks(benchmark::State& state) {
    const Scene scene = make_scene(100000, static_cast<std::size_t>(state.range(0)));
    const auto graphs = band_graphs(scene, static_cast<int>(state.range(1)));
    for (auto _ : state) {
        for (const auto& g : graphs) benchmark::DoNotOptimize(partition::FlowNetwork(g.graph).source());
    }
    report_cut(state, graphs);
}
BENCHMARK(build_networks)->Args({128, 2})->Args({1000, 2})->Args({1000, 5})->Unit(benchmark::kMillisecond);

}  // namespace
