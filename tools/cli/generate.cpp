#include "datasets/generate.h"

#include <quadseg/error.h>
#include <quadseg/io.h>

#include "tools/cli/commands.h"
#include "tools/cli/exit_code.h"
#include "tools/cli/files.h"

#include <cstdio>
#include <memory>

namespace quadseg::cli {
namespace {

struct Arguments {
    datasets::Recipe recipe;
    std::string folder;
    bool off = false;
    bool quiet = false;
};

}  // namespace

Command add_generate(CLI::App& app) {
    const auto arguments = std::make_shared<Arguments>();
    std::string names;
    for (const std::string& name : datasets::generator_names()) names += (names.empty() ? "" : ", ") + name;
    CLI::App* command = app.add_subcommand("generate", "Makes a CAD-like mesh whose true surfaces are known");
    datasets::Recipe& recipe = arguments->recipe;
    command->add_option("name", recipe.name, names)->required();
    command->add_option("-o,--output", arguments->folder, "Folder for NAME.ply and NAME.gt.json")->required();
    command->add_option("--faces", recipe.faces, "Triangles, about")->capture_default_str();
    command->add_option("--noise", recipe.noise, "Standard deviation along the normals, relative to the diagonal")
        ->capture_default_str();
    command->add_option("--seed", recipe.seed, "Of dimensions, irregularity, noise, order")->capture_default_str();
    command->add_flag("--shuffle", recipe.shuffle, "Random order of triangles and vertices");
    command->add_flag("--off", arguments->off, "Also write NAME.off, as the evaluators read it");
    command->add_flag("--quiet", arguments->quiet, "Print nothing");
    return [arguments] {
        const datasets::Recipe& wanted = arguments->recipe;
        const datasets::Generated generated = datasets::generate(wanted);
        make_folder(arguments->folder);
        const std::string base = arguments->folder + "/" + wanted.name;
        write_ply(base + ".ply", generated.mesh.view());
        write_text(base + ".gt.json", datasets::ground_truth_json(generated, wanted));
        if (arguments->off) write_mesh(base + ".off", generated.mesh.view());
        if (!arguments->quiet) {
            std::printf("%s.ply: %zu faces on %zu true surfaces\n", base.c_str(), generated.truth.size(),
                        generated.surfaces.size());
        }
        return static_cast<int>(exit_done);
    };
}

}  // namespace quadseg::cli
