// A program run in a process of its own, and what it used.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace quadseg::bench {

struct ChildResult {
    int exit_code = -1;  ///< 128 + signal when a signal ended it
    bool timed_out = false;
    double wall_seconds = 0;  ///< from just before its start until it was gone
    double cpu_seconds = 0;   ///< user and system, all threads
    std::size_t peak_bytes = 0;
};

/// Runs arguments[0] with the rest as its arguments; stdout and stderr go to `log` (appended; empty: discarded). A
/// program that outlasts `time_limit` seconds (0: none) is killed. Throws std::runtime_error if it can't be started.
ChildResult run_child(const std::vector<std::string>& arguments, const std::string& log = {}, double time_limit = 0);

/// A folder that lasts as long as the object.
class TemporaryFolder {
  public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    std::string file(const std::string& name) const { return path_ + "/" + name; }
    const std::string& path() const noexcept { return path_; }

  private:
    std::string path_;
};

}  // namespace quadseg::bench
