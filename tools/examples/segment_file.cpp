// Segments a file with a progress callback and a time limit, and prints the surfaces that were found.
#include <quadseg/error.h>
#include <quadseg/io.h>
#include <quadseg/segmentation.h>

#include <cstdio>

int main(int argc, char** argv) {
    if (argc != 2) return std::fprintf(stderr, "usage: segment_file MESH\n"), 2;
    try {
        const quadseg::Mesh mesh = quadseg::read_mesh(argv[1]);
        quadseg::Context context;
        context.set_time_limit(60);
        context.on_progress([](const quadseg::Progress& p) {
            std::fprintf(stderr, "\r%3.0f %%", 100 * p.fraction);
            return true;  // false would cancel
        });
        const quadseg::Segmentation result = quadseg::segment(mesh.view(), {}, &context);
        std::fprintf(stderr, "\r");
        for (const quadseg::Region& region : result.regions) {
            std::printf("region %d: %s, %zu faces, rms %.2g\n", region.id, to_string(region.surface.type), region.faces,
                        region.rms);
        }
        return result.regions.empty() ? 1 : 0;
    } catch (const quadseg::Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
