#include "flow/denoised_mesh.h"

#include "datasets/generate.h"
#include "flow/filtered_normals.h"
#include "runtime/parallel.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <gtest/gtest.h>
#include <vector>

namespace quadseg {
namespace {

const runtime::RunControl free_run(nullptr);

mesh::WorkMesh plate(double noise) {
    return mesh::build_work_mesh(datasets::generate("plate", 8000, noise).mesh.view(), free_run);
}

mesh::WorkMesh denoised(const mesh::WorkMesh& mesh) {
    return flow::denoised_mesh(mesh, flow::filtered_normals(mesh, 1, 3, free_run), free_run);
}

/// Root mean square of the distances of the corners across an edge from the faces on its other side.
double roughness(const mesh::WorkMesh& mesh) {
    double sum = 0, count = 0;
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        for (const std::int32_t g : mesh.neighbors[f]) {
            if (g < 0 || dot(mesh.normals[f], mesh.normals[static_cast<std::size_t>(g)]) < 0.9) continue;
            const double d = dot(mesh.normals[f], mesh.centroid(static_cast<std::size_t>(g)) - mesh.centroid(f));
            sum += d * d;
            ++count;
        }
    }
    return std::sqrt(sum / std::max(1.0, count));
}

TEST(DenoisedMesh, IsSmootherAndStaysWhereItWas) {
    const mesh::WorkMesh mesh = plate(0.002), moved = denoised(mesh);
    ASSERT_EQ(moved.faces, mesh.faces);
    ASSERT_EQ(moved.neighbors, mesh.neighbors);
    EXPECT_LT(roughness(moved), 0.6 * roughness(mesh));
    std::vector<double> way;
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) way.push_back(norm(moved.positions[v] - mesh.positions[v]));
    const auto middle = way.begin() + static_cast<std::ptrdiff_t>(way.size() / 2);
    std::nth_element(way.begin(), middle, way.end());
    EXPECT_LT(*middle, 1.5 * 0.002 * mesh.frame.diagonal);
}

TEST(DenoisedMesh, TheSameAtAnyThreadCount) {
    const mesh::WorkMesh mesh = plate(0.001);
    mesh::WorkMesh one, four;
    runtime::in_arena(1, [&] { one = denoised(mesh); });
    runtime::in_arena(4, [&] { four = denoised(mesh); });
    EXPECT_EQ(one.areas, four.areas);
}

TEST(DenoisedMesh, Stops) {
    const mesh::WorkMesh mesh = plate(0.001);
    const std::vector<Vec3> normals = mesh.normals;
    Context context;
    context.cancel();
    EXPECT_THROW((void)flow::denoised_mesh(mesh, normals, runtime::RunControl(&context)), runtime::Stopped);
}

}  // namespace
}  // namespace quadseg
