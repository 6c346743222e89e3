#include "tools/cli/batch_worker.h"

#include <quadseg/error.h>

#include "tools/cli/batch_log.h"
#include "tools/cli/exit_code.h"
#include "tools/cli/files.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace quadseg::cli {
namespace {

namespace fs = std::filesystem;

constexpr int exit_not_started = 127;

void remove_tree(const fs::path& path) {
    std::error_code ignored;
    fs::remove_all(path, ignored);
}

std::string seconds_text(double seconds) {
    std::ostringstream text;
    text << seconds;
    return text.str();
}

/// The last line of what the program had to say, without its name before it.
std::string last_line(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::string line, last;
    while (std::getline(file, line)) {
        if (!line.empty()) last = line;
    }
    constexpr const char* program = "quadseg: ";
    if (last.starts_with(program)) last.erase(0, std::strlen(program));
    constexpr std::size_t longest = 1000;
    return last.substr(0, longest);
}

/// Also what TBB says where the limit has no room for a thread's stack.
bool of_memory(const std::string& message) {
    return message.find("out of memory") != std::string::npos || message.find("pthread_create") != std::string::npos;
}

std::string limit_text(std::size_t bytes) {
    return bytes == 0 ? "" : "; the limit is " + std::to_string(bytes >> 20U) + " MiB";
}

/// Everything of a folder on disk, the folder last.
void sync_tree(const fs::path& folder) {
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (!entry.is_regular_file()) continue;
        const int file = open(entry.path().c_str(), O_RDONLY | O_CLOEXEC);
        const bool synced = file >= 0 && fsync(file) == 0;
        const int error = errno;
        if (file >= 0) close(file);
        if (!synced) {
            throw Error(ErrorCode::file_write,
                        entry.path().string() + ": can't flush to disk: " + std::strerror(error));
        }
    }
    sync_folder(folder.string());
}

/// In the child, between fork and exec: only what is allowed after a fork.
[[noreturn]] void become(char* const* arguments, const char* messages, std::size_t memory_limit, pid_t parent) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);                  // a batch that is killed leaves no one behind
    if (getppid() != parent) _exit(exit_not_started);  // it died before that
    setpgid(0, 0);                                     // Ctrl-C is the batch's to handle
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
    if (memory_limit > 0) {
        const rlimit limit{memory_limit, memory_limit};
        setrlimit(RLIMIT_DATA, &limit);
    }
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    const int nothing = open("/dev/null", O_RDWR);
    const int text = open(messages, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    if (nothing < 0 || text < 0) _exit(exit_not_started);
    dup2(nothing, STDIN_FILENO);
    dup2(nothing, STDOUT_FILENO);
    dup2(text, STDERR_FILENO);
    execv("/proc/self/exe", arguments);
    _exit(exit_not_started);
}

}  // namespace

Worker::Worker(const WorkerSettings& settings, const BatchItem& item, std::size_t number)
    : settings_(&settings), item_(item), folder_(settings.scratch + "/" + std::to_string(number)) {
    remove_tree(folder_);
    make_folder(folder_);
    std::vector<std::string> words{"quadseg",          "segment", item.mesh,    "-o",
                                   folder_ + "/files", "--quiet", "--progress", "never"};
    if (settings.timeout > 0) words.insert(words.end(), {"--timeout", seconds_text(settings.timeout)});
    words.insert(words.end(), settings.options.begin(), settings.options.end());
    words.insert(words.end(), settings.bounds.begin(), settings.bounds.end());
    std::vector<char*> arguments;
    arguments.reserve(words.size() + 1);
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const std::string messages = folder_ + "/stderr.txt";
    const pid_t parent = getpid();
    process_ = fork();
    if (process_ == 0) become(arguments.data(), messages.c_str(), settings.memory_limit, parent);
    if (process_ < 0) {
        remove_tree(folder_);
        throw Error(ErrorCode::internal, std::string("can't start a process: ") + std::strerror(errno));
    }
}

