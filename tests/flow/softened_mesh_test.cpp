#include "flow/softened_mesh.h"

#include "datasets/generate.h"
#include "flow/denoised_mesh.h"
#include "flow/filtered_normals.h"
#include "runtime/parallel.h"

#include <cmath>
#include <gtest/gtest.h>
#include <vector>

namespace quadseg {
namespace {

const runtime::RunControl free_run(nullptr);

mesh::WorkMesh flange(double noise) {
    return mesh::build_work_mesh(datasets::generate("flange", 20000, noise).mesh.view(), free_run);
}

mesh::WorkMesh softened(const mesh::WorkMesh& mesh, double ratio) {
    const flow::NoiseEstimate noise{ratio, 1, 0};
    return flow::softened_mesh(mesh, flow::softening_normals(mesh, noise, free_run), noise, free_run);
}

/// Mean square of the angle across edges of raw faces that lie nearly in a plane after averages over a wide ring.
double folding(const mesh::WorkMesh& mesh, const std::vector<Vec3>& smooth) {
    double sum = 0, count = 0;
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        for (const std::int32_t g : mesh.neighbors[f]) {
            if (g < 0) continue;
            const auto u = static_cast<std::size_t>(g);
            if (dot(smooth[f], smooth[u]) < 0.99) continue;
            const double angle = angle_between(mesh.normals[f], mesh.normals[u]);
            sum += angle * angle;
            ++count;
        }
    }
    return sum / count;
}

TEST(SoftenedMesh, IsTheRawOneUnderLightNoise) {
    const mesh::WorkMesh mesh = flange(0.0003), same = softened(mesh, 0.1);
    EXPECT_EQ(same.positions, mesh.positions);
    EXPECT_EQ(same.normals, mesh.normals);
    EXPECT_EQ(same.areas, mesh.areas);
}

/// The more so the larger the noise, and never as much as the mesh on which regions are found.
TEST(SoftenedMesh, UnfoldsFaces) {
    const mesh::WorkMesh mesh = flange(0.003);
    const std::vector<Vec3> smooth = flow::filtered_normals(mesh, 4, 0, free_run);
    const double raw = folding(mesh, smooth), light = folding(softened(mesh, 0.15), smooth),
                 medium = folding(softened(mesh, 0.25), smooth), strong = folding(softened(mesh, 0.5), smooth);
    EXPECT_LT(light, 0.8 * raw);
    EXPECT_LT(medium, 0.8 * light);
    EXPECT_LT(strong, 0.8 * medium);
    const mesh::WorkMesh denoised = flow::denoised_mesh(mesh, flow::filtered_normals(mesh, 1, 3, free_run), free_run);
    EXPECT_GT(strong, folding(denoised, smooth));
}

TEST(SoftenedMesh, NormalsAndAreasAreThoseOfItsFaces) {
    const mesh::WorkMesh mesh = flange(0.003), moved = softened(mesh, 0.5);
    for (std::size_t f = 0; f < moved.face_count(); ++f) {
        const Vec3 a = moved.corner(f, 0), twice = cross(moved.corner(f, 1) - a, moved.corner(f, 2) - a);
        ASSERT_NEAR(moved.areas[f], norm(twice) / 2, 1e-15);
        ASSERT_NEAR(dot(moved.normals[f], normalized(twice)), 1, 1e-12);
    }
    EXPECT_EQ(moved.faces, mesh.faces);
    EXPECT_EQ(moved.neighbors, mesh.neighbors);
}

TEST(SoftenedMesh, TheSameAtAnyThreadCount) {
    const mesh::WorkMesh mesh = flange(0.003);
    mesh::WorkMesh one, four;
    runtime::in_arena(1, [&] { one = softened(mesh, 0.5); });
    runtime::in_arena(4, [&] { four = softened(mesh, 0.5); });
    EXPECT_EQ(one.positions, four.positions);
    EXPECT_EQ(one.normals, four.normals);
}

TEST(SoftenedMesh, Stops) {
    const mesh::WorkMesh mesh = flange(0.003);
    Context context;
    context.cancel();
    EXPECT_THROW((void)flow::softened_mesh(mesh, mesh.normals, {0.5, 1, 0}, runtime::RunControl(&context)),
                 runtime::Stopped);
}

}  // namespace
}  // namespace quadseg
