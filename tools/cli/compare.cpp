#include <quadseg/error.h>
#include <quadseg/io.h>
#include <quadseg/mesh.h>

#include "runtime/parallel.h"
#include "tools/cli/commands.h"
#include "tools/cli/exit_code.h"
#include "tools/cli/files.h"
#include "tools/cli/hausdorff.h"
#include "tools/cli/picture.h"
#include "tools/cli/report.h"
#include "tools/cli/stop_signals.h"

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <memory>
#include <vector>

namespace quadseg::cli {
namespace {

struct Arguments {
    std::string first, second;
    std::size_t samples = 0;
    int threads = 0;
    double timeout = 0;
    bool json = false;
    std::string picture;
    double picture_scale = 0;
    std::string up;
};

/// Ten a face, so that no face of a usual mesh goes without, within what takes seconds.
std::size_t sample_count(const Arguments& arguments, const Mesh& a, const Mesh& b) {
    if (arguments.samples > 0) return arguments.samples;
    const std::size_t faces = std::max(a.triangles.size(), b.triangles.size()) / 3;
    return std::clamp<std::size_t>(10 * faces, 100000, 2000000);
}

double relative(double length, const MeshDistance& distance) {
    return distance.diagonal > 0 ? length / distance.diagonal : 0;
}

Json lengths_json(double max, double mean, double rms, const MeshDistance& distance) {
    return {{"max", max},
            {"mean", mean},
            {"rms", rms},
            {"relative",
             {{"max", relative(max, distance)}, {"mean", relative(mean, distance)}, {"rms", relative(rms, distance)}}}};
}

Json one_sided_json(const OneSidedDistance& side, const MeshDistance& distance) {
    Json json = lengths_json(side.max, side.mean, side.rms, distance);
    json["farthest"] = side.farthest;
    json["surface_samples"] = side.surface_samples;
    json["vertex_samples"] = side.vertex_samples;
    json["samples_per_area"] = side.area > 0 ? static_cast<double>(side.surface_samples) / side.area : 0;
    json["area"] = side.area;
    return json;
}

void print(const MeshDistance& distance) {
    const auto line = [&](const char* name, double max, double mean, double rms) {
        std::printf("%-9s max %.9g  mean %.9g  rms %.9g  (of the diagonal: %.3g, %.3g, %.3g)\n", name, max, mean, rms,
                    relative(max, distance), relative(mean, distance), relative(rms, distance));
    };
    line("A to B", distance.forward.max, distance.forward.mean, distance.forward.rms);
    line("B to A", distance.backward.max, distance.backward.mean, distance.backward.rms);
    line("symmetric", distance.max, distance.mean, distance.rms);
    for (const auto& [name, side] : {std::pair{"A", &distance.forward}, std::pair{"B", &distance.backward}}) {
        std::printf("%s: %zu samples on an area of %.6g, and its %zu vertices\n", name, side->surface_samples,
                    side->area, side->vertex_samples);
    }
    std::printf("diagonal of A: %.9g\n", distance.diagonal);
}

/// The first mesh in the colours of its vertices' distances from the second.
void write_error_picture(const Arguments& arguments, const Mesh& a, const Mesh& b, const MeshDistance& distance,
                         const Context& context) {
    std::vector<double> errors = vertex_distances(a.view(), b.view(), context);
    for (double& error : errors) error = relative(error, distance);
    PictureContent content;
    content.errors = errors;
    content.largest_error =
        arguments.picture_scale > 0 ? arguments.picture_scale : relative(distance.forward.max, distance);
    content.up = arguments.up.empty() ? -1 : arguments.up[0] - 'x';
    write_picture(arguments.picture, a.view(), content);
}

int run_compare(const Arguments& arguments) {
    Context context;
    context.set_threads(arguments.threads);
    if (arguments.timeout > 0) context.set_time_limit(arguments.timeout);
    const StopSignals signals(context);
    Mesh meshes[2];
    for (int k = 0; k < 2; ++k) {
        const std::string& file = k == 0 ? arguments.first : arguments.second;
        meshes[k] = read_mesh(file, &context);
        on_file(file, [&] { return inspect(meshes[k].view(), 0, &context); });
    }
    MeshDistance distance;
    runtime::in_arena(arguments.threads, [&] {
        distance = measure_mesh_distance(meshes[0].view(), meshes[1].view(),
                                         sample_count(arguments, meshes[0], meshes[1]), context);
        if (!arguments.picture.empty()) write_error_picture(arguments, meshes[0], meshes[1], distance, context);
    });
    if (arguments.json) {
        Json json;
        json["a"] = arguments.first;
        json["b"] = arguments.second;
        json["diagonal"] = distance.diagonal;
        json["a_to_b"] = one_sided_json(distance.forward, distance);
        json["b_to_a"] = one_sided_json(distance.backward, distance);
        json["symmetric"] = lengths_json(distance.max, distance.mean, distance.rms, distance);
        std::cout << indented(json);
    } else {
        print(distance);
    }
    return exit_done;
}

}  // namespace

Command add_compare(CLI::App& app) {
    const auto arguments = std::make_shared<Arguments>();
    CLI::App* command = app.add_subcommand(
        "compare", "Symmetric Hausdorff distance of two meshes: max, mean, RMS, as Metro measures it");
    command->add_option("a", arguments->first, "OFF, OBJ, PLY or STL file; relative lengths are over its diagonal")
        ->required();
    command->add_option("b", arguments->second, "OFF, OBJ, PLY or STL file")->required();
    command
        ->add_option(
            "--samples", arguments->samples,
            "Samples on each surface beside the vertices; 0: ten a face of the finer mesh, 100,000 to 2,000,000")
        ->capture_default_str();
    command->add_option("--threads", arguments->threads, "At most so many threads, 0: all")
        ->capture_default_str()
        ->check(CLI::Range(0, 4096));
    command->add_option("--timeout", arguments->timeout, "Seconds")->check(CLI::PositiveNumber);
    command->add_flag("--json", arguments->json, "Print JSON");
    CLI::Option* picture = command->add_option("--picture", arguments->picture,
                                               "PNG of the first mesh in the colours of its distances from the second");
    command
        ->add_option("--picture-scale", arguments->picture_scale,
                     "Distance that is red, relative to the diagonal; 0: the largest")
        ->check(CLI::NonNegativeNumber)
        ->needs(picture)
        ->capture_default_str();
    command->add_option("--up", arguments->up, "Axis that stands upright in the picture")
        ->check(CLI::IsMember({"x", "y", "z"}))
        ->needs(picture);
    return [arguments] { return run_compare(*arguments); };
}

}  // namespace quadseg::cli
