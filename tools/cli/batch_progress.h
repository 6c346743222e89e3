// Progress of a batch on stderr: one bar for all meshes, with throughput and estimate.
#pragma once

#include "tools/cli/progress.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>

namespace quadseg::cli {

class BatchProgress {
  public:
    BatchProgress(ProgressMode mode, std::size_t meshes, std::uintmax_t bytes);
    ~BatchProgress();
    BatchProgress(const BatchProgress&) = delete;
    BatchProgress& operator=(const BatchProgress&) = delete;

    void add(bool failed, std::uintmax_t bytes, std::size_t faces);
    /// Shows where the batch is, not too often.
    void show();
    /// Wipes the bar off the terminal.
    void finish();
    double seconds() const;
    std::size_t faces() const noexcept { return faces_; }

  private:
    using Clock = std::chrono::steady_clock;
    std::string text() const;

    bool active_, terminal_, eager_;
    bool drawn_ = false;
    std::size_t meshes_, done_ = 0, failed_ = 0, faces_ = 0;
    std::uintmax_t bytes_, bytes_done_ = 0;
    Clock::time_point start_ = Clock::now(), last_ = start_;
};

}  // namespace quadseg::cli
