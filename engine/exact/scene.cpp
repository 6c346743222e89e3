#include "exact/scene.h"

#include "mesh/connected.h"
#include "runtime/parallel.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>

namespace quadseg::exact {

namespace {

/// Seed patches do not cross edges sharper than this; growing does, by its own scale.
constexpr double crease_degrees = 40;

std::vector<std::uint8_t> find_creases(const mesh::WorkMesh& mesh, double degrees) {
    std::vector<std::uint8_t> creases(mesh.face_count(), 0);
    const double sharp = std::cos(degrees * std::numbers::pi / 180);
    runtime::parallel_for(creases.size(), 16384, [&](std::size_t f) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::int32_t g = mesh.neighbors[f][k];
            const bool both = g >= 0 && mesh.areas[f] > 0 && mesh.areas[static_cast<std::size_t>(g)] > 0;
            if (g < 0 || (both && dot(mesh.normals[f], mesh.normals[static_cast<std::size_t>(g)]) < sharp)) {
                creases[f] = static_cast<std::uint8_t>(creases[f] | (1U << k));
            }
        }
    });
    return creases;
}

void find_charts(Scene& scene) {
    const mesh::WorkMesh& mesh = scene.mesh;
    scene.chart_count = mesh::connected_faces(
        mesh,
        [&](std::size_t f) { return !scene.facets.facet[static_cast<std::size_t>(scene.facets.of_face[f])].sure; },
        [&](std::size_t f, std::size_t k, std::size_t) { return !scene.is_crease(f, static_cast<int>(k)); },
        [&] { scene.control.check(); }, scene.chart);
}

void find_depths(Scene& scene) {
    const mesh::WorkMesh& mesh = scene.mesh;
    constexpr std::uint16_t unknown = 0xffff;
    scene.depth.assign(mesh.face_count(), unknown);
    constexpr std::size_t block = 16384;
    const auto find_edges = [&](std::size_t begin, std::size_t end, std::vector<std::uint32_t>& edges) {
        scene.control.check();
        for (std::size_t f = begin; f < end; ++f) {
            bool edge = scene.in_sure_plane(f) || scene.creases[f] != 0;
            for (std::size_t k = 0; !edge && k < 3; ++k) {
                edge = scene.in_sure_plane(static_cast<std::size_t>(mesh.neighbors[f][k]));
            }
            if (!edge) continue;
            scene.depth[f] = 0;
            if (!scene.in_sure_plane(f)) edges.push_back(static_cast<std::uint32_t>(f));
        }
    };
    // Ring by ring: who reaches a face first is chance, in which ring it lies is not.
    constexpr std::size_t grain = 2048;
    std::vector<std::uint32_t> ring = runtime::collect_blocks<std::uint32_t>(mesh.face_count(), block, find_edges);
    for (std::uint16_t d = 1; !ring.empty(); d = static_cast<std::uint16_t>(std::min<int>(d + 1, unknown - 1))) {
        scene.control.check();
        const auto reach = [&](std::size_t begin, std::size_t end, std::vector<std::uint32_t>& next) {
            for (std::size_t i = begin; i < end; ++i) {
                for (const std::int32_t neighbor : mesh.neighbors[ring[i]]) {
                    if (neighbor < 0) continue;
                    const auto g = static_cast<std::size_t>(neighbor);
                    const std::atomic_ref<std::uint16_t> depth(scene.depth[g]);
                    std::uint16_t before = depth.load(std::memory_order_relaxed);
                    if (before != unknown || !depth.compare_exchange_strong(before, d, std::memory_order_relaxed))
                        continue;
                    next.push_back(static_cast<std::uint32_t>(g));
                }
            }
        };
        ring = runtime::collect_blocks<std::uint32_t>(ring.size(), grain, reach);
    }
}

}  // namespace

double dihedral(const mesh::WorkMesh& mesh, std::size_t f, std::size_t g) {
    if (!(mesh.areas[f] > 0) || !(mesh.areas[g] > 0)) return 0;
    return angle_between(mesh.normals[f], mesh.normals[g]);
}

Scene with_creases(const Scene& scene, double degrees) {
    Scene other{scene.mesh,
                scene.control,
                scene.tolerances,
                scene.ground,
                scene.ground->facets,
                scene.ground->heights,
                {},
                {},
                0,
                {}};
    other.creases = find_creases(scene.mesh, degrees);
    scene.control.check();
    find_charts(other);
    scene.control.check();
    find_depths(other);
    return other;
}

Scene build_scene(const mesh::WorkMesh& mesh, const runtime::RunControl& control) {
    const auto ground = std::make_shared<Scene::Ground>();
    Scene scene{mesh, control, choose_tolerances(mesh), ground, ground->facets, ground->heights, {}, {}, 0, {}};
    control.check();
    ground->heights = face_heights(mesh);
    control.check();
    ground->facets = find_facets(mesh, scene.tolerances, scene.heights, control);
    control.check();
    scene.creases = find_creases(mesh, crease_degrees);
    control.check();
    find_charts(scene);
    control.check();
    find_depths(scene);
    return scene;
}

}  // namespace quadseg::exact
