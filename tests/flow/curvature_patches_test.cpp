#include "flow/curvature_patches.h"

#include "flow/freeform.h"
#include "runtime/parallel.h"
#include "tests/flow/loop_support.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <set>

namespace quadseg::test {
namespace {

using flow::CurvatureField;
using flow::PatchRules;
using partition::Labels;

/// Graph of a height over [−1, 1]², the grid's lines jittered but x = 0 kept: a border runs along edges.
template <class Height>
Shape sheet(std::uint32_t n, const Height& height) {
    Shape s;
    for (std::uint32_t j = 0; j <= n; ++j) {
        for (std::uint32_t i = 0; i <= n; ++i) {
            double x = 2.0 * i / n - 1, y = 2.0 * j / n - 1;
            if (i != 0 && i != n && 2 * i != n) x += 0.5 / n * std::sin(7.0 * i + 3.0 * j);
            if (j != 0 && j != n) y += 0.5 / n * std::cos(5.0 * i + 11.0 * j);
            s.vertex(x, y, height(x, y));
        }
    }
    for (std::uint32_t j = 0; j < n; ++j) {
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t a = j * (n + 1) + i;
            s.quad(a, a + 1, a + n + 2, a + n + 1);
        }
    }
    return s;
}

Labels patches_of(const mesh::WorkMesh& mesh, const PatchRules& rules = {}) {
    const runtime::RunControl control(nullptr);
    const std::vector<std::uint8_t> all(mesh.face_count(), 1);
    const mesh::FeatureEdges none(mesh.face_count(), 0);
    const CurvatureField field = flow::estimate_curvatures(mesh, all, none, control);
    return flow::curvature_patches(mesh, none, field, all, rules, control);
}

double wavy(double x, double y) {
    return 0.05 * std::sin(2 * x + y) * std::cos(1.5 * y);
}

/// Bends from x = 0 on; position and normal are continuous there.
double bent(double x, double y) {
    return wavy(x, y) + (x > 0 ? 0.4 * x * x + 0.05 * x * x * x * y : 0);
}

TEST(CurvaturePatches, BorderIsWhereTheCurvatureJumps) {
    const mesh::WorkMesh mesh = work_mesh(sheet(32, bent));
    const Labels labels = patches_of(mesh);
    const std::set<std::int32_t> used(labels.begin(), labels.end());
    ASSERT_EQ(used, (std::set<std::int32_t>{0, 1}));
    double wrong = 0;
    const double middle = mesh.frame.to_unit({0, 0, 0}).x;
    std::size_t rightmost = 0;
    for (std::size_t f = 1; f < labels.size(); ++f) {
        if (mesh.centroid(f).x > mesh.centroid(rightmost).x) rightmost = f;
    }
    const std::int32_t right = labels[rightmost];
    for (std::size_t f = 0; f < labels.size(); ++f) {
        if ((mesh.centroid(f).x > middle) != (labels[f] == right)) wrong += mesh.areas[f];
    }
    EXPECT_LT(wrong, 0.01 * mesh.total_area);
}

TEST(CurvaturePatches, SmoothSheetIsOnePatch) {
    const mesh::WorkMesh mesh = work_mesh(sheet(32, wavy));
    const Labels labels = patches_of(mesh);
    EXPECT_EQ(*std::max_element(labels.begin(), labels.end()), 0);
}

TEST(CurvaturePatches, SameAtAnyNumberOfThreads) {
    const mesh::WorkMesh mesh = work_mesh(sheet(40, bent));
    Labels one, three;
    runtime::in_arena(1, [&] { one = patches_of(mesh); });
    runtime::in_arena(3, [&] { three = patches_of(mesh); });
    EXPECT_EQ(one, three);
}

TEST(CurvaturePatches, FacesThatAreNotWantedKeepOut) {
    const mesh::WorkMesh mesh = work_mesh(sheet(16, bent));
    const runtime::RunControl control(nullptr);
    std::vector<std::uint8_t> some(mesh.face_count(), 1);
    for (std::size_t f = 0; f < some.size(); f += 3) some[f] = 0;
    const mesh::FeatureEdges none(mesh.face_count(), 0);
    const CurvatureField field = flow::estimate_curvatures(mesh, some, none, control);
    const Labels labels = flow::curvature_patches(mesh, none, field, some, {}, control);
    for (std::size_t f = 0; f < some.size(); ++f) EXPECT_EQ(labels[f] < 0, some[f] == 0) << f;
}

TEST(Freeform, RoughSheetIsGroupedByEnergyIntoFewPatches) {
    // Curvature of noise jumps everywhere: it must not make crumbs.
    const auto rough = [](double x, double y) {
        return bent(x, y) + 0.002 * std::sin(97 * x + 31 * y) * std::sin(53 * y);
    };
    const mesh::WorkMesh mesh = work_mesh(sheet(48, rough));
    const Options options;
    const runtime::RunControl control(nullptr);
    Labels nothing(mesh.face_count(), -1);
    const flow::FlowResult result = flow::group_freeform({mesh, nullptr, options, control}, {}, nothing);
    EXPECT_LE(result.regions, 40U);
    for (const std::int32_t label : result.labels) {
        EXPECT_GE(label, 0);
        EXPECT_LT(label, static_cast<std::int32_t>(result.regions));
    }
}

TEST(Freeform, ExplainedFacesStayOut) {
    const mesh::WorkMesh mesh = work_mesh(sheet(16, bent));
    const Options options;
    const runtime::RunControl control(nullptr);
    Labels explained(mesh.face_count(), -1);
    for (std::size_t f = 0; f < explained.size() / 2; ++f) explained[f] = 0;
    const flow::FlowResult result = flow::group_freeform({mesh, nullptr, options, control}, {Surface{}}, explained);
    for (std::size_t f = 0; f < explained.size(); ++f) EXPECT_EQ(result.labels[f] < 0, explained[f] >= 0);
}

}  // namespace
}  // namespace quadseg::test
