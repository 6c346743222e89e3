// One small fixed workload a kernel, for callgrind: `quadseg_instructions NAME` runs kernel_NAME() once after preparing
// its input; without a name it lists them. Instructions of kernel_NAME() alone are counted (instruction_gate).
#include "bench/micro/shapes.h"
#include "datasets/generate.h"
#include "flow/fast.h"
#include "mesh/work_mesh.h"
#include "partition/flood.h"
#include "partition/leaves.h"
#include "partition/pair_merge.h"
#include "partition/relax.h"
#include "quadric/face_packs.h"
#include "quadric/fit.h"
#include "quadric/ladder.h"
#include "quadric/moment_buffers.h"
#include "runtime/parallel.h"
#include "simplify/decimate.h"
#include "surface/quadric_projector.h"

#include <cstdio>
#include <functional>
#include <memory>
#include <numeric>
#include <string_view>
#include <vector>

namespace {

using namespace quadseg;

const runtime::RunControl control(nullptr);
constexpr double weight = 0.5;
constexpr std::size_t plate_faces = 4000;

/// What the kernels work on, prepared outside the counting.
struct Input {
    Mesh plate = datasets::generate("plate", plate_faces).mesh;
    mesh::WorkMesh mesh = mesh::build_work_mesh(plate.view(), control);
    partition::Passage passage{&mesh};
    partition::Leaves leaves = partition::grow_leaves(passage, {}, control);
    bench::Patch patch = bench::ellipsoid_patch(2000);
    quadric::FacePacks packs{patch.soup()};
    quadric::QuadricFit fit = fit_taubin(packs.moments());
    quadric::Moments local;
    std::vector<partition::MergeRegion> regions;
    std::vector<partition::RegionPair> pairs;
    flow::FlowResult merged;
    std::vector<quadric::Proxy> proxies;
    std::vector<partition::SeededRegion> seeds;
    std::vector<std::uint32_t> faces;

    Input() {
        const quadric::Moments about = quadric::soup_moments(patch.soup(), patch.corners[0]);
        const quadric::Spread size = spread(about);
        local = scaled(shifted(about, size.centroid), 1 / size.radius);
        regions = partition::measure_regions(mesh, leaves.labels, leaves.count, scorer, control);
        pairs = partition::region_pairs(passage, leaves.labels, control);
        const Options options;
        flow::FastOptions fast = flow::fast_options(options);
        fast.moment_steps = fast.relax_steps = 0;
        merged = flow::run_fast({mesh, nullptr, options, control}, fast);
        faces.resize(mesh.face_count());
        std::iota(faces.begin(), faces.end(), 0U);
        constexpr std::size_t count = 30;
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t f = i * faces.size() / count;
            proxies.push_back(quadric::plane_proxy(mesh.centroid(f), mesh.normals[f]));
        }
        for (std::size_t i = 0; i < count; ++i) {
            seeds.push_back(
                {static_cast<std::int32_t>(i), static_cast<std::uint32_t>(i * faces.size() / count), &proxies[i]});
        }
    }
    static partition::RegionScore scorer(const quadric::Moments& m) {
        const quadric::LadderFit ladder = quadric::fit_ladder(m, weight, true);
        return {ladder.cost, ladder.energy, ladder.dof, 0};
    }
};

double kept = 0;  ///< results go here, so that nothing is optimised away
const Input* input = nullptr;

}  // namespace

// Names that callgrind's --toggle-collect finds; noinline keeps each one function.
#define QUADSEG_KERNEL(name) extern "C" __attribute__((noinline, used)) void kernel_##name()

