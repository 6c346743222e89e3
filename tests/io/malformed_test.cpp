// Whatever the bytes, reading ends in a mesh that is one or in an Error.
#include "io_support.h"

#include <cmath>

namespace quadseg::test {
namespace {

struct Sample {
    std::string name;
    std::string bytes;
};

std::vector<Sample> samples() {
    std::vector<Sample> all{
        {"a.off", "OFF\n# c\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 9 9 9\n4 0 1 2 3\n"},
        {"a.obj", "# c\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\nf -4 -3 \\\n-2 -1\n"},
        {"b.ply",
         "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face "
         "2\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n4 0 1 2 3\n"},
        {"a.stl",
         "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
         "facet normal 0 0 1\nouter loop\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid s\n"}};
    for (const bool big : {false, true}) {
        std::string ply = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                          "_endian 1.0\nelement vertex 4\nproperty float x\nproperty double y\nproperty float "
                          "z\nproperty list uchar short tags\nelement face 2\nproperty list uchar int "
                          "vertex_indices\nproperty uchar red\nend_header\n";
        for (int v = 0; v < 4; ++v) {
            append_bytes(ply, static_cast<float>(v % 2), big);
            append_bytes(ply, v / 2 * 1.0, big);
            append_bytes(ply, 0.f, big);
            append_bytes(ply, std::uint8_t{1});
            append_bytes(ply, std::int16_t{77}, big);
        }
        for (int f = 0; f < 2; ++f) {
            append_bytes(ply, static_cast<std::uint8_t>(3 + f));
            for (int k = 0; k < 3 + f; ++k) append_bytes(ply, k, big);
            append_bytes(ply, std::uint8_t{255});
        }
        all.push_back({"c.ply", ply});
    }
    std::string stl(80, 's');
    append_bytes(stl, std::uint32_t{2});
    for (int k = 0; k < 24; ++k) append_bytes(stl, k % 12 == 11 ? 0.f : static_cast<float>(k));
    stl.insert(84 + 48, 2, '\0');
    stl.append(2, '\0');
    all.push_back({"c.stl", stl});
    return all;
}

/// True if a mesh came back, which then must be one.
bool survives(const std::string& bytes, const std::string& name) {
    try {
        const Mesh mesh = parse(bytes, name);
        EXPECT_EQ(mesh.positions.size() % 3, 0u);
        EXPECT_EQ(mesh.triangles.size() % 3, 0u);
        EXPECT_TRUE(mesh.polygons.empty() || mesh.polygons.size() == mesh.triangles.size() / 3);
        for (const std::uint32_t v : mesh.triangles) EXPECT_LT(v, mesh.positions.size() / 3);
        for (const double x : mesh.positions) EXPECT_TRUE(std::isfinite(x));
        for (const std::uint32_t p : mesh.polygons) EXPECT_LT(p, mesh.file_faces);
        return true;
    } catch (const Error& error) {
        const std::string text = error.what();
        EXPECT_EQ(text.rfind(name + ": ", 0), 0u) << text;
        if (error.code() == ErrorCode::file_format) {
            EXPECT_TRUE(text.find(": line ") != std::string::npos || text.find(": byte ") != std::string::npos ||
                        text.find(": header: ") != std::string::npos)
                << text;
        }
        return false;
    }
}

TEST(Malformed, SamplesAreGood) {
    for (const Sample& sample : samples()) EXPECT_TRUE(survives(sample.bytes, sample.name)) << sample.name;
}

TEST(Malformed, EveryPrefixUnderEveryName) {
    for (const Sample& sample : samples()) {
        for (std::size_t size = 0; size < sample.bytes.size(); ++size) {
            SCOPED_TRACE(sample.name + " cut at " + std::to_string(size));
            for (const std::string name : {sample.name.c_str(), "x", "x.obj", "x.off", "x.ply", "x.stl"}) {
                survives(sample.bytes.substr(0, size), name);
            }
        }
    }
}

TEST(Malformed, EveryByteReplaced) {
    const std::string replacements = {'\0', '\n', '\r', ' ', '-', '9', '\\', '#', 'e', '/', '\x7f', '\xff'};
    for (const Sample& sample : samples()) {
        for (std::size_t at = 0; at < sample.bytes.size(); ++at) {
            for (const char c : replacements) {
                std::string bytes = sample.bytes;
                bytes[at] = c;
                SCOPED_TRACE(sample.name + " at " + std::to_string(at) + " byte " + std::to_string(int(c)));
                survives(bytes, sample.name);
            }
        }
    }
}

TEST(Malformed, Garbage) {
    std::uint64_t state = 1;
    const auto random = [&] {
        state += 0x9E3779B97F4A7C15U;
        std::uint64_t z = state;
        z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
        z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
        return z ^ (z >> 31U);
    };
    for (int round = 0; round < 300; ++round) {
        std::string bytes(random() % 3000 + 1, ' ');
        const bool printable = round % 2 == 0;
        for (char& c : bytes) c = static_cast<char>(printable ? 32 + random() % 95 : random() % 256);
        for (const char* name : {"g", "g.off", "g.obj", "g.ply", "g.stl"}) {
            EXPECT_FALSE(survives(bytes, name)) << name << " round " << round;
        }
        for (const char* start : {"ply\n", "OFF\n", "solid ", "v "}) survives(start + bytes, "g");
    }
}

TEST(Malformed, SaysWhatForeignFilesAre) {
    expect_error(std::string("\x1f\x8b\x08\0", 4), "m", ErrorCode::file_format, {"gzip", "unpack"});
    expect_error("PK\x03\x04zzz", "m", ErrorCode::file_format, {"ZIP"});
    expect_error("ISO-10303-21;\n", "m", ErrorCode::file_format, {"STEP"});
    expect_error("Dear Sir,\n", "m", ErrorCode::file_format, {"'Dear'"});
    expect_error("", "m.ply", ErrorCode::file_format, {"empty"});
    expect_error("\n", "m", ErrorCode::file_format, {"line 1"});
}

}  // namespace
}  // namespace quadseg::test
