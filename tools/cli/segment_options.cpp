#include "tools/cli/segment_options.h"

#include <quadseg/error.h>

#include <charconv>
#include <cmath>

namespace quadseg::cli {
namespace {

double number(const std::string& text, const char* option, const char* expected) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) {
        throw Error(ErrorCode::invalid_argument,
                    std::string(option) + ": must be " + expected + ", but is '" + text + "'");
    }
    return value;
}

void add_common(CLI::App& command, SegmentArguments& a) {
    command.add_option("mesh", a.mesh, "OFF, OBJ, PLY or STL file")->required();
    command.add_option("-o,--output", a.folder, "Folder for labels.txt, result.json, regions.ply, types.ply")
        ->required();
    Options& o = a.options;
    const char* group = "What to find";
    command
        .add_option("--preset", a.preset, "default: finds surfaces and their number by itself; paper: the paper's loop")
        ->check(CLI::IsMember({"default", "paper"}))
        ->capture_default_str()
        ->group(group);
    command.add_option("--regions", o.regions, "Number of regions, 0: found by itself")
        ->capture_default_str()
        ->group(group);
    command
        .add_option("--tolerance", o.tolerance,
                    "Largest RMS distance from a surface, relative to the diagonal, 0: from the data")
        ->capture_default_str()
        ->group(group);
    command.add_option("--detail", o.detail, "Above 1 more small features survive, below 1 fewer")
        ->capture_default_str()
        ->group(group);
    command
        .add_option("--features", a.features,
                    "DEGREES|none: edges sharper than this bound regions (unset: as the preset sees fit)")
        ->group(group);
    command.add_flag("!--no-regularities", o.regularities, "Don't look for parallel, coaxial, equal surfaces")
        ->group(group);
    command.add_option("--seed", o.seed, "Of every random choice")->capture_default_str()->group(group);
}

void add_running(CLI::App& command, SegmentArguments& a) {
    const char* group = "How to run";
    command.add_option("--coarse", a.coarse, "FACES|auto|none: segment a simplified mesh first")
        ->capture_default_str()
        ->group(group);
    command.add_option("--threads", a.threads, "At most so many threads, 0: all")
        ->capture_default_str()
        ->check(CLI::Range(0, 4096))
        ->group(group);
    command.add_option("--timeout", a.timeout, "Seconds; then the best partial result is written, exit code 4")
        ->check(CLI::PositiveNumber)
        ->group(group);
    command.add_option("--memory-limit", a.memory, "Bytes, like 500M or 2G: a mesh that needs more is refused at once")
        ->group(group);
    command.add_option("--progress", a.progress, "On stderr: a bar on a terminal, lines otherwise")
        ->check(CLI::IsMember({"auto", "always", "never"}))
        ->capture_default_str()
        ->group(group);
    command.add_flag("--quiet", a.quiet, "No progress, no summary")->group(group);
}

void add_output(CLI::App& command, SegmentArguments& a) {
    Options& o = a.options;
    const char* group = "What to write";
    command.add_flag("--smooth", o.smooth, "Smooth the borders of regions by graph cuts")->group(group);
    command.add_option("--smooth-band", o.smoothing.band, "Faces on each side of a border that may change")
        ->capture_default_str()
        ->group(group);
    command.add_option("--smooth-lambda", o.smoothing.lambda, "Weight of the border length")
        ->capture_default_str()
        ->group(group);
    command.add_flag("--project", o.project, "Project the vertices onto the surfaces: projected.ply")->group(group);
    command
        .add_flag("--project-joint", o.project_joint,
                  "Border vertices onto all surfaces at once, not the average (with --project)")
        ->group(group);
    command.add_flag("--pictures", a.pictures, "Also render regions.png and types.png")->group(group);
    command.add_flag("--write-regions,!--no-write-regions", a.write_regions, "regions.ply (on unless turned off)")
        ->group(group);
    command.add_flag("--write-types,!--no-write-types", a.write_types, "types.ply (on unless turned off)")
        ->group(group);
    command.add_flag("--json", a.json, "Print result.json to stdout")->group(group);
}