QUADSEG_KERNEL(moments) {
    quadric::Moments m;
    const bench::Patch& p = input->patch;
    for (std::size_t t = 0; t < p.areas.size(); ++t) {
        accumulate(m, p.corners[3 * t], p.corners[3 * t + 1], p.corners[3 * t + 2], p.normals[t], p.areas[t]);
    }
    kept += m.area[34];
}
QUADSEG_KERNEL(moments_packs) {
    kept += quadric::soup_moments(input->patch.soup(), input->patch.corners[0]).area[34];
}
QUADSEG_KERNEL(energy) {
    const bench::Patch& p = input->patch;
    quadric::Proxy proxy;
    proxy.c = input->fit.c;
    for (std::size_t t = 0; t < p.areas.size(); ++t) {
        kept += triangle_energy(proxy, p.corners[3 * t], p.corners[3 * t + 1], p.corners[3 * t + 2], p.normals[t],
                                p.areas[t])
                    .normal;
    }
}
QUADSEG_KERNEL(energy_packs) {
    quadric::FacePacks packs(input->patch.soup());
    quadric::Candidate candidate = packs.prepare(input->fit.c);
    packs.evaluate(candidate);
    kept += candidate.c[0];
}
QUADSEG_KERNEL(fits) {
    for (int i = 0; i < 20; ++i) {
        kept += fit_plane(input->local, weight).energy + fit_taubin(input->local).energy +
                fit_least_squares(input->local, weight).energy;
    }
}
QUADSEG_KERNEL(ladder) {
    for (int i = 0; i < 20; ++i) kept += quadric::fit_ladder(input->local, weight, true).cost;
}
QUADSEG_KERNEL(fit_region) {
    kept += fit_region(input->patch.soup(), {}).total;
}
QUADSEG_KERNEL(work_mesh) {
    kept += mesh::build_work_mesh(input->plate.view(), control).total_area;
}
QUADSEG_KERNEL(leaves) {
    kept += static_cast<double>(partition::grow_leaves(input->passage, {}, control).count);
}
QUADSEG_KERNEL(merge) {
    partition::MergeRules rules;
    rules.misfit = weight * 0.006;
    kept += static_cast<double>(
        partition::merge_pairs(input->regions, input->pairs, rules, Input::scorer, control).regions.size());
}
QUADSEG_KERNEL(relax) {
    const auto regions =
        partition::measure_regions(input->mesh, input->merged.labels, input->merged.regions, Input::scorer, control);
    partition::RelaxOptions options;
    options.moment_steps = 2;
    options.steps = 2;
    partition::Labels labels = input->merged.labels;
    kept += partition::relax(input->passage, labels, regions, options, control).energy;
}
QUADSEG_KERNEL(flood) {
    partition::Flood flood(input->passage);
    partition::Labels labels(input->faces.size(), -1);
    std::vector<double> density(input->faces.size(), 0);
    flood.run(input->seeds, input->faces, {}, labels, density, control);
    kept += labels.back();
}
QUADSEG_KERNEL(decimate) {
    simplify::DecimateOptions options;
    options.target_faces = plate_faces / 10;
    kept += simplify::decimate(input->mesh.positions, input->mesh.faces, options).max_error;
}
QUADSEG_KERNEL(foot_point) {
    const surface::QuadricProjector projector({-1, 0.1, 0, 0, 1, 0.2, 0, 2, 0, -1});
    for (const Vec3& p : input->patch.corners) kept += projector.foot_point(p).x;
}

int main(int argc, char** argv) {
    const std::pair<std::string_view, void (*)()> kernels[] = {{"moments", kernel_moments},
                                                               {"moments_packs", kernel_moments_packs},
                                                               {"energy", kernel_energy},
                                                               {"energy_packs", kernel_energy_packs},
                                                               {"fits", kernel_fits},
                                                               {"ladder", kernel_ladder},
                                                               {"fit_region", kernel_fit_region},
                                                               {"work_mesh", kernel_work_mesh},
                                                               {"leaves", kernel_leaves},
                                                               {"merge", kernel_merge},
                                                               {"relax", kernel_relax},
                                                               {"flood", kernel_flood},
                                                               {"decimate", kernel_decimate},
                                                               {"foot_point", kernel_foot_point}};
    if (argc < 2) {
        for (const auto& [name, kernel] : kernels) std::printf("%.*s\n", static_cast<int>(name.size()), name.data());
        return 0;
    }
    bool known = false;
    runtime::in_arena(1, [&] {
        const Input prepared;
        input = &prepared;
        for (const auto& [name, kernel] : kernels) {
            if (name != argv[1]) continue;
            known = true;
            kernel();
        }
    });
    return known && kept == kept ? 0 : 1;
}
