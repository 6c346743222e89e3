#include "io_support.h"

#include <limits>

namespace quadseg::test {
namespace {

using Triangles = std::vector<std::uint32_t>;

/// A PLY of one triangle and more, in the layout that the caller asks for.
std::string ascii(const std::string& vertex_properties, const std::string& face_properties, const std::string& body,
                  int vertices = 3, int faces = 1) {
    return "ply\nformat ascii 1.0\ncomment x\nelement vertex " + std::to_string(vertices) + "\n" + vertex_properties +
           "element face " + std::to_string(faces) + "\n" + face_properties + "end_header\n" + body;
}
const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
const std::string corners = "property list uchar int vertex_indices\n";
const std::string triangle = "0 0 0\n1 0 0\n0 1 0\n";

TEST(Ply, Ascii) {
    const Mesh mesh = parse(ascii(xyz, corners, triangle + "3 0 1 2\n"), "t.ply");
    EXPECT_EQ(mesh.positions, (std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0}));
    EXPECT_EQ(mesh.triangles, (Triangles{0, 1, 2}));
    EXPECT_EQ(mesh.file_faces, 1u);
}

TEST(Ply, AsciiOfAnyLayout) {
    const Mesh mesh = parse(
        "ply\r\nformat ascii 1.0\r\nobj_info made by hand\r\nelement camera 1\r\nproperty float f\r\n"
        "element face 2\r\nproperty uchar red\r\nproperty list ushort uint vertex_index\r\nproperty list int float "
        "t\r\n"
        "element edge 0\r\nproperty int a\r\nelement vertex 4\r\nproperty list uchar int tags\r\nproperty double z\r\n"
        "property int x\r\nproperty int flags\r\nproperty float32 y\r\nelement nothing 3\r\nend_header\r\n"
        "7.5\r\n255 3 0 1 2 0\r\n1 4 0 1 2 3 2 .5 .5\r\n"
        "0 9 0 1 0\r\n2 5 5 9 1 1 0\r\n1 5 9 1 1 1\r\n0 9 0 1 1\r\n",
        "t.ply");
    EXPECT_EQ(mesh.positions, (std::vector<double>{0, 0, 9, 1, 0, 9, 1, 1, 9, 0, 1, 9}));
    EXPECT_EQ(mesh.triangles, (Triangles{0, 1, 2, 0, 1, 2, 0, 2, 3}));
    EXPECT_EQ(mesh.polygons, (Triangles{0, 1, 1}));
    EXPECT_EQ(mesh.file_faces, 2u);
}

TEST(Ply, NamesLineOfEveryFault) {
    const auto format = ErrorCode::file_format;
    const auto invalid = ErrorCode::invalid_mesh;
    const std::string start = "ply\nformat ascii 1.0\n";
    expect_error("plx\n", "t.ply", format, {"line 1", "'ply'", "'plx'"});
    expect_error("ply\nhello\n", "t.ply", format, {"line 2", "format", "'hello'"});
    expect_error("ply\nformat binary 1.0\n", "t.ply", format, {"line 2", "'binary'"});
    expect_error("ply\nformat ascii 2.0\n", "t.ply", format, {"line 2", "'2.0'"});
    expect_error(start, "t.ply", format, {"line 3", "truncated"});
    expect_error(start + "elephant vertex 3\n", "t.ply", format, {"line 3", "'elephant'"});
    expect_error(start + "element vertex -3\n", "t.ply", format, {"line 3", "'-3'"});
    expect_error(start + "element vertex\n", "t.ply", format, {"line 3", "number of elements"});
    expect_error(start + "property int x\n", "t.ply", format, {"line 3", "before the first element"});
    expect_error(start + "element vertex 3\nproperty real x\n", "t.ply", format, {"line 4", "'real'"});
    expect_error(start + "element vertex 3\nproperty float x\nproperty float x\n", "t.ply", format,
                 {"line 5", "'x'", "second time"});
    expect_error(start + "element vertex 3\nelement vertex 3\n", "t.ply", format, {"line 4", "second time"});
    expect_error(start + "element vertex 3\nproperty list float int x\n", "t.ply", format, {"line 4", "'float'"});
    expect_error(start + "element tristrips 1\n", "t.ply", format, {"line 3", "strips", "convert"});
    expect_error(start + "element vertex 3\n" + xyz + "end_header\n" + triangle, "t.ply", format, {"point cloud"});
    expect_error(start + "element face 3\n" + corners + "end_header\n", "t.ply", format, {"'vertex'"});
    expect_error(ascii("property float x\nproperty float y\n", corners, triangle), "t.ply", format, {"'z'"});
    expect_error(ascii(xyz, "property list uchar int other\n", triangle), "t.ply", format, {"vertex_indices"});
    expect_error(ascii(xyz, corners, triangle, 1000000000), "t.ply", format, {"1000000000", "'vertex'", "truncated"});
    expect_error(ascii(xyz, corners, triangle + "3 0 1 2\n", 3, 2), "t.ply", format, {"truncated"});
    expect_error(ascii(xyz, corners, "0 0 0\n1 0\n0 1 0\n3 0 1 2\n"), "t.ply", format, {"line 12", "vertex 1", "'z'"});
    expect_error(ascii(xyz, corners, "0 0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"), "t.ply", format, {"line 11", "vertex 0"});
    expect_error(ascii(xyz, corners, "0 0 0\n1 0 nan\n0 1 0\n3 0 1 2\n"), "t.ply", invalid, {"line 12", "vertex 1"});
    expect_error(ascii(xyz, corners, triangle + "3 0 1 3\n"), "t.ply", invalid, {"line 14", "face 0", "vertex 3"});
    expect_error(ascii(xyz, corners, triangle + "3 0 1 -1\n"), "t.ply", invalid, {"line 14", "face 0", "vertex -1"});
    expect_error(ascii(xyz, corners, triangle + "2 0 1\n"), "t.ply", format, {"line 14", "face 0", "2 corners"});
    expect_error(ascii(xyz, corners, triangle + "0     \n"), "t.ply", format, {"line 14", "face 0", "0 corners"});
    expect_error(ascii(xyz, corners, triangle + "4 0 1 2\n"), "t.ply", format,
                 {"line 14", "face 0", "end of the line"});
    expect_error(ascii(xyz, corners, triangle + "3 0 x 2\n"), "t.ply", format, {"line 14", "face 0", "'x'"});
    expect_error(ascii(xyz, corners, triangle, 3, 0), "t.ply", ErrorCode::empty_mesh, {"no face"});
}

template <class Count, class Index, class Real>
std::string binary(bool big_endian, const std::string& types, bool polygon, bool extras) {
    // types: count, index, real
    const std::string count = types.substr(0, types.find(' '));
    const std::string index = types.substr(count.size() + 1, types.rfind(' ') - count.size() - 1);
    const std::string real = types.substr(types.rfind(' ') + 1);
    std::string out = "ply\nformat binary_" + std::string(big_endian ? "big" : "little") + "_endian 1.0\n";
    if (extras) out += "element junk 2\nproperty list uchar double a\nproperty short b\n";
    out += "element vertex 4\nproperty " + real + " y\n";
    if (extras) out += "property uchar red\n";
    out += "property " + real + " x\nproperty " + real + " z\n";
    out += "element face 2\n";
    if (extras) out += "property short flags\n";
    out += "property list " + count + " " + index + " vertex_indices\n";
    if (extras) out += "property double area\nelement more 1\nproperty int64 c\n";
    out += "end_header\n";
    const auto put = [&](auto value) { append_bytes(out, value, big_endian); };
    if (extras) {
        put(std::uint8_t{2}), put(1.5), put(2.5), put(std::int16_t{7});
        put(std::uint8_t{0}), put(std::int16_t{-7});
    }
    const double points[4][3] = {{0, 0, 5}, {1, 0, 5}, {1, 1, 5}, {0, 1, 5}};
    for (const auto& p : points) {
        put(static_cast<Real>(p[1]));
        if (extras) put(std::uint8_t{200});
        put(static_cast<Real>(p[0])), put(static_cast<Real>(p[2]));
    }
    const std::vector<std::vector<int>> faces = polygon ? std::vector<std::vector<int>>{{0, 1, 2, 3}, {2, 1, 0}}
                                                        : std::vector<std::vector<int>>{{0, 1, 2}, {0, 2, 3}};
    for (const auto& face : faces) {
        if (extras) put(std::int16_t{1});
        put(static_cast<Count>(face.size()));
        for (const int v : face) put(static_cast<Index>(v));
        if (extras) put(0.5);
    }
    if (extras) put(std::int64_t{-1});
    return out;
}

void expect_square(const std::string& bytes, bool polygon) {
    const Mesh mesh = parse(bytes, "t.ply");
    EXPECT_EQ(mesh.positions, (std::vector<double>{0, 0, 5, 1, 0, 5, 1, 1, 5, 0, 1, 5}));
    EXPECT_EQ(mesh.file_faces, 2u);
    if (polygon) {
        EXPECT_EQ(mesh.triangles, (Triangles{0, 1, 2, 0, 2, 3, 2, 1, 0}));
        EXPECT_EQ(mesh.polygons, (Triangles{0, 0, 1}));
    } else {
        EXPECT_EQ(mesh.triangles, (Triangles{0, 1, 2, 0, 2, 3}));
        EXPECT_TRUE(mesh.polygons.empty());
    }
}

TEST(Ply, BinaryOfBothEndiansAndAllTypes) {
    for (int k = 0; k < 8; ++k) {
        const bool big = (k & 1) != 0, polygon = (k & 2) != 0, extras = (k & 4) != 0;
        SCOPED_TRACE(k);
        expect_square(binary<std::uint8_t, std::int32_t, float>(big, "uchar int float", polygon, extras), polygon);
        expect_square(binary<std::int32_t, std::uint32_t, double>(big, "int uint double", polygon, extras), polygon);
        expect_square(binary<std::uint16_t, std::uint8_t, std::int16_t>(big, "uint16 uint8 int16", polygon, extras),
                      polygon);
        expect_square(binary<std::int8_t, std::int16_t, std::int32_t>(big, "int8 short int32", polygon, extras),
                      polygon);
        expect_square(binary<std::int64_t, std::int64_t, float>(big, "int64 int64 float32", polygon, extras), polygon);
        expect_square(binary<std::uint64_t, std::uint64_t, std::int8_t>(big, "uint64 uint64 char", polygon, extras),
                      polygon);
        expect_square(binary<std::int16_t, std::uint16_t, std::uint64_t>(big, "short ushort uint64", polygon, extras),
                      polygon);
        expect_square(binary<std::uint32_t, std::int8_t, std::uint16_t>(big, "uint char ushort", polygon, extras),
                      polygon);
    }
}

/// Binary little-endian with these vertices and faces.
std::string little(const std::vector<float>& positions, const std::vector<std::vector<std::int32_t>>& faces) {
    std::string out = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(positions.size() / 3) +
                      "\n" + xyz + "element face " + std::to_string(faces.size()) + "\n" + corners + "end_header\n";
    for (const float x : positions) append_bytes(out, x);
    for (const auto& face : faces) {
        append_bytes(out, static_cast<std::uint8_t>(face.size()));
        for (const std::int32_t v : face) append_bytes(out, v);
    }
    return out;
}

TEST(Ply, NamesByteOfEveryFault) {
    const std::vector<float> p{0, 0, 0, 1, 0, 0, 0, 1, 0};
    const std::string good = little(p, {{0, 1, 2}, {2, 1, 0}});
    const std::size_t body = good.size() - 36 - 26;
    const auto at = [&](std::size_t byte) { return "byte " + std::to_string(body + byte) + ":"; };
    EXPECT_EQ(parse(good, "t").triangles.size(), 6u);
    expect_error(little(p, {{0, 1, 2}, {0, 3, 1}}), "t", ErrorCode::invalid_mesh,
                 {at(36 + 13 + 5), "face 1", "vertex 3", "3 vertices"});
    expect_error(little(p, {{0, 1, -2}, {0, 3, 1}}), "t", ErrorCode::invalid_mesh, {at(36 + 9), "face 0", "vertex -2"});
    expect_error(little(p, {{0, 1, 2, 0}, {0, 3, 1}}), "t", ErrorCode::invalid_mesh,
                 {at(36 + 17 + 5), "face 1", "vertex 3"});
    expect_error(little(p, {{0, 1, 2}, {0, 1}}), "t", ErrorCode::file_format, {"byte", "face 1"});
    expect_error(little(p, {{0, 1, 2, 1}, {0, 1}}), "t", ErrorCode::file_format,
                 {at(36 + 17 + 1), "face 1", "2 corners"});
    std::vector<float> bad = p;
    bad[4] = std::numeric_limits<float>::quiet_NaN();
    expect_error(little(bad, {{0, 1, 2}}), "t", ErrorCode::invalid_mesh, {at(12), "vertex 1", "NaN"});
    bad[4] = -std::numeric_limits<float>::infinity();
    expect_error(little(bad, {{0, 1, 2}}), "t", ErrorCode::invalid_mesh, {at(12), "vertex 1"});
    expect_error(good.substr(0, good.size() - 1), "t", ErrorCode::file_format, {"byte", "face 1", "truncated"});
    expect_error(good.substr(0, body + 30), "t", ErrorCode::file_format, {"'vertex'", "truncated"});
    std::string huge = good;
    huge[body + 36] = char(-1);
    expect_error(huge, "t", ErrorCode::file_format, {at(36), "face 0", "truncated"});
}

TEST(Ply, ManyBlocksOfTrianglesAndOfPolygons) {
    const Mesh mesh = grid(200);
    std::vector<float> positions(mesh.positions.begin(), mesh.positions.end());
    std::vector<std::vector<std::int32_t>> faces;
    for (std::size_t f = 0; f < mesh.file_faces; ++f) {
        const std::uint32_t* t = &mesh.triangles[3 * f];
        faces.push_back({std::int32_t(t[0]), std::int32_t(t[1]), std::int32_t(t[2])});
    }
    const Mesh read = parse(little(positions, faces), "t");
    EXPECT_EQ(read.positions, mesh.positions);
    EXPECT_EQ(read.triangles, mesh.triangles);
    faces[70000].push_back(std::int32_t(mesh.triangles[3 * 70000]));
    const Mesh mixed = parse(little(positions, faces), "t");
    ASSERT_EQ(mixed.triangles.size(), mesh.triangles.size() + 3);
    ASSERT_EQ(mixed.polygons.size(), mesh.file_faces + 1);
    EXPECT_TRUE(std::equal(mesh.triangles.begin(), mesh.triangles.begin() + 3 * 70000, mixed.triangles.begin()));
    EXPECT_TRUE(
        std::equal(mesh.triangles.begin() + 3 * 70001, mesh.triangles.end(), mixed.triangles.begin() + 3 * 70002));
    EXPECT_EQ(mixed.polygons[69999], 69999u);
    EXPECT_EQ(mixed.polygons[70000], 70000u);
    EXPECT_EQ(mixed.polygons[70001], 70000u);
    EXPECT_EQ(mixed.polygons[70002], 70001u);
    faces[79000][1] = 40000;
    expect_error(little(positions, faces), "t", ErrorCode::invalid_mesh, {"face 79000", "vertex 40000"});
}

}  // namespace
}  // namespace quadseg::test
