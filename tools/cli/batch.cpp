// `quadseg batch`: many meshes, each in a process of its own, with a log that says what is done.
#include <quadseg/error.h>
#include <quadseg/io.h>

#include "tools/cli/batch_log.h"
#include "tools/cli/batch_options.h"
#include "tools/cli/batch_progress.h"
#include "tools/cli/commands.h"
#include "tools/cli/exit_code.h"
#include "tools/cli/files.h"

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <sys/prctl.h>
#include <unistd.h>

namespace quadseg::cli {
namespace {

namespace fs = std::filesystem;

/// "" or "-2-of-8": several shards may share one output folder.
std::string shard_suffix(const Shard& shard) {
    return shard.whole() ? "" : "-" + std::to_string(shard.index) + "-of-" + std::to_string(shard.count);
}

/// Signals as events instead of handlers: children that end, and the wish to stop.
class SignalQueue {
  public:
    SignalQueue() {
        std::signal(SIGCHLD, SIG_DFL);  // inherited SIG_IGN would take the children's status away
        sigemptyset(&set_);
        for (const int signal : {SIGCHLD, SIGINT, SIGTERM}) sigaddset(&set_, signal);
        sigprocmask(SIG_BLOCK, &set_, &before_);
    }
    ~SignalQueue() { sigprocmask(SIG_SETMASK, &before_, nullptr); }
    SignalQueue(const SignalQueue&) = delete;
    SignalQueue& operator=(const SignalQueue&) = delete;

    /// Waits up to 0.1 s; true when the batch is to stop.
    bool stop_requested() {
        const timespec pause{0, 100'000'000};
        const int signal = sigtimedwait(&set_, nullptr, &pause);
        return signal == SIGINT || signal == SIGTERM;
    }

