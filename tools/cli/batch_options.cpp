#include "tools/cli/batch_options.h"

#include <quadseg/error.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <thread>

namespace quadseg::cli {
namespace {

/// What the batch decides for its workers, or keeps for itself.
const std::set<std::string>& own_options() {
    static const std::set<std::string> names{
        "mesh",    "--output",   "--help",    "--jobs",  "--resume", "--retry", "--list",         "--shard",
        "--grace", "--progress", "--timeout", "--quiet", "--json",   "--name",  "--memory-limit", "--threads"};
    return names;
}

/// Options of `segment` as they were given, ready for another command line.
std::vector<std::string> given_options(const CLI::App& command) {
    std::vector<std::string> words;
    for (const CLI::Option* option : command.get_options()) {
        if (option->count() == 0 || option->get_lnames().empty()) continue;
        const std::string name = option->get_name();
        if (own_options().contains(name)) continue;
        const bool is_flag = option->get_items_expected_max() == 0;
        for (const std::string& value : option->results()) {
            if (!is_flag) {
                words.insert(words.end(), {name, value});
                continue;
            }
            // Of the names of a flag (--x, --no-x), the one that means this value.
            for (const std::string& flag : option->get_lnames()) {
                if (option->get_flag_value(flag, "") == value) {
                    words.push_back("--" + flag);
                    break;
                }
            }
        }
    }
    return words;
}

int cores() {
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
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

void add_item_options(CLI::App& command, BatchArguments& a) {
    a.command = &command;
    add_options(command, a.segment);
    const char* group = "How each mesh is bounded";
    command.get_option("--timeout")
        ->description("Seconds a mesh; then its best partial result counts, marked")
        ->group(group);
    command.add_option("--grace", a.grace, "Seconds after the time-out until a mesh's process is killed")
        ->capture_default_str()
        ->check(CLI::PositiveNumber)
        ->group(group);
    if (CLI::Option* option = command.get_option_no_throw("--memory-limit")) {
        option->group(group);
        a.segment_bounds_memory = true;
    } else {
        command.add_option("--memory-limit", a.memory_limit, "Bytes a mesh's process may use, like 500M or 2G")
            ->group(group);
    }
}

int job_count(const BatchArguments& a) {
    return a.jobs > 0 ? a.jobs : cores();
}

WorkerSettings worker_settings(BatchArguments& a) {
    resolve(a.segment);
    WorkerSettings settings;
    settings.output = a.segment.folder;
    settings.options = given_options(*a.command);
    settings.timeout = a.segment.timeout;
    settings.grace = a.grace;
    const CLI::Option* limit = a.command->get_option("--memory-limit");
    if (limit->count() > 0) {
        const std::string text = limit->results().front();
        settings.memory_limit = parse_bytes("--memory-limit", text);
        if (a.segment_bounds_memory) settings.bounds = {"--memory-limit", text};
    }
    return settings;
}

}  // namespace quadseg::cli
