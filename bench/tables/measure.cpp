#include "bench/tables/measure.h"

#include "bench/support/child.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace quadseg::bench {
namespace {

namespace fs = std::filesystem;

void read_result(const std::string& path, Measured& measured) {
    std::ifstream in(path);
    if (!in) return;
    const auto json = nlohmann::ordered_json::parse(in, nullptr, false);
    if (json.is_discarded()) return;
    measured.faces = json.at("input").at("faces");
    measured.regions = json.at("regions").size();
    measured.energy = json.at("energy").at("total");
    measured.rms = json.at("rms");
    measured.stop = json.at("stop");
    measured.seconds = json.at("seconds");
}

void run_once(const std::string& mesh, const Table& table, const Places& places, Measured& measured) {
    const TemporaryFolder folder;
    std::vector<std::string> command{places.program,
                                     "segment",
                                     mesh,
                                     "-o",
                                     folder.file("result"),
                                     "--quiet",
                                     "--preset",
                                     measured.job.preset,
                                     "--threads",
                                     std::to_string(measured.job.threads)};
    if (!measured.job.regions.empty()) command.insert(command.end(), {"--regions", measured.job.regions});
    command.insert(command.end(), measured.job.arguments.begin(), measured.job.arguments.end());
    const ChildResult child = run_child(command, {}, table.time_limit);
    measured.exit_code = child.exit_code;
    measured.timed_out = child.timed_out;
    if (child.exit_code != 0) return;
    measured.wall.push_back(child.wall_seconds);
    measured.cpu.push_back(child.cpu_seconds);
    measured.peak.push_back(static_cast<double>(child.peak_bytes));
    read_result(folder.file("result") + "/result.json", measured);
}

}  // namespace

std::string mesh_path(const MeshSource& mesh, const Places& places) {
    if (!mesh.file.empty()) {
        std::string path = places.shared + "/" + mesh.file;
        return fs::exists(path) ? path : std::string();
    }
    char noise[32];
    std::snprintf(noise, sizeof noise, "%g", mesh.noise);
    const std::string folder = places.meshes + "/" + mesh.generator + "-" + std::to_string(mesh.faces) + "-" + noise +
                               "-" + std::to_string(mesh.seed);
    std::string path = folder + "/" + mesh.generator + ".ply";
    if (fs::exists(path)) return path;
    fs::create_directories(folder);
    const std::string log = folder + "/log.txt";
    const ChildResult child =
        run_child({places.program, "generate", mesh.generator, "-o", folder, "--faces", std::to_string(mesh.faces),
                   "--noise", noise, "--seed", std::to_string(mesh.seed)},
                  log);
    if (child.exit_code != 0) throw std::runtime_error("generating " + mesh.name + " failed, see " + log);
    return path;
}

std::vector<Measured> measure(const Manifest& manifest, const Table& table, const Places& places, int runs,
                              const std::function<void(const std::string&)>& say) {
    std::vector<Measured> result;
    std::vector<std::string> paths;
    for (const Job& job : table.jobs) {
        const std::string path = mesh_path(manifest.meshes.at(job.mesh), places);
        if (path.empty()) {
            say(table.name + ": no file for " + job.mesh + ", left out");
            continue;
        }
        result.push_back({});
        result.back().job = job;
        paths.push_back(path);
    }
    for (int run = 0; run < (runs > 0 ? runs : table.runs); ++run) {
        for (std::size_t j = 0; j < result.size(); ++j) {
            if (result[j].exit_code != 0) continue;
            run_once(paths[j], table, places, result[j]);
            say(table.name + ": " + result[j].job.mesh + " " + result[j].job.variant + " run " +
                std::to_string(run + 1) +
                (result[j].exit_code != 0 ? " exit code " + std::to_string(result[j].exit_code)
                                          : ", " + std::to_string(result[j].wall.back()) + " s"));
        }
    }
    return result;
}

}  // namespace quadseg::bench