void add_paper(CLI::App& command, SegmentArguments& a) {
    const char* group = "The paper's parameters (--preset paper; energies in the unit cube)";
    PaperOptions& p = a.options.paper;
    command.add_option("--method", a.method, "Proxies and metric, for comparisons")
        ->check(
            CLI::IsMember({"quadric", "vsa_l21", "vsa_l2", "hybrid", "quadric_l2", "quadric_gradient", "hierarchical"}))
        ->capture_default_str()
        ->group(group);
    const auto add = [&](const char* name, auto& value, const char* text) {
        command.add_option(name, value, text)->capture_default_str()->group(group);
    };
    add("--weight", a.options.weight, "Weight of the normal term in the energy");
    add("--initial-regions", p.initial_regions, "Random seeds to begin with, 1: insertion one by one, 0: --regions");
    add("--lloyd-iterations", p.lloyd_iterations, "At most, a Lloyd run");
    add("--convergence", p.convergence, "A Lloyd run stops when the energy falls by less than this share");
    add("--plane-tolerance", p.plane_tolerance, "Plane energy below which a region is a plane");
    add("--merge-tolerance", p.merge_tolerance, "Energy increase below which two regions may merge");
    add("--energy-threshold", p.energy_threshold, "Without --regions: insertion goes on above this energy");
    add("--maximum-regions", p.maximum_regions, "Bound of the insertion");
    command.add_flag("!--no-merging", p.merging, "Don't merge redundant regions")->group(group);
    command.add_flag("!--no-teleportation", p.teleportation, "Don't teleport regions")->group(group);
    add("--teleportations", p.teleportations, "At most");
}

}  // namespace

std::size_t parse_bytes(const std::string& option, const std::string& text) {
    double value = 0;
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, value);
    std::string unit(rest, end);
    if (unit.size() > 1 && unit.ends_with('B')) unit.pop_back();
    if (!unit.empty() && unit.ends_with('i')) unit.pop_back();
    const std::size_t power = unit.empty() || unit == "B" ? 0 : std::string("KMGT").find(unit) + 1;
    const double bytes = value * std::pow(1024.0, static_cast<double>(power));
    if (error != std::errc() || unit.size() > 1 || (power == 0 && !unit.empty() && unit != "B") || !(bytes >= 1) ||
        bytes > 1e18) {
        throw Error(ErrorCode::invalid_argument,
                    option + ": must be a number of bytes, like 500M or 2G, but is '" + text + "'");
    }
    return static_cast<std::size_t>(bytes);
}

ProgressMode SegmentArguments::progress_mode() const {
    if (quiet || progress == "never") return ProgressMode::never;
    return progress == "always" ? ProgressMode::always : ProgressMode::automatic;
}

void add_options(CLI::App& command, SegmentArguments& arguments) {
    add_common(command, arguments);
    add_running(command, arguments);
    add_output(command, arguments);
    add_paper(command, arguments);
}

void resolve(SegmentArguments& a) {
    Options& o = a.options;
    from_string(a.preset, o.preset);
    from_string(a.method, o.method);
    if (a.features == "none") {
        o.feature_angle = 0;
    } else if (!a.features.empty()) {
        o.feature_angle = number(a.features, "--features", "0 to 180 degrees or 'none'");
        if (!(o.feature_angle >= 0 && o.feature_angle <= 180)) {
            throw Error(ErrorCode::invalid_argument,
                        "--features: must be 0 to 180 degrees or 'none', but is " + a.features);
        }
    }
    if (a.coarse == "auto") {
        o.coarse = -1;
    } else if (a.coarse != "none") {
        const double faces = number(a.coarse, "--coarse", "a number of faces, 'auto' or 'none'");
        if (!(faces >= 1 && faces <= 1e9)) {
            throw Error(ErrorCode::invalid_argument,
                        "--coarse: must be 1 to 1e9 faces, 'auto' or 'none', but is " + a.coarse);
        }
        o.coarse = static_cast<std::int64_t>(faces);
    }
    if (!a.memory.empty()) a.memory_limit = parse_bytes("--memory-limit", a.memory);
    std::string problems;
    for (const std::string& problem : validate(o)) problems += (problems.empty() ? "" : "\n         ") + problem;
    if (!problems.empty()) throw Error(ErrorCode::invalid_argument, problems);
}

}  // namespace quadseg::cli
