#include "io_support.h"

namespace quadseg::test {
namespace {

using Triangles = std::vector<std::uint32_t>;
const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST(Obj, AllFormsOfCorners) {
    for (const char* face : {"f 1 2 3\n", "f 1/1 2/2 3/3\n", "f 1//1 2//2 3//3\n", "f 1/1/1 2/2/2 3/3/3\n",
                             "f 1/ 2/ 3/\n", "f 1/-1/-1 2/-1/-1 3/-1/-1", "f -4 -3 -2", "fo 1 2 3", "\tf\t1\t2\t3 # c",
                             "f 1 \\\n2 \\\r\n 3\n", "f +1 2 3\r\n"}) {
        EXPECT_EQ(parse(square + face, "t.obj").triangles, (Triangles{0, 1, 2})) << face;
    }
}

TEST(Obj, SkipsEverythingElse) {
    const Mesh mesh = parse("# c\nmtllib a.mtl\no part\ng a b c\ns off\nusemtl red\nvt 0 0\nvn 0 0 1\nvp 1\n" + square +
                                "l 1 2\np 1\nf 1 2 3\ng\nvendor_thing 7 x/y\n\n   \nf 1 3 4\n",
                            "t.obj");
    EXPECT_EQ(mesh.triangles, (Triangles{0, 1, 2, 0, 2, 3}));
    EXPECT_EQ(mesh.positions.size(), 12u);
}

TEST(Obj, VerticesMayCarryWeightOrColour) {
    EXPECT_EQ(parse("v 1 2 3 1\nv 4 5 6 .1 .2 .3\nv 7 8 \\\n9\nf 1 2 3", "t.obj").positions,
              (std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8, 9}));
}

TEST(Obj, NegativeIndicesCountFromTheVerticesSoFar) {
    const Mesh mesh =
        parse("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 0 0\nv 6 0 0\nv 5 1 0\nf -3 -2 -1\nf -6 5 -1\n", "t.obj");
    EXPECT_EQ(mesh.triangles, (Triangles{0, 1, 2, 3, 4, 5, 0, 4, 5}));
}

TEST(Obj, FacesMayStandBeforeTheirVertices) {
    EXPECT_EQ(parse("f 1 2 3\n" + square, "t.obj").triangles, (Triangles{0, 1, 2}));
}

TEST(Obj, PolygonsBecomeTriangles) {
    const Mesh mesh = parse(square + "f 1 2 3\nf 1 2 3 4\nf 2 3 4\n", "t.obj");
    EXPECT_EQ(mesh.triangles, (Triangles{0, 1, 2, 0, 1, 2, 0, 2, 3, 1, 2, 3}));
    EXPECT_EQ(mesh.polygons, (Triangles{0, 1, 1, 2}));
    EXPECT_EQ(mesh.file_faces, 3u);
}

TEST(Obj, IsRecognisedByContents) {
    EXPECT_EQ(parse("# x\n" + square + "f 1 2 3", "noname").triangles, (Triangles{0, 1, 2}));
}

TEST(Obj, NamesLineOfEveryFault) {
    const auto format = ErrorCode::file_format;
    const auto invalid = ErrorCode::invalid_mesh;
    expect_error(square + "f 1 2\n", "t.obj", format, {"line 5", "2 corners", "at least 3"});
    expect_error(square + "f\n", "t.obj", format, {"line 5", "0 corners"});
    expect_error(square + "f 1 2 x\n", "t.obj", format, {"line 5", "'x'"});
    expect_error(square + "f 1 2 3/a\n", "t.obj", format, {"line 5", "3/a"});
    expect_error(square + "f 1 2 3/1/1/1\n", "t.obj", format, {"line 5", "3/1/1/1"});
    expect_error(square + "f 1 2 3.5\n", "t.obj", format, {"line 5", "3.5"});
    expect_error(square + "f 0 1 2\n", "t.obj", invalid, {"line 5", "vertex 0", "from 1"});
    expect_error(square + "f 1 2 3\n\nf 1 2 5\n", "t.obj", invalid, {"line 7", "face 1", "vertex 5", "4 vertices"});
    expect_error(square + "f 1 2 3 4\nf 1 2 3\nf 2 1 3 99\n", "t.obj", invalid, {"line 7", "face 2", "vertex 99"});
    expect_error(square + "f 1 2 99999999999\n", "t.obj", invalid, {"line 5", "face 0"});
    expect_error(square + "f 1 2 999999999999999999999\n", "t.obj", format, {"line 5"});
    expect_error(square + "f 1 2 3\nf -5 -1 -2\n", "t.obj", invalid, {"line 6", "face 1"});
    expect_error("f -1 -2 -3\nf 1 2 3\n", "t.obj", invalid, {"line 1", "face 0"});
    expect_error("v 0 0\n", "t.obj", format, {"line 1", "three coordinates"});
    expect_error(square + "v 0 a 0\n", "t.obj", format, {"line 5", "'a'"});
    expect_error(square + "v 0 nan 0\n", "t.obj", invalid, {"line 5", "vertex 4", "NaN"});
    expect_error(square + "v 0 0 1e400\n", "t.obj", invalid, {"line 5", "vertex 4"});
    expect_error(square + "f 1 2 3\n%garbage\n", "t.obj", format, {"line 6", "%garbage"});
    expect_error(square, "t.obj", ErrorCode::empty_mesh, {"4 vertices", "no face"});
    expect_error("# nothing\n", "t.obj", ErrorCode::empty_mesh, {"no face"});
    expect_error(square + std::string("\0\1\2", 3), "t.obj", format, {"line 5"});
}

TEST(Obj, RelativeIndicesAcrossBlocks) {
    // Each strip of three vertices is followed by its face; far more than one block.
    constexpr std::size_t faces = 40000;
    std::string text;
    for (std::size_t f = 0; f < faces; ++f) {
        text += "v " + std::to_string(f) + " 0 0\nv 0 " + std::to_string(f) + " 1\nv 1 1 " + std::to_string(f) +
                "\nf -3 -2 -1\n";
        if (f > 0) text += "f " + std::to_string(3 * f) + " -4 -1\n";
    }
    ASSERT_GT(text.size(), 1u << 20U);
    const Mesh mesh = parse(text, "t.obj");
    ASSERT_EQ(mesh.triangles.size(), 3 * (2 * faces - 1));
    for (std::uint32_t f = 1; f < faces; ++f) {
        const std::uint32_t* t = &mesh.triangles[3 * (2 * f - 1)];
        ASSERT_TRUE(t[0] == 3 * f && t[1] == 3 * f + 1 && t[2] == 3 * f + 2) << f;
        ASSERT_TRUE(t[3] == 3 * f - 1 && t[4] == 3 * f - 1 && t[5] == 3 * f + 2) << f;
        ASSERT_EQ(mesh.positions[9 * f], f);
    }
    expect_error(text + "f 1 2 -200000\n", "t.obj", ErrorCode::invalid_mesh,
                 {"line " + std::to_string(5 * faces) + ":", "face " + std::to_string(2 * faces - 1)});
}

TEST(Obj, ContinuedLinesAreNotCut) {
    // One polygon over many lines, as long as several blocks.
    constexpr std::size_t corners = 100000;
    std::string text;
    for (std::size_t v = 0; v < corners; ++v) text += "v " + std::to_string(v) + " " + std::to_string(v * v) + " 0\n";
    text += "f";
    for (std::size_t v = 1; v <= corners; ++v) text.append(" ").append(std::to_string(v)).append(" \\\n");
    text += "\nf 1 2 3\n";
    const Mesh mesh = parse(text, "t.obj");
    EXPECT_EQ(mesh.file_faces, 2u);
    EXPECT_EQ(mesh.triangles.size(), 3 * (corners - 2 + 1));
    EXPECT_EQ(mesh.polygons.back(), 1u);
}

}  // namespace
}  // namespace quadseg::test
