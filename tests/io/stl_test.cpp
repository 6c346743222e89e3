#include "io_support.h"

#include <array>
#include <cmath>
#include <limits>
#include <map>

namespace quadseg::test {
namespace {

using Triangles = std::vector<std::uint32_t>;

std::string facet(const std::string& a, const std::string& b, const std::string& c) {
    return "facet normal 0 0 1\n outer loop\n  vertex " + a + "\n  vertex " + b + "\n  vertex " + c +
           "\n endloop\nendfacet\n";
}

std::string binary(const std::vector<std::array<float, 9>>& facets, const std::string& title = "title") {
    std::string out = title;
    out.resize(80, '\0');
    append_bytes(out, static_cast<std::uint32_t>(facets.size()));
    for (const auto& f : facets) {
        for (int k = 0; k < 3; ++k) append_bytes(out, 0.f);
        for (const float x : f) append_bytes(out, x);
        append_bytes(out, std::uint16_t{0xFFFF});
    }
    return out;
}

TEST(Stl, AsciiOfSeveralSolidsIsWelded) {
    const Mesh mesh = parse("solid facet one\n" + facet("0 0 0", "1 0 0", "0 1 0") + "endsolid facet one\n\nSOLID\n" +
                                facet("1 0 -0.0", "1 1 0", "0 1 0") + "ENDSOLID",
                            "t.stl");
    EXPECT_EQ(mesh.triangles, (Triangles{0, 1, 2, 1, 3, 2}));
    EXPECT_EQ(mesh.positions, (std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}));
    EXPECT_EQ(mesh.welded_vertices, 2u);
    EXPECT_EQ(mesh.file_faces, 2u);
}

TEST(Stl, NormalsMayBeAnything) {
    EXPECT_EQ(
        parse("solid\nFACET NORMAL nan -1.#IND 1e999\nOUTER LOOP\nVERTEX 0 0 0\nvertex 1 0 0 vertex 0 1 0\nendloop "
              "endfacet endsolid x",
              "t")
            .triangles,
        (Triangles{0, 1, 2}));
}

TEST(Stl, BinaryIsWelded) {
    const std::vector<std::array<float, 9>> facets{{0, 0, 0, 1, 0, 0, 0, 1, 0}, {-0.f, 1, -0.f, 1, 0, -0.f, 1, 1, 0}};
    for (const char* title : {"title", "solid that is binary", "OFF", "v 1 2 3"}) {
        const Mesh mesh = parse(binary(facets, title), "t.stl");
        EXPECT_EQ(mesh.triangles, (Triangles{0, 1, 2, 2, 1, 3})) << title;
        EXPECT_EQ(mesh.positions, (std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0})) << title;
        EXPECT_EQ(mesh.welded_vertices, 2u);
    }
    EXPECT_EQ(parse(binary(facets) + "pad", "t.stl").triangles.size(), 6u);
}

TEST(Stl, NearlyEqualCornersStayApart) {
    const float next = std::nextafter(1.f, 2.f);
    const Mesh mesh = parse(binary({{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 0, next, 0, 0, 1, 1, 0}}), "t.stl");
    EXPECT_EQ(mesh.positions.size(), 15u);
}

TEST(Stl, WeldingOfManyCornersNumbersByFirstOccurrence) {
    const Mesh mesh = grid(150);
    std::vector<std::array<float, 9>> facets;
    for (std::size_t f = 0; f < mesh.file_faces; ++f) {
        std::array<float, 9> corners{};
        for (std::size_t k = 0; k < 9; ++k) {
            corners[k] = static_cast<float>(mesh.positions[3 * mesh.triangles[3 * f + k / 3] + k % 3]);
        }
        facets.push_back(corners);
    }
    const Mesh read = parse(binary(facets), "t.stl");
    std::map<std::array<double, 3>, std::uint32_t> numbers;
    for (std::size_t c = 0; c < mesh.triangles.size(); ++c) {
        const double* x = &mesh.positions[3 * mesh.triangles[c]];
        const auto number = static_cast<std::uint32_t>(numbers.size());
        const auto known = numbers.insert({{x[0], x[1], x[2]}, number}).first->second;
        ASSERT_EQ(read.triangles[c], known) << c;
    }
    EXPECT_EQ(read.positions.size(), mesh.positions.size());
    EXPECT_EQ(read.welded_vertices, mesh.triangles.size() - mesh.positions.size() / 3);
}

