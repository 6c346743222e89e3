#include "flow/vertex_moves.h"

#include "runtime/parallel.h"

#include <gtest/gtest.h>
#include <vector>

namespace quadseg {
namespace {

const runtime::RunControl free_run(nullptr);

/// A hexagon of six triangles about vertex 0 at height z; vertex 7 has no face.
mesh::WorkMesh tent(double z) {
    mesh::WorkMesh mesh;
    mesh.positions = {{0, 0, z},  {1, 0, 0},     {0.5, 1, 0},  {-0.5, 1, 0},
                      {-1, 0, 0}, {-0.5, -1, 0}, {0.5, -1, 0}, {9, 9, 9}};
    for (std::uint32_t k = 0; k < 6; ++k) mesh.faces.push_back({0, 1 + k, 1 + (k + 1) % 6});
    mesh.normals.assign(6, {0, 0, 1});
    return mesh;
}

double height(const mesh::WorkMesh& mesh, std::size_t v) {
    return mesh.positions[v].z;
}

TEST(VertexMoves, ToPlanesAlongTheNormalsOnly) {
    mesh::WorkMesh mesh = tent(0.3);
    const mesh::VertexFaces incident = mesh::vertex_faces(mesh);
    flow::move_to_planes(mesh, incident, 1, free_run);
    EXPECT_NEAR(height(mesh, 0), 0.1, 1e-15);  // the centroids' height
    EXPECT_NEAR(height(mesh, 1), 0.1, 1e-15);
    EXPECT_EQ(mesh.positions[1].x, 1);
    EXPECT_EQ(height(mesh, 7), 9);
}

TEST(VertexMoves, ToTheRingWithItself) {
    mesh::WorkMesh mesh = tent(0.7);
    const mesh::VertexFaces incident = mesh::vertex_faces(mesh);
    flow::move_to_ring(mesh, incident, 1, free_run);
    EXPECT_NEAR(height(mesh, 0), 0.1, 1e-15);  // a seventh
    // At the border: twice itself and the centre, and once each of its two neighbours.
    EXPECT_NEAR(height(mesh, 1), 0.7 * 2 / 6, 1e-15);
    EXPECT_EQ(height(mesh, 7), 9);
}

TEST(VertexMoves, GoAShareOfTheWay) {
    mesh::WorkMesh planes = tent(0.3), ring = tent(0.7), still = tent(0.3);
    const mesh::VertexFaces incident = mesh::vertex_faces(planes);
    flow::move_to_planes(planes, incident, 0.5, free_run);
    flow::move_to_ring(ring, incident, 0.5, free_run);
    flow::move_to_planes(still, incident, 0, free_run);
    EXPECT_NEAR(height(planes, 0), 0.2, 1e-15);
    EXPECT_NEAR(height(ring, 0), 0.4, 1e-15);
    EXPECT_EQ(height(still, 0), 0.3);
}

TEST(VertexMoves, Stop) {
    mesh::WorkMesh mesh = tent(0.3);
    const mesh::VertexFaces incident = mesh::vertex_faces(mesh);
    Context context;
    context.cancel();
    const runtime::RunControl stopped(&context);
    EXPECT_THROW(flow::move_to_planes(mesh, incident, 1, stopped), runtime::Stopped);
    EXPECT_THROW(flow::move_to_ring(mesh, incident, 1, stopped), runtime::Stopped);
}

}  // namespace
}  // namespace quadseg
