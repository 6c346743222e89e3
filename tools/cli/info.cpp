#include <quadseg/io.h>

#include "tools/cli/commands.h"
#include "tools/cli/exit_code.h"
#include "tools/cli/files.h"
#include "tools/cli/report.h"
#include "tools/cli/stop_signals.h"

#include <cstdio>
#include <iostream>
#include <memory>

namespace quadseg::cli {
namespace {

struct Arguments {
    std::string mesh;
    double features = 30;
    bool json = false;
};

void print(const Mesh& mesh, const MeshReport& r, double features) {
    const auto count = [](const char* name, std::size_t value) { std::printf("%-22s %zu\n", name, value); };
    if (!mesh.polygons.empty()) count("polygons", mesh.file_faces);
    count("faces", r.faces);
    count("vertices", r.vertices);
    count("components", r.components);
    count("border edges", r.border_edges);
    count("non-manifold edges", r.non_manifold_edges);
    count("non-manifold vertices", r.non_manifold_vertices);
    count("degenerate faces", r.degenerate_faces);
    count("duplicate faces", r.duplicate_faces);
    count("flipped faces", r.flipped_faces);
    count("unorientable edges", r.unorientable_edges);
    count("stitched edges", r.stitched_edges);
    count("isolated vertices", r.isolated_vertices);
    count("welded vertices", mesh.welded_vertices);
    if (features > 0) std::printf("%-22s %zu (above %g degrees)\n", "feature edges", r.feature_edges, features);
    std::printf("%-22s %.9g\n", "diagonal", r.diagonal);
    std::printf("%-22s %.9g\n", "area", r.area);
    std::printf("%-22s [%.9g, %.9g] x [%.9g, %.9g] x [%.9g, %.9g]\n", "box", r.box_min[0], r.box_max[0], r.box_min[1],
                r.box_max[1], r.box_min[2], r.box_max[2]);
    if (r.offset > 1000) {
        std::printf("note: the mesh lies %.3g diagonals from the origin; its coordinates carry few digits\n", r.offset);
    }
}

}  // namespace

Command add_info(CLI::App& app) {
    const auto arguments = std::make_shared<Arguments>();
    CLI::App* command = app.add_subcommand("info", "Checks a mesh: counts, components, borders, defects");
    command->add_option("mesh", arguments->mesh, "OFF, OBJ, PLY or STL file")->required();
    command->add_option("--features", arguments->features, "Angle of feature edges in degrees, 0: not counted")
        ->capture_default_str()
        ->check(CLI::Range(0.0, 180.0));
    command->add_flag("--json", arguments->json, "Print JSON");
    return [arguments] {
        Context context;
        const StopSignals signals(context);
        const Mesh mesh = read_mesh(arguments->mesh, &context);
        const MeshReport report =
            on_file(arguments->mesh, [&] { return inspect(mesh.view(), arguments->features, &context); });
        if (arguments->json) {
            std::cout << indented(input_json(arguments->mesh, mesh, report));
        } else {
            print(mesh, report, arguments->features);
        }
        return static_cast<int>(exit_done);
    };
}

}  // namespace quadseg::cli
