#include "runtime/run_control.h"

#include "runtime/context_state.h"

#include <algorithm>

namespace quadseg::runtime {

namespace {

using Clock = Context::Clock;

constexpr Clock::rep report_interval =
    std::chrono::duration_cast<Clock::duration>(std::chrono::milliseconds(20)).count();

/// Clears the flag on every way out, a callback that throws included.
class CallbackGuard {
  public:
    explicit CallbackGuard(std::atomic_flag& flag)
        : flag_(flag), entered_(!flag.test_and_set(std::memory_order_acquire)) {}
    ~CallbackGuard() {
        if (entered_) flag_.clear(std::memory_order_release);
    }
    CallbackGuard(const CallbackGuard&) = delete;
    CallbackGuard& operator=(const CallbackGuard&) = delete;
    bool entered() const noexcept { return entered_; }

  private:
    std::atomic_flag& flag_;
    bool entered_;
};

}  // namespace

RunControl::RunControl(Context* context) : state_(context ? context->state() : nullptr) {}

bool RunControl::should_stop() const noexcept {
    if (!state_ || ignore_.load(std::memory_order_relaxed)) return false;
    return state_->cancelled.load(std::memory_order_relaxed) || state_->past_deadline();
}

bool RunControl::cancelled() const noexcept {
    return state_ && state_->cancelled.load(std::memory_order_relaxed);
}

void RunControl::check() const {
    if (!state_ || ignore_.load(std::memory_order_relaxed)) return;
    if (state_->cancelled.load(std::memory_order_relaxed)) throw Stopped{false};
    if (state_->past_deadline()) throw Stopped{true};
}

void RunControl::report(Phase phase, double fraction, std::size_t regions, double energy) const {
    if (!state_ || !state_->progress) return;
    const auto now = Clock::now().time_since_epoch().count();
    const int phase_number = static_cast<int>(phase);
    // A later phase and the end are worth a report of their own: there are few of them.
    const auto is_due = [&] {
        return now >= next_report_.load(std::memory_order_relaxed) ||
               phase_number > phase_.load(std::memory_order_relaxed) ||
               (fraction >= 1 && fraction_.load(std::memory_order_relaxed) < 1);
    };
    if (!is_due()) return;
    const CallbackGuard guard(state_->in_callback);
    if (!guard.entered() || !is_due()) return;
    next_report_.store(now + report_interval, std::memory_order_relaxed);
    phase_.store(std::max(phase_number, phase_.load(std::memory_order_relaxed)), std::memory_order_relaxed);
    const double reached = fraction_.load(std::memory_order_relaxed);
    const double shown =
        fraction > reached ? std::min(fraction, 1.0) : reached;  // NaN-safe: NaN shows what was reached
    fraction_.store(shown, std::memory_order_relaxed);
    if (!state_->progress(Progress{phase, shown, regions, energy})) {
        state_->cancelled.store(true, std::memory_order_relaxed);
    }
}

}  // namespace quadseg::runtime
