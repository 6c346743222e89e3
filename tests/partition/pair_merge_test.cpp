#include "partition/pair_merge.h"

#include "datasets/generate.h"
#include "quadric/ladder.h"
#include "runtime/parallel.h"
#include "tests/partition/box.h"

#include <gtest/gtest.h>

namespace quadseg {
namespace {

using partition::Labels;
using partition::MergeRules;
using partition::Merging;
using partition::Passage;

const runtime::RunControl free_run(nullptr);

partition::Scorer ladder_scorer(double weight = 0.5) {
    return [weight](const quadric::Moments& m) {
        const quadric::LadderFit fit = quadric::fit_ladder(m, weight, true);
        return partition::RegionScore{fit.cost, fit.energy, fit.dof};
    };
}

Merging merge_leaves(const Passage& passage, Labels& labels, const MergeRules& rules, std::size_t largest = 128) {
    partition::LeafOptions options;
    options.largest = largest;
    options.smallest_coplanar = 0;
    partition::Leaves leaves = grow_leaves(passage, options, free_run);
    const partition::Scorer scorer = ladder_scorer();
    Merging merging = merge_pairs(measure_regions(*passage.mesh, leaves.labels, leaves.count, scorer, free_run),
                                  region_pairs(passage, leaves.labels, free_run), rules, scorer, free_run);
    labels = leaves.labels;
    for (std::int32_t& label : labels) {
        if (label >= 0) label = merging.region_of[static_cast<std::size_t>(label)];
    }
    return merging;
}

TEST(PairMerge, FindsTheSixSidesOfABoxAndThenStops) {
    const mesh::WorkMesh mesh = test::work_mesh(test::box(16));
    const Passage passage{&mesh};
    MergeRules rules;
    rules.misfit = 0.5 * 0.006;
    Labels labels;
    const Merging merging = merge_leaves(passage, labels, rules, 7);
    EXPECT_EQ(merging.regions.size(), 6U);
    test::expect_partition(passage, labels, 6);
    for (const partition::MergeRegion& r : merging.regions) {
        EXPECT_NEAR(r.moments.total_area, 1, 1e-12);
        EXPECT_LT(r.score.energy, 1e-12);
    }
}

TEST(PairMerge, LabelsAreTheSameWhereRegionsAreNotWanted) {
    const mesh::WorkMesh mesh = test::work_mesh(test::capped_cylinder(90, 20));
    const Passage passage{&mesh};
    MergeRules rules;
    rules.target = 5;
    Labels with, without;
    EXPECT_EQ(merge_leaves(passage, with, rules).regions.size(), 5U);
    rules.labels_only = true;
    EXPECT_TRUE(merge_leaves(passage, without, rules).regions.empty());
    EXPECT_EQ(without, with);
}

TEST(PairMerge, FindsCylinderAndLid) {
    const mesh::WorkMesh mesh = test::work_mesh(test::capped_cylinder(90, 20));
    const Passage passage{&mesh};
    MergeRules rules;
    rules.misfit = 0.5 * 0.006;
    Labels labels;
    EXPECT_EQ(merge_leaves(passage, labels, rules).regions.size(), 2U);
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        EXPECT_EQ(labels[f] == labels[0], (std::abs(mesh.normals[f].z) > 0.5) == (std::abs(mesh.normals[0].z) > 0.5));
    }
}

TEST(PairMerge, ReachesAnyTargetDownToTheComponents) {
    const mesh::WorkMesh mesh = test::work_mesh(test::joined(test::box(6), test::box(6, 3)));
    const Passage passage{&mesh};
    for (const std::size_t target : {2U, 3U, 7U, 12U, 20U}) {
        MergeRules rules;
        rules.target = target;
        Labels labels;
        EXPECT_EQ(merge_leaves(passage, labels, rules, 6).regions.size(), target);
        test::expect_partition(passage, labels, target);
    }
    MergeRules rules;
    rules.target = 1;
    Labels labels;
    EXPECT_EQ(merge_leaves(passage, labels, rules).regions.size(), 2U);
}

TEST(PairMerge, HistoryCountsDownAndItsEnergyIsThatOfTheRegions) {
    const mesh::WorkMesh mesh = test::work_mesh(test::capped_cylinder(40, 10));
    const Passage passage{&mesh};
    MergeRules rules;
    rules.target = 1;
    Labels labels;
    const Merging merging = merge_leaves(passage, labels, rules);
    ASSERT_FALSE(merging.history.empty());
    for (std::size_t i = 1; i < merging.history.size(); ++i) {
        EXPECT_EQ(merging.history[i].regions + 1, merging.history[i - 1].regions);
    }
    EXPECT_EQ(merging.history.back().regions, 1U);
    EXPECT_NEAR(merging.history.back().energy, merging.regions[0].score.energy, 1e-9);
}

TEST(PairMerge, MisfitAndNoiseBuyMerges) {
    const mesh::WorkMesh mesh = test::work_mesh(test::bumpy_grid(40));
    const Passage passage{&mesh};
    MergeRules none, misfit, noise;
    misfit.misfit = 0.5 * 0.006;
    noise.noise = 1e-5;
    Labels labels;
    const std::size_t strict = merge_leaves(passage, labels, none).regions.size();
    EXPECT_LT(merge_leaves(passage, labels, misfit).regions.size(), strict);
    EXPECT_LT(merge_leaves(passage, labels, noise).regions.size(), strict);
}

TEST(PairMerge, ToleranceBoundsTheDistanceOfTheUnion) {
    const mesh::WorkMesh mesh = test::work_mesh(test::bumpy_grid(40));
    const Passage passage{&mesh};
    const partition::Scorer scorer = [](const quadric::Moments& m) {
        const quadric::LadderFit fit = quadric::fit_ladder(m, 0.5, false);
        return partition::RegionScore{fit.cost, fit.energy, fit.dof, quadric::moment_energy(fit.c, m).distance};
    };
    std::size_t before = mesh.face_count() + 1;
    for (const double tolerance : {1e-4, 1e-3, 1e-2}) {
        partition::Leaves leaves = grow_leaves(passage, {}, free_run);
        MergeRules rules;
        rules.tolerance = tolerance;
        const Merging merging = merge_pairs(measure_regions(mesh, leaves.labels, leaves.count, scorer, free_run),
                                            region_pairs(passage, leaves.labels, free_run), rules, scorer, free_run);
        std::vector<int> fragments(merging.regions.size(), 0);
        for (const std::int32_t r : merging.region_of) ++fragments[static_cast<std::size_t>(r)];
        for (std::size_t i = 0; i < merging.regions.size(); ++i) {
            const partition::MergeRegion& r = merging.regions[i];
            if (fragments[i] == 1) continue;
            EXPECT_LE(r.score.distance, tolerance * tolerance * r.moments.total_area);
        }
        EXPECT_LT(merging.regions.size(), before);
        before = merging.regions.size();
    }
}

TEST(PairMerge, TheSameAtAnyThreadCount) {
    const datasets::Generated plate = datasets::generate("plate", 30000);
    const mesh::WorkMesh mesh = mesh::build_work_mesh(plate.mesh.view(), free_run);
    const Passage passage{&mesh};
    MergeRules rules;
    rules.target = 80;
    Labels one, four;
    Merging merged_one, merged_four;
    runtime::in_arena(1, [&] { merged_one = merge_leaves(passage, one, rules); });
    runtime::in_arena(4, [&] { merged_four = merge_leaves(passage, four, rules); });
    EXPECT_EQ(one, four);
    ASSERT_EQ(merged_one.history.size(), merged_four.history.size());
    for (std::size_t i = 0; i < merged_one.history.size(); ++i) {
        EXPECT_EQ(merged_one.history[i].energy, merged_four.history[i].energy);
    }
}

TEST(PairMerge, StopsBetweenMergesWhenAsked) {
    const mesh::WorkMesh mesh = test::work_mesh(test::box(8));
    const Passage passage{&mesh};
    const partition::Leaves leaves = grow_leaves(passage, {}, free_run);
    const partition::Scorer scorer = ladder_scorer();
    auto regions = measure_regions(mesh, leaves.labels, leaves.count, scorer, free_run);
    Context context;
    context.cancel();
    const runtime::RunControl stopped(&context);
    MergeRules rules;
    rules.target = 1;
    const Merging merging =
        merge_pairs(std::move(regions), region_pairs(passage, leaves.labels, free_run), rules, scorer, stopped);
    EXPECT_TRUE(merging.stopped);
    EXPECT_EQ(merging.regions.size(), leaves.count);
    EXPECT_EQ(merging.region_of.size(), leaves.count);
}

}  // namespace
}  // namespace quadseg
