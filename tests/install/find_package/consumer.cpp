// A stranger's program: a tetrahedron has four planes.
#include <quadseg/error.h>
#include <quadseg/io.h>
#include <quadseg/segmentation.h>

#include <array>
#include <cstdio>

int main() {
    const std::array<double, 12> positions{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    const std::array<std::uint32_t, 12> triangles{0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
    quadseg::Options options;
    options.regions = 4;
    const auto result = quadseg::segment({positions, triangles}, options);
    std::printf("%zu regions\n", result.regions.size());
    try {
        quadseg::read_mesh("no such file.obj");
    } catch (const quadseg::Error& error) {
        return result.labels.size() == 4 && error.code() == quadseg::ErrorCode::file_open ? 0 : 1;
    }
    return 1;
}
