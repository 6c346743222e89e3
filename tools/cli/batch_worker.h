// One mesh of a batch in a process of its own, so that whatever happens to it happens to it alone.
#pragma once

#include "tools/cli/batch_manifest.h"
#include "tools/cli/report.h"

#include <chrono>
#include <cstddef>
#include <string>
#include <sys/types.h>
#include <vector>

namespace quadseg::cli {

struct WorkerSettings {
    std::string output;                ///< folder of the batch
    std::string scratch;               ///< folder below it, of this process alone
    std::vector<std::string> options;  ///< of `segment`, that decide what comes out
    std::vector<std::string> bounds;   ///< of `segment`, that decide what it may use
    double timeout = 0;                ///< seconds, then a partial result; 0: none
    double grace = 10;                 ///< seconds after the time-out until the process is killed
    std::size_t memory_limit = 0;      ///< bytes of data, 0: none
};

/// Starts, watches and ends the process of one mesh, then puts its files in place.
class Worker {
  public:
    using Clock = std::chrono::steady_clock;

    /// Throws Error file_write, internal (no process to be had).
    Worker(const WorkerSettings& settings, const BatchItem& item, std::size_t number);
    /// Kills the process if it still runs and takes its unfinished files away.
    ~Worker();
    Worker(Worker&& other) noexcept;
    Worker& operator=(Worker&&) = delete;
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;

    const BatchItem& item() const noexcept { return item_; }
    /// Kills a process that is past its time-out and grace.
    void kill_if_late();
    /// Has it ended? Then finish() is to be called.
    bool ended();
    /// Files under their final name and on disk (complete and partial results), nothing of other outcomes; returns the
    /// record for the log. Throws Error file_write.
    Json finish();

  private:
    Json outcome() const;
    void publish() const;

    const WorkerSettings* settings_;
    BatchItem item_;
    std::string folder_;  ///< scratch of this mesh: "files", "stderr.txt"
    pid_t process_ = -1;
    int status_ = 0;
    std::size_t peak_bytes_ = 0;
    bool killed_late_ = false;
    Clock::time_point start_ = Clock::now();
    double seconds_ = 0;
};

}  // namespace quadseg::cli
