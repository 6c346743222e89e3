#include "mesh/connected.h"

#include "mesh/work_mesh.h"
#include "runtime/run_control.h"
#include "tests/mesh/shapes.h"

#include <atomic>
#include <gtest/gtest.h>

namespace quadseg {
namespace {

const runtime::RunControl free_run(nullptr);

/// The definition: floods from the first face that has no number yet.
template <class Wanted, class Together>
std::size_t flood(const mesh::WorkMesh& mesh, const Wanted& wanted, const Together& together,
                  std::vector<std::int32_t>& part) {
    part.assign(mesh.face_count(), -1);
    std::int32_t count = 0;
    std::vector<std::size_t> stack;
    for (std::size_t seed = 0; seed < part.size(); ++seed) {
        if (part[seed] >= 0 || !wanted(seed)) continue;
        part[seed] = count;
        stack.assign(1, seed);
        while (!stack.empty()) {
            const std::size_t f = stack.back();
            stack.pop_back();
            for (std::size_t k = 0; k < 3; ++k) {
                if (mesh.neighbors[f][k] < 0) continue;
                const auto g = static_cast<std::size_t>(mesh.neighbors[f][k]);
                if (part[g] >= 0 || !wanted(g) || !together(f, k, g)) continue;
                part[g] = count;
                stack.push_back(g);
            }
        }
        ++count;
    }
    return static_cast<std::size_t>(count);
}

/// Checks of 8 by 8 squares.
std::size_t check_of(const mesh::WorkMesh& mesh, std::size_t f) {
    const Vec3 p = mesh.frame.to_input(mesh.centroid(f));
    return (static_cast<std::size_t>(p.x / 8) + static_cast<std::size_t>(p.y / 8)) % 2;
}

TEST(ConnectedFaces, NumbersTheSetsByFirstFaceAtAnyThreadCount) {
    const mesh::WorkMesh mesh = test::build(test::joined(test::grid(160, 160), test::grid(40, 40)));
    const auto wanted = [](std::size_t f) { return f % 11 != 0; };
    const auto together = [&](std::size_t f, std::size_t, std::size_t g) {
        return check_of(mesh, f) == check_of(mesh, g);
    };
    std::vector<std::int32_t> expected;
    const std::size_t count = flood(mesh, wanted, together, expected);
    EXPECT_GE(count, 400U + 25U);
    for (const int threads : {1, 2, 8}) {
        runtime::in_arena(threads, [&] {
            std::vector<std::int32_t> part;
            EXPECT_EQ(mesh::connected_faces(
                          mesh, wanted, together, [] {}, part),
                      count);
            EXPECT_EQ(part, expected) << threads;
        });
    }
}

TEST(ConnectedFaces, TheResultMayReplaceTheLabelsThatAreAsked) {
    const mesh::WorkMesh mesh = test::build(test::grid(30, 20));
    std::vector<std::int32_t> labels(mesh.face_count());
    for (std::size_t f = 0; f < labels.size(); ++f) labels[f] = f % 3 == 0 ? -1 : static_cast<std::int32_t>(f % 7 / 4);
    const auto wanted = [&](std::size_t f) { return labels[f] >= 0; };
    const auto together = [&](std::size_t f, std::size_t, std::size_t g) { return labels[f] == labels[g]; };
    std::vector<std::int32_t> expected;
    const std::size_t count = flood(mesh, wanted, together, expected);
    EXPECT_EQ(mesh::connected_faces(
                  mesh, wanted, together, [] {}, labels),
              count);
    EXPECT_EQ(labels, expected);
}

/// It may look up what only wanted faces have, at either side of the edge.
TEST(ConnectedFaces, AsksAboutWantedNeighboursOnly) {
    const mesh::WorkMesh mesh = test::build(test::grid(120, 120));
    const auto wanted = [](std::size_t f) { return f % 5 != 0; };
    std::atomic<int> wrong{0};
    const auto together = [&](std::size_t f, std::size_t k, std::size_t g) {
        if (!wanted(f) || !wanted(g) || mesh.neighbors[f][k] != static_cast<std::int32_t>(g)) ++wrong;
        return true;
    };
    std::vector<std::int32_t> part;
    mesh::connected_faces(
        mesh, wanted, together, [] {}, part);
    EXPECT_EQ(wrong, 0);
}

TEST(ConnectedFaces, NothingWanted) {
    const mesh::WorkMesh mesh = test::build(test::grid(10, 10));
    std::vector<std::int32_t> part;
    const auto never = [](auto...) { return false; };
    EXPECT_EQ(mesh::connected_faces(
                  mesh, never, never, [] {}, part),
              0U);
    EXPECT_EQ(part, std::vector<std::int32_t>(mesh.face_count(), -1));
}

}  // namespace
}  // namespace quadseg
