// Progress on stderr: a bar on a terminal, lines otherwise.
#pragma once

#include <quadseg/context.h>

#include <chrono>
#include <string>

namespace quadseg::cli {

enum class ProgressMode { automatic, always, never };

/// Shows one job that consists of several calls, each a part of the bar. Driven by one thread at a time.
class ProgressDisplay {
  public:
    explicit ProgressDisplay(ProgressMode mode);
    ~ProgressDisplay();
    ProgressDisplay(const ProgressDisplay&) = delete;
    ProgressDisplay& operator=(const ProgressDisplay&) = delete;

    /// What the context reports from now on is the part `from` to `to` of the job.
    void attach(Context& context, double from, double to);
    void show(const Progress& progress);
    /// Wipes the bar off the terminal, so that messages stand alone.
    void finish();

  private:
    using Clock = std::chrono::steady_clock;

    std::string text(double fraction) const;
    void draw_bar(double fraction);
    void print_line(double fraction);

    bool active_;
    bool terminal_;
    bool eager_;  ///< lines at once, not only for jobs of a second and more
    bool drawn_ = false;
    double from_ = 0, to_ = 1;
    double shown_ = 0;  ///< never falls
    Progress latest_;
    Phase line_phase_ = Phase::read;
    bool line_printed_ = false;
    Clock::time_point start_ = Clock::now();
    Clock::time_point last_ = start_;
};

}  // namespace quadseg::cli
