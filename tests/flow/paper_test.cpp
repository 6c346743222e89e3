#include "flow/paper.h"

#include "flow/methods.h"
#include "loop_support.h"

#include <chrono>
#include <gtest/gtest.h>
#include <map>
#include <numeric>

namespace quadseg::test {
namespace {

/// Regions and faces are one to one with the values of `surface_of(face)`.
template <class SurfaceOf>
void expect_surfaces(const PaperRun& run, const SurfaceOf& surface_of) {
    std::map<std::int32_t, int> surface;
    for (std::size_t f = 0; f < run.mesh.face_count(); ++f) {
        const int s = surface_of(f);
        const auto [entry, fresh] = surface.emplace(run.result.labels[f], s);
        EXPECT_EQ(entry->second, s) << "face " << f;
    }
}

int side_of(const Vec3& n) {
    const double x[3]{n.x, n.y, n.z};
    int side = 0;
    for (int i = 0; i < 3; ++i) {
        if (std::abs(x[i]) > 0.5) side = 2 * i + (x[i] > 0 ? 1 : 0);
    }
    return side;
}

/// Positions x → 3·R·x + t (which changes the bounding box, hence the unit, by up to 1 %), faces in another order, each
/// begun at another corner.
Shape moved_and_shuffled(const Shape& s, std::uint64_t seed) {
    Shape r;
    const double c = std::cos(0.7), d = std::sin(0.7);
    for (std::size_t v = 0; v < s.positions.size(); v += 3) {
        const double x = s.positions[v], y = s.positions[v + 1], z = s.positions[v + 2];
        r.vertex(3 * (c * x - d * y) + 10, 3 * (d * x + c * y) - 4, 3 * z + 1);
    }
    for (const std::uint32_t f : random_permutation(s.faces(), seed)) {
        const std::uint32_t* v = &s.triangles[3 * f];
        const std::uint32_t k = f % 3;
        r.face(v[k], v[(k + 1) % 3], v[(k + 2) % 3]);
    }
    return r;
}

TEST(Paper, CubeHasSixRegions) {
    for (const std::uint32_t n : {1U, 5U}) {
        const PaperRun run = run_paper(box(n), paper_options());
        expect_valid(run);
        EXPECT_EQ(run.result.regions, 6U);
        EXPECT_EQ(run.result.stop, StopReason::tolerance);
        expect_surfaces(run, [&](std::size_t f) { return side_of(run.mesh.normals[f]); });
    }
}

TEST(Paper, OpenCubeHasFive) {
    const PaperRun run = run_paper(open_box(5), paper_options());
    expect_valid(run);
    EXPECT_EQ(run.result.regions, 5U);
    expect_surfaces(run, [&](std::size_t f) { return side_of(run.mesh.normals[f]); });
}

TEST(Paper, DomeAndPlateAreTold) {
    const PaperRun run = run_paper(dome_on_plate(48, 12), paper_options(2));
    expect_valid(run);
    EXPECT_EQ(run.result.regions, 2U);
    EXPECT_EQ(run.result.stop, StopReason::regions);
    expect_surfaces(run, [&](std::size_t f) { return run.mesh.frame.to_input(run.mesh.centroid(f)).z > 1e-3 ? 1 : 0; });
}

TEST(Paper, PartitionMovesAlongWithTheMesh) {
    const Shape original = dome_on_plate(32, 8);
    const PaperRun a = run_paper(original, paper_options(2));
    for (const std::uint64_t seed : {1ULL, 2ULL}) {
        const Shape moved = moved_and_shuffled(original, seed);
        const PaperRun b = run_paper(moved, paper_options(2));
        EXPECT_EQ(b.result.regions, a.result.regions);
        EXPECT_NEAR(b.energy(paper_options()), a.energy(paper_options()), 0.02 * a.energy(paper_options()));
        const auto labels_a = mesh::labels_to_input(a.mesh, a.result.labels);
        const auto labels_b = mesh::labels_to_input(b.mesh, b.result.labels);
        const auto permutation = random_permutation(original.faces(), seed);
        std::vector<std::int32_t> labels_b_of_a(labels_b.size());
        for (std::size_t i = 0; i < permutation.size(); ++i) labels_b_of_a[permutation[i]] = labels_b[i];
        EXPECT_GT(agreement(labels_a, labels_b_of_a), 0.99);
    }
}

TEST(Paper, KeptStatesNeverGetWorse) {
    const mesh::WorkMesh mesh = work_mesh(bumpy_grid(30));
    const Options options = paper_options();
    const runtime::RunControl control(nullptr);
    flow::VariationalLoop loop({mesh, nullptr, options, control});
    loop.start_from_seeds(12);
    double energy = loop.state().energy;
    for (int i = 0; i < 8; ++i) {
        loop.lloyd(1, flow::FloodScope::all, true);
        EXPECT_LE(loop.state().energy, energy);
        energy = loop.state().energy;
        partition::Labels labels = loop.state().labels;
        expect_partition(loop.passage(), labels, loop.state().regions());
        double sum = 0;
        for (const auto& fit : loop.state().fits) sum += fit.total;
        EXPECT_NEAR(sum, energy, 1e-12);
        double by_faces = 0;
        for (std::size_t f = 0; f < mesh.face_count(); ++f) by_faces += loop.state().density[f] * mesh.areas[f];
        EXPECT_NEAR(by_faces, energy, 1e-6 * energy);
    }
}

TEST(Paper, MoreRegionsCostLessEnergy) {
    const Shape shape = bumpy_grid(24);
    double previous = 1e300;
    for (const std::size_t regions : {1U, 3U, 6U, 12U}) {
        const PaperRun run = run_paper(shape, paper_options(regions));
        expect_valid(run);
        EXPECT_EQ(run.result.regions, regions);
        EXPECT_EQ(run.result.stop, StopReason::regions);
        const double energy = run.energy(paper_options());
        EXPECT_LT(energy, previous);
        previous = energy;
    }
}

TEST(Paper, MoreRegionsThanFaces) {
    for (const std::size_t initial : {1U, 0U}) {
        Options options = paper_options(1000);
        options.paper.initial_regions = initial;
        const PaperRun run = run_paper(cube(), options);
        expect_valid(run);
        EXPECT_EQ(run.result.regions, 12U);
        EXPECT_EQ(run.result.stop, StopReason::converged);
    }
}

TEST(Paper, ComponentsAreAFloor) {
    const Shape shape = joined(joined(box(2), box(3, 5)), grid(3, 3));
    for (const std::size_t regions : {1U, 3U}) {
        const PaperRun run = run_paper(shape, paper_options(regions));
        expect_valid(run);
        EXPECT_EQ(run.result.regions, 3U);
        EXPECT_EQ(run.result.stop, regions == 3 ? StopReason::regions : StopReason::converged);
    }
    const PaperRun all = run_paper(shape, paper_options());
    expect_valid(all);
    EXPECT_EQ(all.result.regions, 13U);
}

TEST(Paper, FeatureGroupsAreTheStartAndTheFloor) {
    Options options = paper_options(2);
    options.feature_angle = 30;
    const PaperRun few = run_paper(box(4), options);
    expect_valid(few);
    EXPECT_EQ(few.result.regions, 6U);
    EXPECT_EQ(few.result.stop, StopReason::converged);

    options.regions = 8;
    const PaperRun more = run_paper(box(4), options);
    expect_valid(more);
    EXPECT_EQ(more.result.regions, 8U);
    expect_surfaces(more, [&](std::size_t f) { return side_of(more.mesh.normals[f]); });
}

TEST(Paper, RandomSeedsAreMergedAndInsertedToTheNumber) {
    for (const std::size_t initial : {0U, 3U, 20U}) {
        Options options = paper_options(6);
        options.paper.initial_regions = initial;
        const PaperRun run = run_paper(box(6), options);
        expect_valid(run);
        EXPECT_EQ(run.result.regions, 6U);
        EXPECT_EQ(run.result.stop, StopReason::regions);
    }
}

TEST(Paper, TeleportationLeavesBadOptima) {
    // Six random seeds on a box rarely fall on six sides; Lloyd alone cannot carry a region across another.
    std::size_t stuck = 0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        Options options = paper_options(6);
        options.paper.initial_regions = 0;
        options.seed = seed;
        options.paper.teleportation = false;
        stuck += run_paper(box(6), options).energy(options) > 1e-3 ? 1U : 0U;
        options.paper.teleportation = true;
        const PaperRun run = run_paper(box(6), options);
        expect_valid(run);
        EXPECT_LT(run.energy(options), 1e-10) << "seed " << seed;
    }
    EXPECT_GE(stuck, 1U);
}

TEST(Paper, RedundantRegionsAreMerged) {
    Options options = paper_options();
    options.paper.initial_regions = 40;
    const PaperRun merged = run_paper(box(6), options);
    expect_valid(merged);
    EXPECT_EQ(merged.result.regions, 6U);
    options.paper.merging = false;
    EXPECT_GE(run_paper(box(6), options).result.regions, 40U);
}

TEST(Paper, MaximumBoundsInsertion) {
    Options options = paper_options();
    options.paper.energy_threshold = 1e-30;
    options.paper.merging = false;
    options.paper.maximum_regions = 9;
    const PaperRun run = run_paper(bumpy_grid(20), options);
    expect_valid(run);
    EXPECT_EQ(run.result.regions, 9U);
    EXPECT_EQ(run.result.stop, StopReason::maximum);
}

TEST(Paper, EnergyThresholdStopsInsertion) {
    Options options = paper_options();
    options.paper.merging = false;
    for (const double threshold : {1e-2, 1e-3}) {
        options.paper.energy_threshold = threshold;
        const PaperRun run = run_paper(bumpy_grid(20), options);
        EXPECT_EQ(run.result.stop, StopReason::tolerance);
        EXPECT_LE(run.energy(options), threshold);
    }
}

TEST(Paper, NothingWorthInsertingEndsTheLoop) {
    Options options = paper_options();
    options.paper.energy_threshold = 1e-30;
    const PaperRun run = run_paper(dome_on_plate(16, 4), options);
    expect_valid(run);
    EXPECT_EQ(run.result.stop, StopReason::converged);
    EXPECT_LT(run.result.regions, 200U);
}

TEST(Paper, RefinesLabelsFromACoarseMesh) {
    const PaperRun reference = run_paper(dome_on_plate(48, 12), paper_options(2));
    // A ragged version: every seventh face has the wrong label, so that regions are not even connected.
    partition::Labels ragged = reference.result.labels;
    for (std::size_t f = 0; f < ragged.size(); f += 7) ragged[f] = 1 - ragged[f];
    const PaperRun refined = run_paper(dome_on_plate(48, 12), paper_options(2), nullptr, &ragged);
    expect_valid(refined);
    EXPECT_EQ(refined.result.regions, 2U);
    EXPECT_GT(agreement(refined.result.labels, reference.result.labels), 0.97);
    EXPECT_LE(refined.result.energies.size(), 30U);
}

TEST(Paper, RefinementReachesEveryComponent) {
    const Shape shape = joined(box(2), box(2, 5));
    partition::Labels one(work_mesh(shape).face_count(), 0);
    const PaperRun run = run_paper(shape, paper_options(), nullptr, &one);
    expect_valid(run);
    EXPECT_GE(run.result.regions, 2U);
}

TEST(Paper, SameBytesOnAnyNumberOfThreads) {
    const Shape shape = bumpy_grid(40);
    Options options = paper_options(10);
    options.paper.initial_regions = 5;
    flow::FlowResult reference;
    for (const int threads : {1, 2, 8}) {
        PaperRun run;
        runtime::in_arena(threads, [&] { run = run_paper(shape, options); });
        if (threads == 1) {
            reference = run.result;
            continue;
        }
        EXPECT_EQ(run.result.labels, reference.labels);
        EXPECT_EQ(run.result.energies, reference.energies);
    }
}

TEST(Paper, CancellationLeavesAPartition) {
    // Cancelled by the progress function at its n-th call, wherever that may be.
    for (const int n : {1, 2, 5}) {
        Context context;
        int calls = 0;
        context.on_progress([&](const Progress&) { return ++calls < n; });
        Options options = paper_options(60);
        const PaperRun run = run_paper(bumpy_grid(70), options, &context);
        expect_valid(run);
        EXPECT_TRUE(run.result.partial);
        EXPECT_EQ(run.result.stop, StopReason::cancelled);
    }
}

TEST(Paper, DeadlineStopsInTime) {
    Context context;
    context.set_time_limit(0.15);
    const auto start = std::chrono::steady_clock::now();
    const PaperRun run = run_paper(bumpy_grid(150), paper_options(400), &context);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    expect_valid(run);
    EXPECT_TRUE(run.result.partial);
    EXPECT_EQ(run.result.stop, StopReason::deadline);
    EXPECT_LT(seconds, 1.5);  // generous: sanitizers, loaded machines
}

class Methods : public ::testing::TestWithParam<Method> {};

TEST_P(Methods, SegmentABox) {
    Options options = paper_options(6);
    options.method = GetParam();
    const PaperRun run = run_paper(box(5), options);
    expect_valid(run);
    EXPECT_EQ(run.result.regions, 6U);
}

TEST_P(Methods, TotalsAreThoseOfTheirMetric) {
    Options options = paper_options();
    options.method = GetParam();
    const mesh::WorkMesh mesh = work_mesh(bumpy_grid(12));
    const flow::MethodPolicy policy = flow::method_policy(options);
    std::vector<std::uint32_t> faces(mesh.face_count());
    std::iota(faces.begin(), faces.end(), 0U);
    partition::GatheredRegion region;
    partition::gather(mesh, faces.data(), faces.size(), region);
    const quadric::RegionFit fit = policy.fit(region.soup());
    double total = 0;
    for (const std::uint32_t f : faces) {
        total += partition::error_density(mesh, f, fit.proxy, policy.metric) * mesh.areas[f];
    }
    EXPECT_GT(fit.total, 0);
    EXPECT_NEAR(total, fit.total, 1e-9 * fit.total);
}

TEST_P(Methods, WorksOnCurvedMeshesAndWithoutANumber) {
    Options options = paper_options();
    options.method = GetParam();
    const bool distance_only = GetParam() == Method::vsa_l2 || GetParam() == Method::quadric_l2;
    options.paper.energy_threshold = distance_only ? 1e-6 : 0.02;
    options.paper.merge_tolerance = 1e-3 * options.paper.energy_threshold;
    const PaperRun run = run_paper(bumpy_grid(16), options);
    expect_valid(run);
    EXPECT_GT(run.result.regions, 1U);
}

INSTANTIATE_TEST_SUITE_P(All, Methods,
                         ::testing::Values(Method::quadric, Method::vsa_l21, Method::vsa_l2, Method::hybrid,
                                           Method::quadric_l2, Method::quadric_gradient, Method::hierarchical),
                         [](const auto& param_info) { return std::string(to_string(param_info.param)); });

TEST(Methods, PlanesHaveNoCurvature) {
    const mesh::WorkMesh mesh = work_mesh(bumpy_grid(8));
    std::vector<std::uint32_t> faces(mesh.face_count());
    std::iota(faces.begin(), faces.end(), 0U);
    partition::GatheredRegion region;
    partition::gather(mesh, faces.data(), faces.size(), region);
    for (const Method method : {Method::vsa_l21, Method::vsa_l2}) {
        Options options = paper_options();
        options.method = method;
        EXPECT_TRUE(flow::method_policy(options).fit(region.soup()).proxy.planar());
    }
}

TEST(Methods, HybridFitsASphereExactly) {
    const mesh::WorkMesh mesh = work_mesh(dome_on_plate(64, 24));
    std::vector<std::uint32_t> faces;
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
        if (mesh.frame.to_input(mesh.centroid(f)).z > 1e-3) faces.push_back(f);
    }
    partition::GatheredRegion region;
    partition::gather(mesh, faces.data(), faces.size(), region);
    Options options = paper_options();
    options.method = Method::hybrid;
    const auto fit = flow::method_policy(options).fit(region.soup());
    const Vec3 centre = mesh.frame.to_unit({0, 0, 0});
    const double radius = mesh.frame.scale;
    for (const Vec3& direction : {Vec3{0, 0, 1}, normalized(Vec3{1, 1, 1}), normalized(Vec3{-1, 0.5, 0.3})}) {
        const Vec3 p = centre + direction * radius - fit.proxy.origin;
        const double distance = quadric::value(fit.proxy.c, p) / norm(quadric::gradient(fit.proxy.c, p));
        EXPECT_LT(std::abs(distance), 0.005 * radius);  // chords of 64 facets
    }
    EXPECT_TRUE(fit.valid);
    EXPECT_FALSE(fit.proxy.planar());
}

}  // namespace
}  // namespace quadseg::test
