#include "flow/project.h"

#include <quadseg/segmenter.h>

#include "datasets/generate.h"
#include "flow/finish.h"
#include "surface/surface.h"
#include "tests/flow/loop_support.h"
#include "tests/partition/box.h"

#include <cmath>
#include <gtest/gtest.h>

namespace quadseg {
namespace {

using flow::FinalSurface;
using flow::SurfaceProjector;

FinalSurface final_plane(const Vec3& point, const Vec3& normal) {
    FinalSurface s;
    s.surface.type = SurfaceType::plane;
    s.surface.point = to_array(point);
    s.surface.axis = to_array(normalized(normal));
    return s;
}

FinalSurface final_cylinder(const Vec3& point, const Vec3& axis, double radius) {
    FinalSurface s;
    s.surface.type = SurfaceType::cylinder;
    s.surface.point = to_array(point);
    s.surface.axis = to_array(normalized(axis));
    s.surface.radius = radius;
    return s;
}

bool joint(const std::vector<FinalSurface>& surfaces, const Vec3& p, Vec3& result) {
    std::vector<SurfaceProjector> projectors(surfaces.begin(), surfaces.end());
    std::vector<const SurfaceProjector*> pointers;
    for (const SurfaceProjector& s : projectors) pointers.push_back(&s);
    return flow::joint_projection(pointers, p, result);
}

TEST(JointProjection, OfPlanesIsTheNearestPointOfTheirLineOrCorner) {
    Vec3 x;
    ASSERT_TRUE(joint({final_plane({}, {0, 0, 1}), final_plane({}, {1, 0, 1})}, {.02, .3, .01}, x));
    EXPECT_NEAR(norm(x - Vec3{0, .3, 0}), 0, 1e-12);
    ASSERT_TRUE(joint({final_plane({}, {0, 0, 1}), final_plane({}, {1, 0, 1}), final_plane({0, .3, 0}, {0, 1, 0})},
                      {.02, .31, .01}, x));
    EXPECT_NEAR(norm(x - Vec3{0, .3, 0}), 0, 1e-12);
}

TEST(JointProjection, LiesOnAllSurfacesAndNoPointOfTheirCurveIsNearer) {
    // A cylinder cut by a slanted plane: an ellipse, which can be walked along.
    const double r = .4;
    const std::vector<FinalSurface> surfaces{final_cylinder({}, {0, 0, 1}, r), final_plane({0, 0, .1}, {.5, 0, 1})};
    for (int i = 0; i < 50; ++i) {
        const double t = .13 * i;
        const Vec3 on{r * std::cos(t), r * std::sin(t), .1 - .5 * r * std::cos(t)};
        const Vec3 p = on + Vec3{.01 * std::sin(3. * i), .01 * std::cos(5. * i), .01 * std::sin(7. * i)};
        Vec3 x;
        ASSERT_TRUE(joint(surfaces, p, x));
        for (const FinalSurface& s : surfaces) EXPECT_NEAR(surface::signed_distance(s.surface, x), 0, 1e-10);
        double nearest = 1;
        for (int k = -2000; k <= 2000; ++k) {
            const double u = t + 1e-4 * k;
            nearest = std::min(nearest, norm(p - Vec3{r * std::cos(u), r * std::sin(u), .1 - .5 * r * std::cos(u)}));
        }
        EXPECT_LE(norm(x - p), nearest + 1e-3 * nearest + 1e-8);
    }
}

TEST(JointProjection, RefusesSurfacesWithoutACommonPointNearBy) {
    Vec3 x;
    EXPECT_FALSE(joint({final_plane({}, {0, 0, 1}), final_plane({0, 0, .01}, {0, 0, 1})}, {0, 0, .004}, x));
    EXPECT_FALSE(joint({final_plane({}, {0, 0, 1}), final_plane({0, 0, .01}, {.01, 0, 1})}, {0, 0, .004}, x));
    EXPECT_FALSE(joint({final_plane({0, 0, .5}, {0, 0, 1}), final_cylinder({}, {1, 0, 0}, .4)}, {0, 0, .45}, x));
}

TEST(JointProjection, TangentSurfacesMeetWhereTheyTouch) {
    // A fillet of radius .1 that ends in the plane z = 0 along x = 0.
    const std::vector<FinalSurface> surfaces{final_plane({}, {0, 0, 1}), final_cylinder({0, 0, .1}, {0, 1, 0}, .1)};
    Vec3 x;
    ASSERT_TRUE(joint(surfaces, {0, .2, 1e-4}, x));
    EXPECT_NEAR(norm(x - Vec3{0, .2, 0}), 0, 1e-9);
}

Options projecting(bool together) {
    Options options;
    options.project = true;
    options.project_joint = together;
    return options;
}

TEST(Project, VerticesOnTheirSurfacesStay) {
    const datasets::Generated part = datasets::generate("plate", 5000);
    const runtime::RunControl free_run(nullptr);
    const mesh::WorkMesh mesh = mesh::build_work_mesh(part.mesh.view(), free_run);
    flow::FlowResult truth;
    truth.labels = mesh::labels_from_input(mesh, part.truth);
    truth.regions = part.surfaces.size();
    for (const bool together : {false, true}) {
        const Options options = projecting(together);
        const Segmentation result = flow::finish({mesh, nullptr, options, free_run}, flow::FlowResult(truth));
        ASSERT_EQ(result.projected.size(), part.mesh.positions.size());
        for (std::size_t i = 0; i < result.projected.size(); ++i) {
            EXPECT_NEAR(result.projected[i], part.mesh.positions[i], 1e-7 * part.diagonal);
        }
    }
}

/// A box whose vertices are off by a little: inside vertices have to come back to their plane, with
/// `project_joint` those of edges and corners to all of theirs.
TEST(Project, NoisyVerticesComeBackToTheSurfaces) {
    test::Shape box = test::box(10);
    for (std::size_t i = 0; i < box.positions.size(); ++i)
        box.positions[i] += 1e-3 * std::sin(12.9898 * static_cast<double>(i * i));
    Options options = projecting(true);
    options.regions = 6;
    for (const bool together : {false, true}) {
        options.project_joint = together;
        const Segmentation result = segment(box.view(), options);
        ASSERT_EQ(result.regions.size(), 6U);
        double worst_inside = 0, worst_border = 0;
        std::vector<std::vector<std::int32_t>> around(box.positions.size() / 3);
        for (std::size_t c = 0; c < box.triangles.size(); ++c) {
            auto& labels = around[box.triangles[c]];
            if (std::find(labels.begin(), labels.end(), result.labels[c / 3]) == labels.end())
                labels.push_back(result.labels[c / 3]);
        }
        for (std::size_t v = 0; v < around.size(); ++v) {
            const Vec3 p{result.projected[3 * v], result.projected[3 * v + 1], result.projected[3 * v + 2]};
            for (const std::int32_t label : around[v]) {
                const double d =
                    std::abs(surface::signed_distance(result.regions[static_cast<std::size_t>(label)].surface, p));
                double& worst = around[v].size() == 1 ? worst_inside : worst_border;
                worst = std::max(worst, d);
            }
        }
        EXPECT_LT(worst_inside, 1e-12);
        if (together) {
            EXPECT_LT(worst_border, 1e-9);
        } else {
            EXPECT_GT(worst_border, 1e-6) << "the paper's average lies on none of the surfaces";
        }
    }
}

/// It took up to 50 ms of a million faces after a stop.
TEST(Project, Stops) {
    const mesh::WorkMesh mesh =
        mesh::build_work_mesh(datasets::generate("plate", 2000).mesh.view(), runtime::RunControl(nullptr));
    Context context;
    context.cancel();
    const runtime::RunControl stopped(&context);
    const Options options = projecting(false);
    const partition::Labels labels(mesh.face_count(), 0);
    EXPECT_THROW(flow::projected_positions({mesh, nullptr, options, stopped}, labels, {final_plane({}, {0, 0, 1})}),
                 runtime::Stopped);
}

TEST(Project, NothingLeavesTheInflatedBox) {
    const test::Shape bumps = test::bumpy_grid(30);
    Vec3 low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
    for (std::size_t i = 0; i < bumps.positions.size(); ++i) {
        const int k = static_cast<int>(i % 3);
        low[k] = std::min(low[k], bumps.positions[i]);
        high[k] = std::max(high[k], bumps.positions[i]);
    }
    const double margin = 0.0101 * norm(high - low);
    for (const std::size_t k : {1U, 2U, 7U, 60U}) {
        for (const bool together : {false, true}) {
            Options options = projecting(together);
            options.regions = k;
            const Segmentation result = segment(bumps.view(), options);
            for (std::size_t i = 0; i < result.projected.size(); ++i) {
                const int axis = static_cast<int>(i % 3);
                EXPECT_GE(result.projected[i], low[axis] - margin);
                EXPECT_LE(result.projected[i], high[axis] + margin);
            }
        }
    }
}

TEST(Project, IsolatedVerticesStay) {
    test::Shape box = test::box(3);
    const std::uint32_t lonely = box.vertex(0.3, 17, -4);
    const Segmentation result = segment(box.view(), projecting(false));
    ASSERT_EQ(result.projected.size(), box.positions.size());
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(result.projected[3 * lonely + k], box.positions[3 * lonely + k]);
    Segmenter segmenter(box.view());
    const std::vector<double> projected = segmenter.project();
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(projected[3 * lonely + k], box.positions[3 * lonely + k]);
}

TEST(Project, StitchedVerticesStayTogether) {
    // A triangle soup: every face has vertices of its own.
    const test::Shape box = test::box(4);
    test::Shape soup;
    for (std::size_t c = 0; c < box.triangles.size(); ++c) {
        const double* p = &box.positions[3 * std::size_t{box.triangles[c]}];
        soup.triangles.push_back(soup.vertex(p[0], p[1], p[2] + (p[0] > .4 ? .01 * p[1] * p[1] : 0)));
    }
    Options options = projecting(false);
    options.regions = 6;
    const Segmentation result = segment(soup.view(), options);
    for (std::size_t a = 0; a < box.triangles.size(); ++a) {
        for (std::size_t b = 0; b < a; ++b) {
            if (box.triangles[a] != box.triangles[b]) continue;
            for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(result.projected[3 * a + k], result.projected[3 * b + k]);
        }
    }
}

TEST(Segmenter, SmoothsClassifiesAndProjects) {
    const test::Shape can = test::capped_cylinder(60, 12);
    Options options;
    options.preset = Preset::paper;
    Segmenter segmenter(can.view(), options);
    std::vector<std::int32_t> labels(can.faces());
    // Side and disc, with a ragged border inside the side.
    for (std::size_t f = 0; f < labels.size(); ++f) {
        const std::size_t row = f / 120, column = f % 120 / 2;
        labels[f] = f >= 12 * 120 ? 0 : row + (column % 2) >= 6 ? 1 : 2;
    }
    segmenter.set_labels(labels);
    ASSERT_EQ(segmenter.region_count(), 3U);
    const std::vector<std::int32_t> before(segmenter.labels().begin(), segmenter.labels().end());
    segmenter.classify();
    EXPECT_TRUE(std::equal(before.begin(), before.end(), segmenter.labels().begin()));
    segmenter.smooth();
    EXPECT_EQ(segmenter.region_count(), 3U);
    EXPECT_FALSE(std::equal(before.begin(), before.end(), segmenter.labels().begin()));
    const std::vector<double> projected = segmenter.project();
    ASSERT_EQ(projected.size(), can.positions.size());
    for (std::size_t i = 0; i < projected.size(); ++i) EXPECT_NEAR(projected[i], can.positions[i], 1e-6);
    const Segmentation result = segmenter.result();
    std::size_t cylinders = 0;
    for (const Region& r : result.regions) cylinders += r.surface.type == SurfaceType::cylinder ? 1U : 0U;
    EXPECT_EQ(cylinders, 2U);
    EXPECT_TRUE(segmenter.undo());
    EXPECT_TRUE(std::equal(before.begin(), before.end(), segmenter.labels().begin()));
}

TEST(Smoothing, FillsTheBorderMeasures) {
    const datasets::Generated part = datasets::generate("flange", 6000);
    Options options;
    options.regions = 40;
    const Segmentation plain = segment(part.mesh.view(), options);
    EXPECT_EQ(plain.borders_before.length, 0);
    options.smooth = true;
    const Segmentation smooth = segment(part.mesh.view(), options);
    EXPECT_EQ(smooth.regions.size(), plain.regions.size());
    EXPECT_GT(smooth.borders_before.length, 0);
    EXPECT_LE(smooth.borders_after.length, smooth.borders_before.length * 1.001);
    EXPECT_LE(smooth.borders_after.zigzag, smooth.borders_before.zigzag + 0.1);
}

}  // namespace
}  // namespace quadseg
