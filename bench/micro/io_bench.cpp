// Readers and writers: bytes a second of the file, from the page cache. Argument: threads.
#include <quadseg/context.h>
#include <quadseg/io.h>

#include "bench/micro/machine.h"

#include <benchmark/benchmark.h>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace {

using quadseg::Mesh;

constexpr std::uint32_t side = 709;  // a million faces

/// A wavy grid. Coordinates have six decimals, as most text files do; rounded to float they make small binary files.
Mesh wavy_grid(bool floats) {
    Mesh mesh;
    for (std::uint32_t j = 0; j < side; ++j) {
        for (std::uint32_t i = 0; i < side; ++i) {
            const double position[3] = {i * 0.013, j * 0.017, std::sin(i * 0.05) * std::cos(j * 0.03)};
            for (const double x : position) {
                const double rounded = std::round(x * 1e6) / 1e6;
                mesh.positions.push_back(floats ? static_cast<double>(static_cast<float>(x)) : rounded);
            }
        }
    }
    for (std::uint32_t j = 0; j + 1 < side; ++j) {
        for (std::uint32_t i = 0; i + 1 < side; ++i) {
            const std::uint32_t v = j * side + i;
            for (const std::uint32_t corner : {v, v + 1, v + side + 1, v, v + side + 1, v + side}) {
                mesh.triangles.push_back(corner);
            }
        }
    }
    return mesh;
}

class Folder {
  public:
    Folder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "quadseg-bench-XXXXXX").string();
        path_ = ::mkdtemp(pattern.data()) != nullptr ? pattern : std::string(".");
    }
    ~Folder() {
        std::error_code ignored;
        if (path_ != ".") std::filesystem::remove_all(path_, ignored);
    }
    std::string file(const std::string& name) const { return (path_ / name).string(); }

  private:
    std::filesystem::path path_;
};

/// The text and endian variants that the library does not write itself.
void write_variant(const std::string& path, const Mesh& mesh) {
    std::ofstream out(path, std::ios::binary);
    const std::string counts[2] = {std::to_string(mesh.positions.size() / 3),
                                   std::to_string(mesh.triangles.size() / 3)};
    const auto position = [&](std::size_t v) {
        char text[96];
        std::snprintf(text, sizeof text, "%.6g %.6g %.6g\n", mesh.positions[3 * v], mesh.positions[3 * v + 1],
                      mesh.positions[3 * v + 2]);
        return std::string(text);
    };
    if (path.ends_with(".ascii.stl")) {
        out << "solid bench\n";
        for (std::size_t f = 0; f < mesh.triangles.size(); f += 3) {
            out << " facet normal 0.000000e+00 0.000000e+00 1.000000e+00\n  outer loop\n";
            for (std::size_t k = 0; k < 3; ++k) out << "   vertex " << position(mesh.triangles[f + k]);
            out << "  endloop\n endfacet\n";
        }
        out << "endsolid bench\n";
        return;
    }
    out << "ply\nformat " << (path.ends_with(".big.ply") ? "binary_big_endian" : "ascii") << " 1.0\nelement vertex "
        << counts[0] << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << counts[1]
        << "\nproperty list uchar int vertex_indices\nend_header\n";
    if (path.ends_with(".ascii.ply")) {
        for (std::size_t v = 0; v < mesh.positions.size() / 3; ++v) out << position(v);
        for (std::size_t f = 0; f < mesh.triangles.size(); f += 3) {
            out << "3 " << mesh.triangles[f] << ' ' << mesh.triangles[f + 1] << ' ' << mesh.triangles[f + 2] << '\n';
        }
        return;
    }
    const auto put = [&](std::uint32_t bits) {
        const std::uint32_t reversed = __builtin_bswap32(bits);
        out.write(reinterpret_cast<const char*>(&reversed), 4);
    };
    for (const double x : mesh.positions) put(std::bit_cast<std::uint32_t>(static_cast<float>(x)));
    for (std::size_t c = 0; c < mesh.triangles.size(); ++c) {
        if (c % 3 == 0) out.put(3);
        put(mesh.triangles[c]);
    }
}

/// Parsing has no floating-point operations to count. Bytes of the file, and of the arrays in memory on the other side,
/// a face; 12 + 12 of positions and indices.
void per_face(benchmark::State& state, const std::string& path) {
    constexpr double faces = 2.0 * (side - 1) * (side - 1);
    const auto size = static_cast<double>(std::filesystem::file_size(path));
    state.SetBytesProcessed(static_cast<std::int64_t>(static_cast<double>(state.iterations()) * size));
    quadseg::bench::report(state, faces, size / faces + 24);
}

void read(benchmark::State& state, const std::string& name) {
    const Folder folder;
    const std::string path = folder.file(name);
    {
        const Mesh mesh = wavy_grid(name == "grid.ply" || name == "grid.stl" || name == "grid.big.ply");
        if (name.find('.') != name.rfind('.')) {
            write_variant(path, mesh);
        } else {
            quadseg::write_mesh(path, mesh.view());
        }
    }
    quadseg::Context context;
    context.set_threads(static_cast<int>(state.range(0)));
    for (auto _ : state) benchmark::DoNotOptimize(quadseg::read_mesh(path, &context));
    per_face(state, path);
}

void write(benchmark::State& state, const std::string& name) {
    const Folder folder;
    const std::string path = folder.file(name);
    const Mesh mesh = wavy_grid(true);
    const std::vector<std::int32_t> labels(mesh.triangles.size() / 3, 1234);
    const std::vector<std::uint8_t> rgb(mesh.triangles.size(), 77);
    for (auto _ : state) {
        if (name == "labels.txt") {
            quadseg::write_labels(path, labels);
        } else if (name == "grid.ply") {
            quadseg::write_ply(path, mesh.view(), {labels, rgb});
        } else {
            quadseg::write_mesh(path, mesh.view());
        }
    }
    per_face(state, path);
}

#define QUADSEG_READ(label, name) \
    BENCHMARK_CAPTURE(read, label, name)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime()
QUADSEG_READ(off, "grid.off");
QUADSEG_READ(obj, "grid.obj");
QUADSEG_READ(ply_ascii, "grid.ascii.ply");
QUADSEG_READ(ply_little_endian, "grid.ply");
QUADSEG_READ(ply_big_endian, "grid.big.ply");
QUADSEG_READ(stl_ascii, "grid.ascii.stl");
QUADSEG_READ(stl_binary, "grid.stl");

#define QUADSEG_WRITE(label, name) BENCHMARK_CAPTURE(write, label, name)->Unit(benchmark::kMillisecond)->UseRealTime()
QUADSEG_WRITE(ply, "grid.ply");
QUADSEG_WRITE(obj, "grid.obj");
QUADSEG_WRITE(stl, "grid.stl");
QUADSEG_WRITE(labels, "labels.txt");

}  // namespace
