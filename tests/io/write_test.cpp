#include "io_support.h"

#include <cmath>
#include <csignal>
#include <sys/resource.h>
#include <sys/stat.h>

namespace quadseg::test {
namespace {

const Mesh tetrahedron{{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}, {}, 4, 0};

void expect_write_error(const std::string& path, const std::string& word) {
    for (int k = 0; k < 3; ++k) {
        const Error error = error_of([&] {
            if (k == 0) write_ply(path, tetrahedron.view());
            if (k == 1) write_labels(path, std::vector<std::int32_t>(100000, 7));
            if (k == 2) write_text(path, "text");
        });
        EXPECT_EQ(error.code(), ErrorCode::file_write) << error.what();
        EXPECT_NE(std::string(error.what()).find(path), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
}

TEST(Write, EveryFormatComesBack) {
    const TemporaryFolder folder;
    Mesh mesh = grid(190);
    for (const char* name : {"a.ply", "a.off", "a.obj", "a.PLY", "a.Off"}) {
        write_mesh(folder.file(name), mesh.view());
        const Mesh read = read_mesh(folder.file(name));
        EXPECT_EQ(read.positions, mesh.positions) << name;
        EXPECT_EQ(read.triangles, mesh.triangles) << name;
        EXPECT_TRUE(read.polygons.empty());
    }
    write_mesh(folder.file("a.stl"), mesh.view());
    const Mesh read = read_mesh(folder.file("a.stl"));
    ASSERT_EQ(read.triangles.size(), mesh.triangles.size());
    EXPECT_EQ(read.positions.size(), mesh.positions.size());
    for (std::size_t c = 0; c < mesh.triangles.size(); ++c) {
        for (std::size_t k = 0; k < 3; ++k) {
            ASSERT_EQ(read.positions[3 * read.triangles[c] + k], mesh.positions[3 * mesh.triangles[c] + k]);
        }
    }
}

TEST(Write, AllBitsOfDoublesComeBack) {
    const TemporaryFolder folder;
    Mesh mesh = tetrahedron;
    mesh.positions = {0.1, 1e300, -1e-300, 1.0 / 3, 12345678.9, -0.0, 5e-324, 1, 2, 3, 4, std::nextafter(1.0, 2.0)};
    for (const char* name : {"a.ply", "a.off", "a.obj"}) {
        write_mesh(folder.file(name), mesh.view());
        EXPECT_EQ(read_mesh(folder.file(name)).positions, mesh.positions) << name;
    }
    EXPECT_NE(folder.get("a.ply").find("property double x"), std::string::npos);
    write_ply(folder.file("f.ply"), tetrahedron.view());
    EXPECT_NE(folder.get("f.ply").find("property float x"), std::string::npos);
}

TEST(Write, PlyCarriesColoursAndLabels) {
    const TemporaryFolder folder;
    const std::vector<std::int32_t> labels{3, -1, 7, 70000};
    const std::vector<std::uint8_t> rgb{1, 2, 3, 4, 5, 6, 7, 8, 9, 250, 251, 252};
    for (const bool coloured : {false, true}) {
        for (const bool labelled : {false, true}) {
            FaceColors faces;
            if (coloured) faces.rgb = rgb;
            if (labelled) faces.labels = labels;
            write_ply(folder.file("a.ply"), tetrahedron.view(), faces);
            EXPECT_EQ(read_mesh(folder.file("a.ply")).triangles, tetrahedron.triangles);
            const std::string text = folder.get("a.ply");
            EXPECT_EQ(text.find("property uchar red\nproperty uchar green\nproperty uchar blue\n") != std::string::npos,
                      coloured);
            EXPECT_EQ(text.find("property int label\n") != std::string::npos, labelled);
            // The last face stands at the end of the file, label last.
            std::string last;
            if (coloured) last.append({char(250), char(251), char(252)});
            if (labelled) append_bytes(last, std::int32_t{70000});
            EXPECT_EQ(text.substr(text.size() - last.size()), last);
        }
    }
    EXPECT_EQ(error_of([&] {
                  write_ply(folder.file("b.ply"), tetrahedron.view(), {std::span(labels).first(3), {}});
              }).code(),
              ErrorCode::invalid_argument);
    EXPECT_EQ(folder.files(), 1u);
}

TEST(Write, LabelsOnePerLine) {
    const TemporaryFolder folder;
    write_labels(folder.file("l"), std::vector<std::int32_t>{0, -1, 2147483647, -2147483647 - 1, 5});
    EXPECT_EQ(folder.get("l"), "0\n-1\n2147483647\n-2147483648\n5\n");
    write_labels(folder.file("l"), std::vector<std::int32_t>{4, 4, 5, 4, 4, 4},
                 std::vector<std::uint32_t>{0, 0, 1, 2, 3, 3});
    EXPECT_EQ(folder.get("l"), "4\n5\n4\n4\n");
    write_labels(folder.file("l"), {});
    EXPECT_EQ(folder.get("l"), "");
    std::vector<std::int32_t> many(2000000);
    std::string expected;
    for (std::size_t i = 0; i < many.size(); ++i) {
        many[i] = static_cast<std::int32_t>(i * 37 % 1000);
        expected += std::to_string(many[i]) + "\n";
    }
    write_labels(folder.file("l"), many);
    EXPECT_TRUE(folder.get("l") == expected);
}

TEST(Write, ReplacesFilesAndFollowsLinks) {
    const TemporaryFolder folder;
    folder.put("old", "old contents that are longer");
    ASSERT_EQ(::chmod(folder.file("old").c_str(), 0640), 0);
    ASSERT_EQ(::symlink("old", folder.file("link").c_str()), 0);
    write_text(folder.file("link"), "new");
    EXPECT_EQ(folder.get("old"), "new");
    EXPECT_TRUE(std::filesystem::is_symlink(folder.file("link")));
    struct stat info {};
    ASSERT_EQ(::stat(folder.file("old").c_str(), &info), 0);
    EXPECT_EQ(info.st_mode & 0777U, 0640U);
    EXPECT_EQ(folder.files(), 2u);
}

TEST(Write, FailuresLeaveNothing) {
    const TemporaryFolder folder;
    expect_write_error(folder.file("no/such/folder.ply"), "No such file");
    expect_write_error(folder.file(""), "directory");
    EXPECT_EQ(folder.files(), 0u);
    const Error error = error_of([&] { write_mesh(folder.file("mesh.xyz"), tetrahedron.view()); });
    EXPECT_EQ(error.code(), ErrorCode::invalid_argument);
    EXPECT_NE(std::string(error.what()).find(".ply"), std::string::npos);
    EXPECT_EQ(folder.files(), 0u);
}

TEST(Write, FullDeviceIsReportedAndStaysADevice) {
    if (::access("/dev/full", W_OK) != 0) GTEST_SKIP() << "no /dev/full";
    expect_write_error("/dev/full", "No space left");
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
    for (const auto& entry : std::filesystem::directory_iterator("/dev")) {
        EXPECT_EQ(entry.path().string().find("full.tmp"), std::string::npos);
    }
}

TEST(Write, FullDiskLeavesTheOldFile) {
    // A limit on the size of files is met like a full disk: in the middle of writing.
    const TemporaryFolder folder;
    folder.put("labels.txt", "old");
    rlimit before{};
    ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
    const rlimit small{100000, before.rlim_max};
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
    const Error error =
        error_of([&] { write_labels(folder.file("labels.txt"), std::vector<std::int32_t>(1000000, 12345)); });
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
    std::signal(SIGXFSZ, handler);
    EXPECT_EQ(error.code(), ErrorCode::file_write);
    EXPECT_NE(std::string(error.what()).find("too large"), std::string::npos) << error.what();
    EXPECT_EQ(folder.get("labels.txt"), "old");
    EXPECT_EQ(folder.files(), 1u);
}

TEST(Write, ReadOnlyFilesAreNotReplaced) {
    const TemporaryFolder folder;
    const std::string path = folder.put("locked", "old");
    ASSERT_EQ(::chmod(path.c_str(), 0400), 0);
    if (::access(path.c_str(), W_OK) == 0) GTEST_SKIP() << "root may write everywhere";
    expect_write_error(path, "denied");
    EXPECT_EQ(folder.get("locked"), "old");
}

}  // namespace
}  // namespace quadseg::test