  private:
    sigset_t set_{}, before_{};
};

/// Results of different options in one folder would be of no use: the first batch writes its own down.
void check_same_options(const std::string& folder, const WorkerSettings& settings) {
    const std::string path = folder + "/batch.json";
    Json mine;
    mine["quadseg"] = QUADSEG_VERSION;
    mine["options"] = settings.options;
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        // Made where the next run clears away what a killed one left.
        make_folder(settings.scratch);
        write_text(settings.scratch + "/batch.json", indented(mine));
        fs::rename(settings.scratch + "/batch.json", path);
        fs::remove_all(settings.scratch);
        return;
    }
    const Json theirs = Json::parse(file, nullptr, false);
    if (theirs != Json::parse(to_line(mine))) {
        throw Error(ErrorCode::invalid_argument,
                    path + ": the results here were made with another version or other options: " + to_line(theirs) +
                        "give the same ones or another folder");
    }
}

std::vector<BatchItem> not_done(const std::vector<BatchItem>& items, const ResultsLog& log, bool retry) {
    std::vector<BatchItem> rest;
    std::copy_if(items.begin(), items.end(), std::back_inserter(rest), [&](const BatchItem& item) {
        const auto record = log.records().find(record_key(item.name));
        return record == log.records().end() || (retry && record->second.value("status", "") != "ok");
    });
    return rest;
}

/// Works through the items; false when stopped by a signal.
bool run_all(const std::vector<BatchItem>& items, const WorkerSettings& settings, int jobs, ResultsLog& log,
             BatchProgress& progress) {
    SignalQueue signals;
    std::vector<Worker> running;
    std::size_t next = 0;
    while (next < items.size() || !running.empty()) {
        while (next < items.size() && running.size() < static_cast<std::size_t>(jobs)) {
            running.emplace_back(settings, items[next], next);
            ++next;
        }
        progress.show();
        if (signals.stop_requested()) return false;  // whoever still runs is ended, and is not in the log
        std::vector<Worker> rest;
        for (Worker& worker : running) {
            if (!worker.ended()) {
                worker.kill_if_late();
                rest.push_back(std::move(worker));
                continue;
            }
            const std::uintmax_t bytes = worker.item().bytes;
            const Json record = worker.finish();
            log.append(record);
            progress.add(record.at("status") == "failed", bytes, record.value("faces", std::size_t{0}));
        }
        running = std::move(rest);
    }
    return true;
}

struct Outcomes {
    std::size_t meshes = 0, ok = 0, partial = 0, failed = 0, missing = 0;
    std::map<std::string, std::size_t> kinds;          ///< of what is not ok
    std::map<std::string, std::string> first_message;  ///< an example of each
};

Outcomes outcomes_of(const std::vector<BatchItem>& items, const ResultsLog& log) {
    Outcomes o;
    o.meshes = items.size();
    for (const BatchItem& item : items) {
        const auto record = log.records().find(record_key(item.name));
        if (record == log.records().end()) {
            ++o.missing;
            continue;
        }
        const std::string status = record->second.value("status", "");
        ++(status == "ok" ? o.ok : status == "partial" ? o.partial : o.failed);
        if (status == "ok") continue;
        const std::string kind = record->second.value("kind", "unknown");
        if (o.kinds[kind]++ == 0) o.first_message[kind] = item.name + ": " + record->second.value("message", status);
    }
    return o;
}

void print_summary(const Outcomes& o, const BatchArguments& a, const std::string& log, const BatchProgress& progress) {
    if (a.segment.json) {
        Json json{{"meshes", o.meshes},   {"ok", o.ok},       {"partial", o.partial}, {"failed", o.failed},
                  {"missing", o.missing}, {"kinds", o.kinds}, {"log", log},           {"seconds", progress.seconds()}};
        std::cout << to_line(json) << std::flush;
        return;
    }
    if (a.segment.quiet) return;
    std::printf("%zu meshes: %zu done, %zu partial, %zu failed", o.meshes, o.ok, o.partial, o.failed);
    if (o.missing > 0) std::printf(", %zu not done", o.missing);
    const double seconds = std::max(progress.seconds(), 1e-3);
    std::printf("; %.1f s, %.3g faces/s\n", seconds, static_cast<double>(progress.faces()) / seconds);
    for (const auto& [kind, count] : o.kinds) {
        std::printf("  %-8s %6zu   %s\n", kind.c_str(), count, o.first_message.at(kind).c_str());
    }
    std::printf("log: %s\n", log.c_str());
}

int exit_code_of(const Outcomes& o) {
    if (o.missing > 0) return exit_stopped;
    if (o.kinds.contains("crash") || o.kinds.contains("defect")) return exit_defect;
    if (o.failed > 0) return exit_input;
    return o.partial > 0 ? exit_stopped : exit_done;
}

void print_list(const std::vector<BatchItem>& items) {
    for (const BatchItem& item : items) {
        std::cout << to_line({{"mesh", item.mesh}, {"name", item.name}, {"bytes", item.bytes}});
    }
    std::cout << std::flush;
}

int run_batch(BatchArguments& a) {
    const Shard shard = parse_shard(a.shard);
    WorkerSettings settings = worker_settings(a);
    const int jobs = job_count(a);
    // Many meshes at once use the cores better than many threads a mesh.
    const int threads = a.segment.threads > 0 ? a.segment.threads : std::max(1, job_count({}) / jobs);
    const auto all = list_meshes(a.segment.mesh, a.segment.folder);
    const auto items = share_of(all, shard);

    make_folder(settings.output);
    const std::string log_path = settings.output + "/results" + shard_suffix(shard) + ".jsonl";
    ResultsLog log(log_path);
    if (!a.resume && !a.retry && !log.records().empty()) {
        throw Error(ErrorCode::invalid_argument,
                    log_path + ": is there from an earlier batch: --resume goes on with it; or give another folder");
    }
    // The log is locked: what is in this scratch folder was left by a process that is gone.
    settings.scratch = settings.output + "/.unfinished" + shard_suffix(shard);
    fs::remove_all(settings.scratch);
    check_same_options(settings.output, settings);
    const auto rest = not_done(items, log, a.retry);
    if (a.list) {
        print_list(rest);
        return exit_done;
    }
    settings.bounds.insert(settings.bounds.end(), {"--threads", std::to_string(threads)});

    std::uintmax_t bytes = 0;
    for (const BatchItem& item : rest) bytes += item.bytes;
    BatchProgress progress(a.segment.progress_mode(), rest.size(), bytes);
    const bool finished = run_all(rest, settings, jobs, log, progress);
    progress.finish();
    std::error_code ignored;
    fs::remove_all(settings.scratch, ignored);
    const Outcomes outcomes = outcomes_of(items, log);
    print_summary(outcomes, a, log_path, progress);
    return finished ? exit_code_of(outcomes) : exit_stopped;
}

/// One mesh as a batch would do it, its record to stdout: for schedulers that distribute meshes themselves.
int run_item(BatchArguments& a) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // when its scheduler's worker is lost, the mesh is done elsewhere
    WorkerSettings settings = worker_settings(a);
    make_folder(settings.output);
    std::array<char, 256> host{};
    gethostname(host.data(), host.size() - 1);
    settings.scratch = settings.output + "/.unfinished-" + std::string(host.data()) + "-" + std::to_string(getpid());
    settings.bounds.insert(settings.bounds.end(), {"--threads", std::to_string(std::max(1, a.segment.threads))});
    const auto remove_scratch = [&] {
        std::error_code ignored;
        fs::remove_all(settings.scratch, ignored);
    };
    try {
        SignalQueue signals;
        Worker worker(settings, {a.segment.mesh, a.name, 0}, 0);
        while (!worker.ended()) {
            if (signals.stop_requested()) {
                remove_scratch();
                return exit_stopped;
            }
            worker.kill_if_late();
        }
        std::cout << to_line(worker.finish()) << std::flush;
    } catch (...) {
        remove_scratch();
        throw;
    }
    remove_scratch();
    return exit_done;
}

}  // namespace

Command add_batch(CLI::App& app) {
    const auto a = std::make_shared<BatchArguments>();
    CLI::App* command = app.add_subcommand("batch", "Segments many meshes, each in a process of its own; resumable");
    add_item_options(*command, *a);
    command->get_option("mesh")->description("Folder of meshes, or manifest: PATH or PATH<tab>NAME a line");
    command->get_option("--output")->description("Folder for results.jsonl and a folder for each mesh");
    command->get_option("--threads")->description("At most so many threads a mesh, 0: cores / jobs");
    const char* group = "Batch";
    command->add_option("--jobs", a->jobs, "Meshes at once, 0: one a core")
        ->check(CLI::Range(0, 4096))
        ->capture_default_str()
        ->group(group);
    command->add_flag("--resume", a->resume, "Go on with what is not in the log yet")->group(group);
    command->add_flag("--retry", a->retry, "Like --resume, and do again what is not complete")->group(group);
    command->add_option("--shard", a->shard, "i/n: do the i-th of n shares, for job arrays")
        ->capture_default_str()
        ->group(group);
    command->add_flag("--list", a->list, "Print what is to be done as JSON Lines, and do nothing")->group(group);
    return [a] { return run_batch(*a); };
}

Command add_batch_item(CLI::App& app) {
    const auto a = std::make_shared<BatchArguments>();
    // Without a group it is not shown in the help: for quadseg.distributed.
    CLI::App* command = app.add_subcommand("batch-item", "One mesh of a batch")->group("");
    add_item_options(*command, *a);
    command->add_option("--name", a->name, "Folder of this mesh below the output folder")->required();
    return [a] { return run_item(*a); };
}

}  // namespace quadseg::cli
