#include <quadseg/error.h>
#include <quadseg/io.h>

#include "runtime/parallel.h"
#include "simplify/decimate.h"
#include "tools/cli/commands.h"
#include "tools/cli/exit_code.h"
#include "tools/cli/files.h"
#include "tools/cli/stop_signals.h"

#include <cstdio>
#include <cstring>
#include <memory>

namespace quadseg::cli {
namespace {

struct Arguments {
    std::string mesh;
    std::string output;
    std::size_t faces = 0;
    double features = 30;
    int threads = 0;
    double timeout = 0;
    bool quiet = false;
};

simplify::Decimated decimate(const Mesh& mesh, const Arguments& arguments, const Context& context) {
    std::vector<Vec3> positions(mesh.positions.size() / 3);
    for (std::size_t v = 0; v < positions.size(); ++v) {
        positions[v] = {mesh.positions[3 * v], mesh.positions[3 * v + 1], mesh.positions[3 * v + 2]};
    }
    std::vector<std::array<std::uint32_t, 3>> faces(mesh.triangles.size() / 3);
    std::memcpy(faces.data(), mesh.triangles.data(), mesh.triangles.size() * sizeof(std::uint32_t));
    simplify::DecimateOptions options;
    options.target_faces = arguments.faces;
    options.feature_degrees = arguments.features;
    options.should_stop = [&context] { return context.cancelled() || context.past_deadline(); };
    simplify::Decimated result;
    runtime::in_arena(arguments.threads, [&] { result = simplify::decimate(positions, faces, options); });
    return result;
}

Mesh to_mesh(const simplify::Decimated& decimated) {
    Mesh mesh;
    mesh.positions.reserve(3 * decimated.positions.size());
    for (const Vec3& p : decimated.positions) mesh.positions.insert(mesh.positions.end(), {p.x, p.y, p.z});
    mesh.triangles.reserve(3 * decimated.faces.size());
    for (const auto& f : decimated.faces) mesh.triangles.insert(mesh.triangles.end(), f.begin(), f.end());
    mesh.file_faces = decimated.faces.size();
    return mesh;
}

int run_simplify(const Arguments& arguments) {
    Context context;
    context.set_threads(arguments.threads);
    if (arguments.timeout > 0) context.set_time_limit(arguments.timeout);
    const StopSignals signals(context);
    const Mesh mesh = read_mesh(arguments.mesh, &context);
    // Refuses what is no mesh before the arrays are followed.
    const MeshReport report = on_file(arguments.mesh, [&] { return inspect(mesh.view(), 0, &context); });
    const simplify::Decimated decimated = decimate(mesh, arguments, context);
    const bool stopped = context.cancelled() || context.past_deadline();
    runtime::in_arena(arguments.threads, [&] { write_mesh(arguments.output, to_mesh(decimated).view()); });
    if (!arguments.quiet) {
        std::printf("%s: %zu of %zu faces, largest error %.3g of the diagonal%s\n", arguments.output.c_str(),
                    decimated.faces.size(), report.faces,
                    report.diagonal > 0 ? decimated.max_error / report.diagonal : 0, stopped ? " (stopped early)" : "");
    }
    return stopped ? exit_stopped : exit_done;
}

}  // namespace

Command add_simplify(CLI::App& app) {
    const auto arguments = std::make_shared<Arguments>();
    CLI::App* command = app.add_subcommand("simplify", "Simplifies a mesh by quadric-error edge collapses");
    command->add_option("mesh", arguments->mesh, "OFF, OBJ, PLY or STL file")->required();
    command->add_option("-o,--output", arguments->output, "File to write: .ply, .off, .obj or .stl")->required();
    command->add_option("--faces", arguments->faces, "Faces wanted")->required()->check(CLI::PositiveNumber);
    command->add_option("--features", arguments->features, "Angle in degrees of the edges that stay in place")
        ->capture_default_str()
        ->check(CLI::Range(0.0, 180.0));
    command->add_option("--threads", arguments->threads, "At most so many threads, 0: all")
        ->capture_default_str()
        ->check(CLI::Range(0, 4096));
    command->add_option("--timeout", arguments->timeout, "Seconds; stops with what is done")
        ->check(CLI::PositiveNumber);
    command->add_flag("--quiet", arguments->quiet, "Print nothing");
    return [arguments] { return run_simplify(*arguments); };
}

}  // namespace quadseg::cli
