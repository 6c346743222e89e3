#include "tools/cli/progress.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sys/ioctl.h>
#include <unistd.h>

namespace quadseg::cli {
namespace {

using namespace std::chrono_literals;

std::size_t terminal_width() {
    winsize size{};
    if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
    return 80;
}

}  // namespace

ProgressDisplay::ProgressDisplay(ProgressMode mode)
    : active_(mode != ProgressMode::never),
      terminal_(isatty(STDERR_FILENO) == 1),
      eager_(mode == ProgressMode::always) {}

ProgressDisplay::~ProgressDisplay() {
    finish();
}

void ProgressDisplay::attach(Context& context, double from, double to) {
    if (!active_) return;
    from_ = from;
    to_ = to;
    context.on_progress([this](const Progress& progress) {
        show(progress);
        return true;
    });
}

void ProgressDisplay::show(const Progress& progress) {
    if (!active_) return;
    latest_ = progress;
    shown_ = std::max(shown_, from_ + (to_ - from_) * std::clamp(progress.fraction, 0.0, 1.0));
    if (terminal_) {
        draw_bar(shown_);
    } else {
        print_line(shown_);
    }
}

std::string ProgressDisplay::text(double fraction) const {
    char buffer[128];
    std::snprintf(buffer, sizeof buffer, "%3.0f %%  %-7s", std::floor(100 * fraction), to_string(latest_.phase));
    std::string result = buffer;
    if (latest_.regions > 0) {
        std::snprintf(buffer, sizeof buffer, "  %zu regions", latest_.regions);
        result += buffer;
    }
    if (latest_.energy > 0) {
        std::snprintf(buffer, sizeof buffer, "  energy %.3g", latest_.energy);
        result += buffer;
    }
    return result;
}

void ProgressDisplay::draw_bar(double fraction) {
    const auto now = Clock::now();
    if (drawn_ && now - last_ < 40ms) return;
    last_ = now;
    drawn_ = true;
    constexpr std::size_t cells = 28;
    const auto full = static_cast<std::size_t>(fraction * cells);
    std::string line = " [";
    for (std::size_t i = 0; i < cells; ++i) line += i < full ? '#' : '.';
    line += "] " + text(fraction);
    line.resize(std::min(line.size(), terminal_width() - 1));
    std::fprintf(stderr, "\r%s\033[K", line.c_str());
    std::fflush(stderr);
}

void ProgressDisplay::print_line(double fraction) {
    const auto now = Clock::now();
    if (!eager_ && now - start_ < 1s) return;
    if (line_printed_ && latest_.phase == line_phase_ && now - last_ < 1s) return;
    last_ = now;
    line_phase_ = latest_.phase;
    line_printed_ = true;
    std::fprintf(stderr, "quadseg: %s\n", text(fraction).c_str());
}

void ProgressDisplay::finish() {
    if (drawn_) {
        std::fprintf(stderr, "\r\033[K");
        std::fflush(stderr);
    }
    drawn_ = false;
}

}  // namespace quadseg::cli
