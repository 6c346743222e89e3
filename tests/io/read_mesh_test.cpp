// Files on disk: names, permissions, cancellation, threads, and the real meshes.
#include "io_support.h"

#include <chrono>
#include <fcntl.h>
#include <sys/stat.h>
#include <thread>

namespace quadseg::test {
namespace {

constexpr const char* one_triangle = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

TEST(ReadMesh, FilesThatCannotBeOpened) {
    const TemporaryFolder folder;
    const auto fails = [&](const std::string& path, const std::string& word) {
        const Error error = error_of([&] { read_mesh(path); });
        EXPECT_EQ(error.code(), ErrorCode::file_open) << error.what();
        EXPECT_NE(std::string(error.what()).find(path), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    };
    fails(folder.file("missing.off"), "No such file");
    fails(folder.file(""), "directory");
    fails("", "No such file");
    fails("/dev/zero", "neither a file nor a pipe");
    const std::string locked = folder.put("locked.off", one_triangle);
    ASSERT_EQ(::chmod(locked.c_str(), 0), 0);
    if (::access(locked.c_str(), R_OK) != 0) fails(locked, "denied");  // root may read it
    const Error error = error_of([&] { read_mesh(folder.put("empty.off", "")); });
    EXPECT_EQ(error.code(), ErrorCode::file_format);
    EXPECT_NE(std::string(error.what()).find("empty"), std::string::npos);
}

TEST(ReadMesh, FromAPipe) {
    const TemporaryFolder folder;
    const std::string path = folder.file("pipe");
    ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
    const int keep_open = ::open(path.c_str(), O_RDWR);
    ASSERT_GE(keep_open, 0);
    const std::string text = one_triangle;
    ASSERT_EQ(::write(keep_open, text.data(), text.size()), static_cast<ssize_t>(text.size()));
    // Nobody closes the pipe: only the deadline ends the reading.
    Context context;
    context.set_time_limit(0.05);
    const auto start = std::chrono::steady_clock::now();
    EXPECT_EQ(error_of([&] { read_mesh(path, &context); }).code(), ErrorCode::cancelled);
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(1));
    ASSERT_EQ(::write(keep_open, text.data(), text.size()), static_cast<ssize_t>(text.size()));
    std::thread closer([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(60));
        ::close(keep_open);
    });
    const Mesh mesh = read_mesh(path);
    closer.join();
    EXPECT_EQ(mesh.triangles.size(), 3u);
}

TEST(ReadMesh, CancelledBeforeAndDuring) {
    const TemporaryFolder folder;
    const std::string path = folder.put("t.off", one_triangle);
    Context context;
    context.cancel();
    const Error error = error_of([&] { read_mesh(path, &context); });
    EXPECT_EQ(error.code(), ErrorCode::cancelled);
    EXPECT_NE(std::string(error.what()).find(path), std::string::npos);
    Context refusing;
    int reports = 0;
    refusing.on_progress([&](const Progress& progress) {
        EXPECT_EQ(progress.phase, Phase::read);
        ++reports;
        return false;
    });
    EXPECT_EQ(error_of([&] { read_mesh(path, &refusing); }).code(), ErrorCode::cancelled);
    EXPECT_EQ(reports, 1);
}

TEST(ReadMesh, ProgressEndsAtOne) {
    const TemporaryFolder folder;
    const std::string path = folder.put("t.off", one_triangle);
    Context context;
    double last = -1;
    context.on_progress([&](const Progress& progress) {
        EXPECT_GE(progress.fraction, last);
        last = progress.fraction;
        return true;
    });
    read_mesh(path, &context);
    EXPECT_EQ(last, 1);
}

TEST(ReadMesh, MemoryLimitIsKept) {
    const TemporaryFolder folder;
    const std::string path = folder.put("t.off", one_triangle);
    Context context;
    context.set_memory_limit(20);
    const Error error = error_of([&] { read_mesh(path, &context); });
    EXPECT_EQ(error.code(), ErrorCode::memory_limit);
    EXPECT_NE(std::string(error.what()).find("20"), std::string::npos);
    context.set_memory_limit(1 << 20);
    EXPECT_EQ(read_mesh(path, &context).triangles.size(), 3u);
}

TEST(ReadMesh, SameResultAtAnyNumberOfThreads) {
    const TemporaryFolder folder;
    const Mesh mesh = grid(220);
    for (const char* name : {"t.ply", "t.off", "t.obj", "t.stl"}) {
        const std::string path = folder.file(name);
        write_mesh(path, mesh.view());
        Mesh first;
        for (const int threads : {1, 2, 7}) {
            Context context;
            context.set_threads(threads);
            Mesh read = read_mesh(path, &context);
            if (threads == 1)
                first = std::move(read);
            else {
                EXPECT_EQ(read.positions, first.positions) << name;
                EXPECT_EQ(read.triangles, first.triangles) << name;
            }
        }
        EXPECT_EQ(first.triangles.size(), mesh.triangles.size());
    }
}

struct Known {
    const char* name;
    std::size_t faces, vertices, polygons;
};

class SharedMesh : public testing::TestWithParam<Known> {};

TEST_P(SharedMesh, HasItsCounts) {
    const std::string path = std::string(QUADSEG_SHARED_DIR) + "/meshes/" + GetParam().name;
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path;
    const Mesh mesh = read_mesh(path);
    EXPECT_EQ(mesh.triangles.size() / 3, GetParam().faces);
    EXPECT_EQ(mesh.positions.size() / 3, GetParam().vertices);
    EXPECT_EQ(mesh.file_faces, GetParam().polygons > 0 ? GetParam().polygons : GetParam().faces);
    EXPECT_EQ(mesh.polygons.empty(), GetParam().polygons == 0);
    for (const std::uint32_t v : mesh.triangles) ASSERT_LT(v, GetParam().vertices);
}

INSTANTIATE_TEST_SUITE_P(
    All, SharedMesh,
    testing::Values(Known{"fandisk.obj", 12946, 6475, 0}, Known{"bunny.obj", 69666, 34835, 0},
                    Known{"crank.off", 100028, 49986, 0}, Known{"lamp.off", 27100, 13548, 0},
                    Known{"octaflower.obj", 41938, 20971, 0}, Known{"rockerarm.off", 41552, 20776, 0},
                    Known{"pulley.obj", 50000, 25000, 0}, Known{"joint.obj", 41808, 20902, 0},
                    Known{"casting.obj", 36852, 18410, 0}, Known{"featuretype.ply", 85738, 42853, 0},
                    Known{"as1_assembly.ply", 239902, 119943, 0}, Known{"sharp_sphere_noisy.obj", 20882, 10443, 0},
                    Known{"armadillo.obj", 86482, 43243, 0}, Known{"foot_bones.off", 20016, 10010, 0},
                    Known{"iron_scan.ply", 168285, 85574, 0}, Known{"beetle_open.off", 38656, 19887, 0},
                    Known{"teapot_dense.off", 65020, 32512, 0}, Known{"thingi_73416.stl", 76840, 38396, 0},
                    Known{"nasty/motor.stl", 13506, 6635, 0}, Known{"nasty/office_chair.obj", 6893, 3476, 3391},
                    Known{"nasty/sub.obj", 2500, 1240, 0}, Known{"nasty/cycloidal.ply", 43368, 21384, 0},
                    Known{"nasty/broken.off", 10220, 7579, 0}, Known{"nasty/featuretype_soup.ply", 3476, 5096, 0},
                    Known{"nasty/many_small_holes.ply", 3524, 2004, 0}, Known{"nasty/non_manif_hole.ply", 755, 432, 0},
                    Known{"nasty/bunny10k_isolated.ply", 9999, 6164, 0},
                    Known{"nasty/far_out_ring.obj", 3072, 1536, 0}),
    [](const auto& instance) {
        std::string name = instance.param.name;
        for (char& c : name) {
            if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
        }
        return name;
    });

}  // namespace
}  // namespace quadseg::test