TEST(Stl, AsciiOfManyBlocksAgreesWithBinary) {
    std::vector<std::array<float, 9>> facets;
    std::string text = "solid a\n";
    for (int f = 0; f < 12000; ++f) {
        const auto x = static_cast<float>(f % 100), y = static_cast<float>(f / 100);
        facets.push_back({x, y, 0, x + 1, y, 0, x, y + 1, 0});
        const std::string a = std::to_string(f % 100), b = std::to_string(f / 100);
        const std::string a1 = std::to_string(f % 100 + 1), b1 = std::to_string(f / 100 + 1);
        text += facet(a + " " + b + " 0", a1 + " " + b + " 0", a + " " + b1 + " 0");
        if (f % 3000 == 2999) text += "endsolid\nsolid b\n";
    }
    ASSERT_GT(text.size(), 1u << 20U);
    const Mesh ascii = parse(text + "endsolid", "t"), exact = parse(binary(facets), "t.stl");
    EXPECT_EQ(ascii.triangles, exact.triangles);
    EXPECT_EQ(ascii.positions, exact.positions);
    expect_error(text, "t", ErrorCode::file_format, {"line 84010:", "endsolid", "truncated"});
    std::string damaged = text + "endsolid";
    damaged.replace(damaged.rfind("vertex"), 6, "vortex");
    expect_error(damaged, "t", ErrorCode::file_format, {"'vertex'", "'vortex'", "line "});
}

TEST(Stl, NamesLineOrByteOfEveryFault) {
    const auto format = ErrorCode::file_format;
    const auto invalid = ErrorCode::invalid_mesh;
    const std::string good = facet("0 0 0", "1 0 0", "0 1 0");
    expect_error("solid\n" + facet("0 0 0", "1 0", "0 1 0") + "endsolid", "t", format,
                 {"line 6", "coordinate", "'vertex'"});
    expect_error("solid\n" + good + facet("0 0 0", "1 nan 0", "0 1 0") + "endsolid", "t", invalid,
                 {"line 12", "face 1", "vertex 1", "NaN"});
    expect_error("solid\n" + good, "t", format, {"line 9", "endsolid", "truncated"});
    expect_error("solid\n" + good.substr(0, 60), "t", format, {"truncated"});
    expect_error("solid\n" + good + "endsolid\n" + good, "t", format, {"line 10", "'solid'", "'facet'"});
    expect_error("solid\nhello\nendsolid", "t", format, {"line 2", "'facet'", "'hello'"});
    expect_error("solid\nendsolid", "t", ErrorCode::empty_mesh, {"no face"});
    const std::string file = binary({{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 0, 1, 0, 0, 1, 1, 0}});
    expect_error(file.substr(0, 83), "t.stl", format, {"byte 83", "84 bytes", "truncated"});
    expect_error(file.substr(0, 150), "t.stl", format, {"byte 150", "2 facets", "after 1"});
    expect_error(file + std::string(50, 'x'), "t.stl", format, {"byte 80", "2 facets", "room for 3"});
    expect_error(binary({{0, 0, 0, 1, 0, 0, 0, 1, std::numeric_limits<float>::infinity()}}), "t.stl", invalid,
                 {"byte 120", "vertex 2", "face 0"});
    expect_error(binary({}), "t.stl", ErrorCode::empty_mesh, {"no face"});
    // A truncated binary file that calls itself solid is still told from text.
    expect_error(binary({{0, 0, 0, 1, 0, 0, 0, 1, 0}}, "solid x").substr(0, 120), "t.stl", format, {"byte 120"});
}

}  // namespace
}  // namespace quadseg::test
