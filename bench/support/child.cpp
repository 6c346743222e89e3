#include "bench/support/child.h"

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <spawn.h>
#include <stdexcept>
#include <sys/resource.h>
#include <sys/wait.h>
#include <thread>

extern char** environ;

namespace quadseg::bench {
namespace {

using Clock = std::chrono::steady_clock;

double seconds(const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

class FileActions {
  public:
    explicit FileActions(const std::string& log) {
        posix_spawn_file_actions_init(&actions_);
        const char* target = log.empty() ? "/dev/null" : log.c_str();
        posix_spawn_file_actions_addopen(&actions_, 0, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_addopen(&actions_, 1, target, O_WRONLY | O_CREAT | O_APPEND, 0644);
        posix_spawn_file_actions_adddup2(&actions_, 1, 2);
    }
    ~FileActions() { posix_spawn_file_actions_destroy(&actions_); }
    FileActions(const FileActions&) = delete;
    FileActions& operator=(const FileActions&) = delete;
    const posix_spawn_file_actions_t* get() const noexcept { return &actions_; }

  private:
    posix_spawn_file_actions_t actions_;
};

}  // namespace

// The peak of a child counts from its parent's size on (Linux keeps the larger of the two over exec): callers stay
// small and leave meshes to their children.
ChildResult run_child(const std::vector<std::string>& arguments, const std::string& log, double time_limit) {
    std::vector<char*> argv;
    argv.reserve(arguments.size() + 1);
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    const FileActions actions(log);
    const Clock::time_point start = Clock::now();
    const auto elapsed = [start] { return std::chrono::duration<double>(Clock::now() - start).count(); };
    pid_t child = 0;
    const int error = posix_spawnp(&child, argv[0], actions.get(), nullptr, argv.data(), environ);
    if (error != 0) throw std::runtime_error(arguments.at(0) + ": " + std::strerror(error));

    ChildResult result;
    // The watcher only sleeps, so that the wait below returns at the moment the child ends.
    std::jthread watcher;
    std::atomic<bool> killed = false;
    if (time_limit > 0) {
        watcher = std::jthread([&, child](const std::stop_token& stop) {
            while (!stop.stop_requested()) {
                if (elapsed() > time_limit) {
                    killed = true;
                    kill(child, SIGKILL);
                    return;
                }
                std::this_thread::sleep_for(std::chrono::milliseconds(20));
            }
        });
    }
    int status = 0;
    rusage usage{};
    siginfo_t info{};
    while (waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOWAIT) < 0 && errno == EINTR) {
    }
    result.wall_seconds = elapsed();
    if (watcher.joinable()) {
        watcher.request_stop();
        watcher.join();
    }
    while (wait4(child, &status, 0, &usage) < 0 && errno == EINTR) {
    }
    result.timed_out = killed;
    result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    result.cpu_seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
    result.peak_bytes = static_cast<std::size_t>(usage.ru_maxrss) * 1024;
    return result;
}

TemporaryFolder::TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "quadseg-bench-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder: " + pattern);
    path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

}  // namespace quadseg::bench
