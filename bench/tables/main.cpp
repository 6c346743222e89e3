// Whole jobs over a manifest: CSV, JSON and Markdown beside each other.
#include "bench/tables/manifest.h"
#include "bench/tables/measure.h"
#include "bench/tables/report.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>

namespace {

using namespace quadseg::bench;

struct Arguments {
    std::string manifest, out = ".";
    Places places;
    std::vector<std::string> only;
    int runs = 0;
};

int run(const Arguments& a) {
    std::ifstream in(a.manifest);
    if (!in) throw std::invalid_argument(a.manifest + ": can't be read");
    const Manifest manifest = parse_manifest(nlohmann::json::parse(in));
    std::filesystem::create_directories(a.out);
    const std::string base = a.out + "/" + std::filesystem::path(a.manifest).stem().string();
    std::ofstream csv_file(base + ".csv"), markdown_file(base + ".md");
    csv_file << csv_header();
    markdown_file << "## " << manifest.title << "\n\n";
    nlohmann::ordered_json all{{"title", manifest.title}, {"tables", nlohmann::ordered_json::array()}};
    bool complete = true;
    for (const Table& table : manifest.tables) {
        if (!a.only.empty() && std::find(a.only.begin(), a.only.end(), table.name) == a.only.end()) continue;
        const std::vector<Measured> jobs =
            measure(manifest, table, a.places, a.runs, [](const std::string& text) { std::cerr << text << '\n'; });
        for (const Measured& job : jobs) complete = complete && job.exit_code == 0;
        csv_file << csv(manifest, table, jobs) << std::flush;
        markdown_file << markdown(manifest, table, jobs) << std::flush;
        std::cout << markdown(manifest, table, jobs) << std::flush;
        all["tables"].push_back(json(manifest, table, jobs));
        std::ofstream(base + ".json") << all.dump(1) << '\n';
    }
    return complete ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) try {
    CLI::App app{"Runs the jobs of a manifest in fresh processes. Exit code 1: a job failed or ran out of time"};
    Arguments arguments;
    Places& places = arguments.places;
#ifdef QUADSEG_PROGRAM
    places.program = QUADSEG_PROGRAM;
#endif
    app.add_option("manifest", arguments.manifest, "JSON file, see bench/README.md")->required();
    app.add_option("--out", arguments.out, "Folder for MANIFEST.csv, .json and .md")->capture_default_str();
    app.add_option("--shared", places.shared, "Folder that mesh files are relative to");
    app.add_option("--meshes", places.meshes, "Folder where generated meshes are kept; default: below --out");
    auto* program = app.add_option("--program", places.program, "The program quadseg")->capture_default_str();
    if (places.program.empty()) program->required();
    app.add_option("--only", arguments.only, "Names of tables");
    app.add_option("--runs", arguments.runs, "Runs of each job instead of the manifest's number");
    CLI11_PARSE(app, argc, argv);
    if (places.meshes.empty()) places.meshes = arguments.out + "/meshes";
    return run(arguments);
} catch (const std::exception& error) {
    std::cerr << "quadseg_tables: " << error.what() << '\n';
    return 2;
}
