// The same meshes through every rival and through ours; results first, then times.
#include <quadseg/io.h>

#include "bench/rivals/adapter.h"
#include "bench/rivals/verdict.h"
#include "bench/support/child.h"
#include "bench/support/score.h"
#include "bench/support/statistics.h"

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <sys/resource.h>

namespace quadseg::bench {

std::vector<Rival> rivals() {
    return {{"ours", {true, true, false}, make_ours},
            {"ours, number of regions found", {false, true, false}, make_ours_automatic},
            {"ours, paper preset", {true, true, true}, make_ours_paper},
            {"CGAL VSA L21", {true, true, false}, make_vsa_l21},
            {"CGAL VSA L21, iterations of the manual", {true, true, false}, make_vsa_l21_as_documented},
            {"CGAL VSA L2", {true, true, false}, make_vsa_l2},
            {"CGAL VSA quadric", {true, true, false}, make_vsa_quadric},
            {"CGAL VSA quadric, incremental", {true, true, true}, make_vsa_quadric_incremental},
            {"CGAL RANSAC", {false, false, false}, make_ransac},
            {"CGAL RANSAC tight", {false, false, false}, make_ransac_tight},
            {"CGAL region growing", {false, false, false}, make_region_growing}};
}

namespace {

using Json = nlohmann::ordered_json;

double process_cpu() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// In the child: reading and the rival's own mesh are not its work.
void run_adapter(const Rival& rival, const std::string& mesh_file, std::size_t regions, const std::string& prefix) {
    const Mesh mesh = read_mesh(mesh_file);
    const std::unique_ptr<Adapter> adapter = rival.make();
    const double before = process_cpu();
    adapter->prepare(mesh, regions);
    const double prepared = process_cpu();
    const auto start = std::chrono::steady_clock::now();
    adapter->segment();
    const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const double done = process_cpu();
    const std::vector<std::int32_t> labels = adapter->labels();
    std::ofstream(prefix + ".labels", std::ios::binary)
        .write(reinterpret_cast<const char*>(labels.data()),
               static_cast<std::streamsize>(labels.size() * sizeof(std::int32_t)));
    std::ofstream(prefix + ".json") << Json{{"prepare", prepared - before}, {"cpu", done - prepared}, {"wall", wall}};
}

std::vector<std::int32_t> read_labels(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    std::vector<std::int32_t> labels(bytes.size() / sizeof(std::int32_t));
    std::copy_n(bytes.data(), labels.size() * sizeof(std::int32_t), reinterpret_cast<char*>(labels.data()));
    return labels;
}

struct Entry {
    const Rival* rival = nullptr;
    std::vector<double> cpu, wall, prepare;
    Score result;
    std::vector<std::string> faults;
};

struct Task {
    std::string file;
    std::size_t regions = 0;
};

Task parse_task(const std::string& text) {
    const std::size_t colon = text.rfind(':');
    if (colon == std::string::npos) throw CLI::ValidationError("mesh", "FILE:REGIONS expected: " + text);
    return {text.substr(0, colon), std::stoul(text.substr(colon + 1))};
}

/// A round is one run of everybody, so that the machine's other work falls on all alike.
std::vector<Entry> compare(const Task& task, const std::vector<Rival>& field, int rounds, double time_limit,
                           const std::string& self) {
    const TemporaryFolder folder;
    const Mesh mesh = read_mesh(task.file);
    std::vector<Entry> entries;
    for (const Rival& rival : field) entries.push_back({&rival, {}, {}, {}, {}, {}});
    std::map<std::size_t, Score> blind;
    for (int round = 0; round < rounds; ++round) {
        for (Entry& entry : entries) {
            if (!entry.faults.empty()) continue;
            const std::string prefix = folder.file("job");
            const ChildResult child = run_child({self, "--child", entry.rival->name, "--prefix", prefix,
                                                 task.file + ":" + std::to_string(task.regions)},
                                                folder.file("log"), time_limit);
            if (child.exit_code != 0) {
                entry.faults.push_back(child.timed_out ? "none in " + std::to_string(int(time_limit)) + " s"
                                                       : "exit code " + std::to_string(child.exit_code));
                continue;
            }
            if (round == 0) {
                try {
                    entry.result = score(mesh.view(), read_labels(prefix + ".labels"));
                    const std::size_t n = entry.result.regions;
                    if (!blind.contains(n)) blind[n] = score(mesh.view(), blind_partition(mesh.view(), n));
                    entry.faults = faults(entry.rival->traits, task.regions, entry.result, blind[n]);
                } catch (const std::invalid_argument& error) {
                    entry.faults.emplace_back(error.what());
                }
                if (!entry.faults.empty()) continue;
            }
            const Json times = Json::parse(std::ifstream(prefix + ".json"));
            entry.cpu.push_back(times["cpu"]);
            entry.wall.push_back(times["wall"]);
            entry.prepare.push_back(times["prepare"]);
            std::cerr << entry.rival->name << ": " << entry.cpu.back() << " s\n";
        }
    }
    return entries;
}

std::string format(const char* pattern, double value) {
    char text[64];
    std::snprintf(text, sizeof text, pattern, value);
    return text;
}

void write_markdown(std::ostream& out, const Task& task, const std::vector<Entry>& entries) {
    const std::string name = std::filesystem::path(task.file).filename().string();
    out << "**" << name << ", " << task.regions << " regions**\n\n"
        << "| | CPU s (min … max) | × ours | wall s | regions | pieces | unlabelled | E (ω .5) | RMS | RMS / ours |\n"
        << "|---|---|---|---|---|---|---|---|---|---|\n";
    const Entry& ours = entries.front();
    const double our_cpu = spread(ours.cpu).median;
    for (const Entry& e : entries) {
        out << "| " << e.rival->name << " | ";
        if (!e.faults.empty()) {
            out << "**failed**: " << e.faults.front() << " | | | | | | | | |\n";
            continue;
        }
        const Spread cpu = spread(e.cpu);
        out << format("%.3g", cpu.median) << " (" << format("%.3g", cpu.min) << " … " << format("%.3g", cpu.max)
            << ") | " << format("%.3g", cpu.median / our_cpu) << " | " << format("%.3g", spread(e.wall).median) << " | "
            << e.result.regions << " | " << e.result.pieces << " | "
            << format("%.1f %%", 100 * e.result.unlabelled_area) << " | " << format("%.3g", e.result.energy) << " | "
            << format("%.2e", e.result.rms) << " | " << format("%.3g", e.result.rms / ours.result.rms) << " |\n";
    }
    out << "\n";
}

Json to_json(const Task& task, const std::vector<Entry>& entries) {
    Json rows = Json::array();
    for (const Entry& e : entries) {
        const Spread cpu = spread(e.cpu), wall = spread(e.wall), prepare = spread(e.prepare);
        rows.push_back({{"name", e.rival->name},
                        {"faults", e.faults},
                        {"runs", e.cpu.size()},
                        {"cpu", {{"median", cpu.median}, {"min", cpu.min}, {"max", cpu.max}}},
                        {"wall", {{"median", wall.median}, {"min", wall.min}, {"max", wall.max}}},
                        {"own_mesh_cpu", prepare.median},
                        {"regions", e.result.regions},
                        {"pieces", e.result.pieces},
                        {"unlabelled_area", e.result.unlabelled_area},
                        {"energy", e.result.energy},
                        {"rms", e.result.rms}});
    }
    return {{"mesh", task.file}, {"regions", task.regions}, {"rows", rows}};
}

struct Arguments {
    std::vector<std::string> meshes, only;
    std::string out = ".", child, prefix;
    int rounds = 3;
    double time_limit = 300;
    bool all = false;
};

int run(const Arguments& a, const std::string& self) {
    const std::vector<Rival> known = rivals();
    if (!a.child.empty()) {
        const Task task = parse_task(a.meshes.at(0));
        for (const Rival& rival : known) {
            if (rival.name == a.child) run_adapter(rival, task.file, task.regions, a.prefix);
        }
        return 0;
    }
    std::vector<Rival> field{known.front()};
    for (std::size_t i = 1; i < known.size(); ++i) {
        bool wanted = a.only.empty() ? a.all || !known[i].traits.long_running : false;
        for (const std::string& name : a.only) wanted = wanted || known[i].name.find(name) != std::string::npos;
        if (wanted) field.push_back(known[i]);
    }
    Json json = Json::array();
    bool sound = true;
    std::filesystem::create_directories(a.out);
    std::ofstream markdown(a.out + "/rivals.md");
    for (const std::string& text : a.meshes) {
        const Task task = parse_task(text);
        const std::vector<Entry> entries = compare(task, field, a.rounds, a.time_limit, self);
        for (const Entry& e : entries) sound = sound && e.faults.empty();
        write_markdown(markdown, task, entries);
        write_markdown(std::cout, task, entries);
        json.push_back(to_json(task, entries));
        std::ofstream(a.out + "/rivals.json") << json.dump(1) << '\n';
    }
    return sound ? 0 : 1;
}

}  // namespace
}  // namespace quadseg::bench

int main(int argc, char** argv) try {
    CLI::App app{"Rivals on the same meshes: scored by one ruler, then timed. Exit code 1: a result was unsound"};
    quadseg::bench::Arguments arguments;
    app.add_option("meshes", arguments.meshes, "FILE:REGIONS ...")->required();
    app.add_option("--only", arguments.only, "Rivals whose name contains one of these (ours always runs)");
    app.add_flag("--all", arguments.all, "Also those that take minutes");
    app.add_option("--rounds", arguments.rounds, "Runs of each")->capture_default_str()->check(CLI::PositiveNumber);
    app.add_option("--time-limit", arguments.time_limit, "Seconds a run")->capture_default_str();
    app.add_option("--out", arguments.out, "Folder for rivals.md and rivals.json")->capture_default_str();
    app.add_option("--child", arguments.child)->group("");
    app.add_option("--prefix", arguments.prefix)->group("");
    CLI11_PARSE(app, argc, argv);
    return quadseg::bench::run(arguments, "/proc/self/exe");
} catch (const std::exception& error) {
    std::cerr << "quadseg_rivals: " << error.what() << '\n';
    return 2;
}
