#include "io_support.h"

namespace quadseg::test {
namespace {

using Triangles = std::vector<std::uint32_t>;

const std::string tetrahedron_body = "4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
const Triangles tetrahedron{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};

TEST(Off, ReadsPlainFile) {
    const Mesh mesh = parse("OFF\n" + tetrahedron_body, "t.off");
    EXPECT_EQ(mesh.positions, (std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}));
    EXPECT_EQ(mesh.triangles, tetrahedron);
    EXPECT_TRUE(mesh.polygons.empty());
    EXPECT_EQ(mesh.file_faces, 4u);
}

TEST(Off, ContentsDecideNotTheName) {
    for (const char* name : {"t.obj", "t.stl", "t.ply", "t", "t.OFF"}) {
        EXPECT_EQ(parse("OFF\n" + tetrahedron_body, name).triangles, tetrahedron) << name;
    }
}

TEST(Off, KeywordMayBeMissingUnderItsExtension) {
    EXPECT_EQ(parse(tetrahedron_body, "t.off").triangles, tetrahedron);
    expect_error(tetrahedron_body, "t.dat", ErrorCode::file_format, {"none of OFF, OBJ, PLY, STL"});
}

TEST(Off, AcceptsHeaderVariants) {
    for (const char* header : {"OFF ", "OFF # first\n\n# second\n", "# before\nOFF\r\n", "\xEF\xBB\xBFOFF\n"}) {
        EXPECT_EQ(parse(header + tetrahedron_body, "t").triangles, tetrahedron) << header;
    }
    // The number of edges may be missing.
    EXPECT_EQ(parse("OFF\n3 1\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2", "t").triangles, (Triangles{0, 1, 2}));
}

TEST(Off, IgnoresColoursNormalsAndTextureCoordinates) {
    const Triangles one{0, 1, 2};
    const std::vector<double> positions{0, 0, 0, 1, 0, 0, 0, 1, 0};
    const std::string vertices[] = {
        "COFF\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 .5 .5 .5 1\n0 1 0 1 2 3 4\n",
        "NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n", "STOFF\n3 1 0\n0 0 0 0 1\n1 0 0 0 1\n0 1 0 1 1\n",
        "STCNOFF\n3 1 0\n0 0 0 0 0 1 1 1 1 1 0 0\n1 0 0 0 0 1 1 1 1 1 0 0\n0 1 0 0 0 1 1 1 1 1 0 0\n"};
    for (const std::string& text : vertices) {
        const Mesh mesh = parse(text + "3 0 1 2 255 128 0  # red\n", "t.off");
        EXPECT_EQ(mesh.triangles, one) << text;
        EXPECT_EQ(mesh.positions, positions) << text;
    }
}

TEST(Off, IndicesNeedNotBePlainlyWritten) {
    const std::string vertices = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n";
    for (const char* face : {"3 0 1 2", "  3   0  1 2  ", "3\t0\t1\t2", "+3 +0 +1 +2", "3 0 1 2# red", "3 0 1 2\t",
                             "003 0000000000000 01 2"}) {
        EXPECT_EQ(parse(vertices + face + "\n", "t").triangles, (Triangles{0, 1, 2})) << face;
    }
    // 2^32 + 2 is not 2.
    for (const char* face : {"3 0 1 4294967298", "3 0 1 3", "3 0 1 -2", "3 0 1 2.0", "3 0 1"}) {
        EXPECT_THROW(parse(vertices + face + "\n", "t"), Error) << face;
    }
}

TEST(Off, CommentsAndBlankLinesMayStandAnywhere) {
    EXPECT_EQ(
        parse("OFF\n3 1 0 # counts\n\n0 0 0\n# between\n1 0 0 # v\n \t\n0 1 0\n\n3 0 1 2\n\n# end", "t").triangles,
        (Triangles{0, 1, 2}));
}

TEST(Off, LinesMayEndInAnyOfThreeWays) {
    for (const std::string end : {"\n", "\r\n", "\r"}) {
        std::string text = "# c\nOFF\n" + tetrahedron_body;
        for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += end.size()) {
            text.replace(at, 1, end);
        }
        EXPECT_EQ(parse(text, "t").triangles, tetrahedron);
    }
}

TEST(Off, NumbersOfAllShapes) {
    const Mesh mesh = parse("OFF\n3 1 0\n+1 -.5 2.\n1e3 1E-2 -0\n0.1 123456789.123456789 1e-320\n3 0 1 2", "t");
    EXPECT_EQ(mesh.positions, (std::vector<double>{1, -.5, 2, 1e3, 1e-2, 0, .1, 123456789.123456789, 1e-320}));
}