Worker::Worker(Worker&& other) noexcept
    : settings_(other.settings_),
      item_(std::move(other.item_)),
      folder_(std::exchange(other.folder_, {})),
      process_(std::exchange(other.process_, -1)),
      status_(other.status_),
      peak_bytes_(other.peak_bytes_),
      killed_late_(other.killed_late_),
      start_(other.start_),
      seconds_(other.seconds_) {}

Worker::~Worker() {
    if (process_ > 0) {
        kill(process_, SIGKILL);
        while (waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
        }
    }
    if (!folder_.empty()) remove_tree(folder_);
}

void Worker::kill_if_late() {
    if (settings_->timeout <= 0 || process_ <= 0) return;
    if (std::chrono::duration<double>(Clock::now() - start_).count() < settings_->timeout + settings_->grace) return;
    killed_late_ = true;
    kill(process_, SIGKILL);
}

bool Worker::ended() {
    if (process_ <= 0) return true;
    rusage usage{};
    if (wait4(process_, &status_, WNOHANG, &usage) != process_) return false;
    process_ = -1;
    peak_bytes_ = static_cast<std::size_t>(usage.ru_maxrss) * 1024;
    seconds_ = std::chrono::duration<double>(Clock::now() - start_).count();
    return true;
}

Json Worker::outcome() const {
    const bool has_result = fs::exists(folder_ + "/files/result.json");
    const std::string message = last_line(folder_ + "/stderr.txt");
    const auto failed = [&](const char* kind, const std::string& text) -> Json {
        return {{"status", "failed"}, {"kind", kind}, {"message", text}};
    };
    if (killed_late_) {
        return failed("timeout", "killed " + seconds_text(settings_->grace) + " s after its time-out");
    }
    if (WIFSIGNALED(status_)) {
        const int signal = WTERMSIG(status_);
        const std::string name = std::string("SIG") + (sigabbrev_np(signal) ? sigabbrev_np(signal) : "?");
        if (signal == SIGKILL) return failed("killed", "killed from outside, perhaps by the system for its memory");
        return failed("crash", "ended by " + name + (message.empty() ? "" : ": " + message));
    }
    switch (WEXITSTATUS(status_)) {
        case exit_done:
            if (has_result) return {{"status", "ok"}};
            return failed("defect", "no result was written");
        case exit_stopped:
            if (has_result) return {{"status", "partial"}, {"kind", "timeout"}};
            return failed("timeout", message);
        case exit_input:
            return failed(message.find("limit is") != std::string::npos ? "memory" : "input", message);
        case exit_usage:
            return failed("usage", message);
        case exit_not_started:
            return failed("defect", "the process could not be started");
        default:
            if (!of_memory(message)) return failed("defect", message);
            return failed("memory", message + limit_text(settings_->memory_limit));
    }
}

void Worker::publish() const {
    const fs::path files = fs::path(folder_) / "files", target = fs::path(settings_->output) / item_.name;
    sync_tree(files);
    make_folder(target.parent_path().string());
    std::error_code error;
    // There when a batch was killed between this place and the log, or when a mesh is done again.
    if (fs::exists(target)) fs::rename(target, fs::path(folder_) / "replaced", error);
    if (!error) fs::rename(files, target, error);
    if (error) throw Error(ErrorCode::file_write, target.string() + ": can't put results here: " + error.message());
    sync_folder(target.parent_path().string());
}

Json Worker::finish() {
    Json record{{"mesh", item_.mesh}, {"name", item_.name}};
    record.update(outcome());
    if (record["status"] != "failed") {
        try {
            std::ifstream file(folder_ + "/files/result.json", std::ios::binary);
            const Json result = Json::parse(file);
            record["faces"] = result.at("input").at("faces");
            record["regions"] = result.at("regions").size();
            record["stop"] = result.at("stop");
            record["energy"] = result.at("energy").at("total");
            record["rms"] = result.at("rms");
            publish();
        } catch (const Json::exception& error) {
            record.update({{"status", "failed"}, {"kind", "defect"}, {"message", error.what()}});
        }
    }
    record["seconds"] = seconds_;
    record["peak_bytes"] = peak_bytes_;
    remove_tree(std::exchange(folder_, {}));
    return record;
}

}  // namespace quadseg::cli
