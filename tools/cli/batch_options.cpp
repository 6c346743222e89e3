#include "tools/cli/batch_options.h"

#include <quadseg/error.h>

#include <algorithm>
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
    command.get_option("--memory-limit")->description("Bytes a mesh's process may use, like 500M or 2G")->group(group);
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
    settings.memory_limit = a.segment.memory_limit;
    return settings;
}

}  // namespace quadseg::cli
