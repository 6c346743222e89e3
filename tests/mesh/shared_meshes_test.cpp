// The real meshes, where they are at hand: the counts of their description are what the check reports.
#include <quadseg/io.h>

#include "tests/mesh/shapes.h"

#include <filesystem>
#include <gtest/gtest.h>

namespace quadseg::test {
namespace {

struct Described {
    const char* file;
    std::size_t faces, vertices, components, border, non_manifold_edges, non_manifold_vertices, duplicates, isolated;
};

const Described described[] = {
    {"fandisk.obj", 12946, 6475, 1, 0, 0, 0, 0, 0},
    {"bunny.obj", 69666, 34835, 1, 0, 0, 0, 0, 0},
    {"crank.off", 100028, 49986, 1, 0, 24, 36, 12, 0},
    {"featuretype.ply", 85738, 42853, 1, 0, 0, 0, 0, 0},
    {"as1_assembly.ply", 239902, 119943, 18, 0, 0, 0, 0, 0},
    {"iron_scan.ply", 168285, 85574, 1, 2863, 0, 0, 0, 0},
    {"beetle_open.off", 38656, 19887, 1, 1136, 0, 0, 0, 0},
    {"teapot_dense.off", 65020, 32512, 1, 0, 0, 0, 0, 4},
    {"thingi_73416.stl", 76840, 38396, 1, 0, 0, 0, 0, 0},
    {"nasty/motor.stl", 13506, 6635, 12, 10, 162, 141, 24, 0},
    {"nasty/sub.obj", 2500, 1240, 1, 0, 6, 10, 1, 0},
    {"nasty/cycloidal.ply", 43368, 21384, 100, 0, 242, 270, 0, 0},
    {"nasty/broken.off", 10220, 7579, 87, 4776, 8, 8, 0, 0},
    {"nasty/featuretype_soup.ply", 3476, 5096, 852, 5074, 0, 0, 0, 0},
    {"nasty/many_small_holes.ply", 3524, 2004, 1, 556, 0, 6, 0, 0},
    {"nasty/non_manif_hole.ply", 755, 432, 1, 119, 0, 5, 0, 0},
    {"nasty/bunny10k_isolated.ply", 9999, 6164, 1, 109, 0, 0, 0, 1113},
    {"nasty/far_out_ring.obj", 3072, 1536, 1, 0, 0, 0, 0, 0},
    {"nasty/office_chair.obj", 6893, 3476, 20, 157, 138, 140, 8, 0},
};

class SharedMesh : public testing::TestWithParam<Described> {};

TEST_P(SharedMesh, ReportsWhatIsKnown) {
    const Described& d = GetParam();
    const auto path = std::filesystem::path(QUADSEG_SHARED_DIR) / "meshes" / d.file;
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not at hand";
    const Mesh input = read_mesh(path.string());
    const runtime::RunControl control(nullptr);
    const mesh::WorkMesh m = mesh::build_work_mesh(input.view(), control);
    expect_consistent(input.view(), m);
    const MeshReport& r = m.report;
    EXPECT_EQ(r.faces, d.faces);
    EXPECT_EQ(r.vertices, d.vertices);
    EXPECT_EQ(r.isolated_vertices, d.isolated);
    // The description counts edges before duplicates are taken out, and polygons cut into fans.
    if (!input.polygons.empty()) return;
    EXPECT_EQ(r.duplicate_faces, d.duplicates);
    if (d.duplicates > 0) return;
    EXPECT_EQ(r.border_edges, d.border);
    EXPECT_EQ(r.non_manifold_edges, d.non_manifold_edges);
    EXPECT_EQ(r.non_manifold_vertices, d.non_manifold_vertices);
    if (r.non_manifold_edges == 0 && r.stitched_edges == 0) {
        EXPECT_EQ(r.components, d.components);
    }
}

TEST(SharedSoup, BecomesOneClosedComponent) {
    const auto path = std::filesystem::path(QUADSEG_SHARED_DIR) / "meshes/nasty/featuretype_soup.ply";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not at hand";
    const Mesh input = read_mesh(path.string());
    const mesh::WorkMesh m = mesh::build_work_mesh(input.view(), runtime::RunControl(nullptr));
    EXPECT_EQ(m.component_count, 1U);
    EXPECT_EQ(2 * m.report.stitched_edges, m.report.border_edges);
}

INSTANTIATE_TEST_SUITE_P(All, SharedMesh, testing::ValuesIn(described),
                         [](const auto& test) { return std::filesystem::path(test.param.file).stem().string(); });

}  // namespace
}  // namespace quadseg::test
