#include "tools/cli/batch_progress.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <unistd.h>

namespace quadseg::cli {

using namespace std::chrono_literals;

namespace {

std::string clock_text(double seconds) {
    const auto whole = static_cast<unsigned long>(std::lround(seconds));
    std::array<char, 48> buffer{};
    if (whole >= 3600) {
        std::snprintf(buffer.data(), buffer.size(), "%lu:%02lu:%02lu", whole / 3600, whole / 60 % 60, whole % 60);
    } else {
        std::snprintf(buffer.data(), buffer.size(), "%lu:%02lu", whole / 60, whole % 60);
    }
    return buffer.data();
}

}  // namespace

BatchProgress::BatchProgress(ProgressMode mode, std::size_t meshes, std::uintmax_t bytes)
    : active_(mode != ProgressMode::never),
      terminal_(isatty(STDERR_FILENO) == 1),
      eager_(mode == ProgressMode::always),
      meshes_(meshes),
      bytes_(bytes) {}

BatchProgress::~BatchProgress() {
    finish();
}

double BatchProgress::seconds() const {
    return std::chrono::duration<double>(Clock::now() - start_).count();
}

void BatchProgress::add(bool failed, std::uintmax_t bytes, std::size_t faces) {
    ++done_;
    failed_ += failed ? 1 : 0;
    bytes_done_ += bytes;
    faces_ += faces;
}

std::string BatchProgress::text() const {
    const double elapsed = std::max(seconds(), 1e-3);
    std::array<char, 160> buffer{};
    std::snprintf(buffer.data(), buffer.size(), "%zu/%zu meshes  %zu failed  %.3g meshes/s  %.3g faces/s", done_,
                  meshes_, failed_, static_cast<double>(done_) / elapsed, static_cast<double>(faces_) / elapsed);
    std::string line = buffer.data();
    // Work grows with the size of the files, so that is what the estimate goes by.
    const double share = bytes_ > 0    ? static_cast<double>(bytes_done_) / static_cast<double>(bytes_)
                         : meshes_ > 0 ? static_cast<double>(done_) / static_cast<double>(meshes_)
                                       : 1;
    if (done_ < meshes_ && share > 0) line += "  " + clock_text(elapsed * (1 - share) / share) + " left";
    return line;
}

void BatchProgress::show() {
    if (!active_) return;
    const auto now = Clock::now();
    if (terminal_) {
        if (drawn_ && now - last_ < 100ms && done_ < meshes_) return;
        constexpr std::size_t cells = 24;
        const std::size_t full = meshes_ > 0 ? done_ * cells / meshes_ : cells;
        std::fprintf(stderr, "\r [%s%s] %s\033[K", std::string(full, '#').c_str(),
                     std::string(cells - full, '.').c_str(), text().c_str());
        std::fflush(stderr);
        drawn_ = true;
    } else {
        if (now - last_ < (eager_ ? 1s : 10s)) return;
        std::fprintf(stderr, "quadseg: %s\n", text().c_str());
    }
    last_ = now;
}

void BatchProgress::finish() {
    if (drawn_) {
        std::fprintf(stderr, "\r\033[K");
        std::fflush(stderr);
    }
    drawn_ = false;
}

}  // namespace quadseg::cli
