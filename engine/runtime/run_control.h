// How every long loop of the library asks whether it may go on, and tells how far it is.
#pragma once

#include <quadseg/context.h>

#include <atomic>
#include <cstddef>
#include <memory>

namespace quadseg::runtime {

/// Thrown by RunControl::check() anywhere inside a call; caught where a best partial result can be made of it.
struct Stopped {
    bool deadline;  ///< else cancelled
};

/// One a call. Cheap to ask from any thread.
class RunControl {
  public:
    /// context may be null: never stops.
    explicit RunControl(Context* context);

    bool should_stop() const noexcept;
    /// Why a call that was stopped was stopped: cancelled, else its deadline has passed.
    bool cancelled() const noexcept;
    /// Throws Stopped when cancelled or past the deadline. Call at least every 10 ms of work (a chunk of ≤ ~20,000
    /// faces).
    void check() const;
    /// Every 256th call checks: for tight loops.
    void check_often(std::size_t& counter) const {
        if ((++counter & 255U) == 0) check();
    }

    /// `phase` is under way: fraction 0..1 of the whole call. Monotone by construction: a fraction below an earlier one
    /// is reported as that one. Any thread may report; at most about 50 reports a second reach the callback, and they
    /// reach it one by one.
    void report(Phase phase, double fraction, std::size_t regions = 0, double energy = 0) const;
    /// From now on should_stop() and check() say no: for the last, bounded steps that make a result of a stopped run.
    void ignore_stop() noexcept { ignore_.store(true, std::memory_order_relaxed); }

  private:
    std::shared_ptr<Context::State> state_;
    std::atomic<bool> ignore_{false};
    // Progress of this call; written inside the callback's guard only.
    mutable std::atomic<Context::Clock::rep> next_report_{0};
    mutable std::atomic<int> phase_{-1};
    mutable std::atomic<double> fraction_{0};
};

}  // namespace quadseg::runtime