TEST(Off, NamesLineOfEveryFault) {
    const auto format = ErrorCode::file_format;
    const auto invalid = ErrorCode::invalid_mesh;
    expect_error("OFF BINARY\n", "t", format, {"line 1", "binary OFF", "convert"});
    expect_error("4OFF\n1 1 0\n", "t", format, {"line 1", "three-dimensional"});
    expect_error("nOFF 3\n1 1 0\n", "t", format, {"line 1", "three-dimensional"});
    expect_error("OFF\n", "t", format, {"number of vertices", "end of the file"});
    expect_error("OFF\n3\n", "t", format, {"number of faces", "end of the file"});
    expect_error("OFF\nx 1 0\n", "t", format, {"line 2", "'x'"});
    expect_error("OFF\n-3 1 0\n", "t", format, {"line 2"});
    expect_error("OFF\n3 1 0 7\n", "t", format, {"line 2", "'7'"});
    expect_error("OFF\n4000000000 1 0\n0 0 0\n", "t", format, {"line 2", "4000000000", "truncated"});
    expect_error("OFF\n99999999999999999999 1 0\n0 0 0\n", "t", format, {"line 2"});
    expect_error("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n", "t", format, {"line 6", "truncated"});
    expect_error("OFF\n3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n", "t", format, {"line 4", "vertex 1"});
    expect_error("OFF\n3 1 0\n0 0 0\n1 0 x\n0 1 0\n3 0 1 2\n", "t", format, {"line 4", "vertex 1", "'x'"});
    expect_error("OFF\n3 1 0\n0 0 0\n1 0 1.2.3\n0 1 0\n3 0 1 2\n", "t", format, {"line 4", "1.2.3"});
    expect_error("OFF\n3 1 0\n0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n", "t", invalid, {"line 4", "vertex 1", "NaN"});
    expect_error("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 -inf\n3 0 1 2\n", "t", invalid, {"line 5", "vertex 2"});
    expect_error("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 1e999\n3 0 1 2\n", "t", invalid, {"line 5", "vertex 2"});
    expect_error("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "t", invalid,
                 {"line 6", "face 0", "vertex 3", "3 vert"});
    expect_error("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 -1 2\n", "t", invalid, {"line 6", "face 0", "vertex -1"});
    expect_error("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n", "t", format, {"line 6", "face 0", "end of the line"});
    expect_error("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1.5 2\n", "t", format, {"line 6", "face 0", "1.5"});
    expect_error("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n", "t", format, {"line 6", "face 0", "2 corners"});
    expect_error("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n-3 0 1 2\n", "t", format, {"line 6", "face 0"});
    expect_error("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n999999999999 0 1 2\n", "t", format, {"line 6", "face 0"});
    expect_error("OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n", "t", ErrorCode::empty_mesh, {"3 vertices", "no face"});
    expect_error("OFF\n0 0 0\n", "t", ErrorCode::empty_mesh, {"no face"});
}

TEST(Off, KeepsRepeatedIndices) {
    EXPECT_EQ(parse("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 1\n", "t").triangles, (Triangles{0, 1, 1}));
}

TEST(Off, MeshesOfManyBlocksKeepTheirOrderAndLineNumbers) {
    const Mesh mesh = grid(200);
    std::string text =
        "OFF\n" + std::to_string(mesh.positions.size() / 3) + " " + std::to_string(mesh.file_faces) + " 0\n";
    for (std::size_t i = 0; i < mesh.positions.size(); i += 3) {
        text += std::to_string(mesh.positions[i]) + " " + std::to_string(mesh.positions[i + 1]) + " " +
                std::to_string(mesh.positions[i + 2]) + "\n";
    }
    for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
        text += "3 " + std::to_string(mesh.triangles[i]) + " " + std::to_string(mesh.triangles[i + 1]) + " " +
                std::to_string(mesh.triangles[i + 2]) + "\n";
    }
    ASSERT_GT(text.size(), 1u << 20U);
    const Mesh read = parse(text, "t");
    EXPECT_EQ(read.positions, mesh.positions);
    EXPECT_EQ(read.triangles, mesh.triangles);
    // The last face and one in the middle are damaged: the first of the two is reported.
    std::string damaged = text.substr(0, text.size() - 2) + "x\n";
    expect_error(
        damaged, "t", ErrorCode::file_format,
        {"line " + std::to_string(2 + 40000 + mesh.file_faces) + ":", "face " + std::to_string(mesh.file_faces - 1)});
    std::size_t at = 0;
    for (int line = 0; line < 30000; ++line) at = text.find('\n', at) + 1;
    damaged[at] = 'y';
    expect_error(damaged, "t", ErrorCode::file_format, {"line 30001:", "vertex 29998"});
}

}  // namespace
}  // namespace quadseg::test
