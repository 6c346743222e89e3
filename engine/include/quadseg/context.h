// How a caller watches, bounds and stops a call.
#pragma once

#include <quadseg/export.h>

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>

namespace quadseg {

enum class Phase { read, prepare, coarse, fine, post, write };

/// "read" and so on. Never null.
QUADSEG_API const char* to_string(Phase phase) noexcept;

struct Progress {
    Phase phase = Phase::read;
    double fraction = 0;      ///< of the whole call, 0 to 1, never falls during one call
    std::size_t regions = 0;  ///< current number of regions, 0 while there are none
    double energy = 0;        ///< current hybrid energy in the unit cube, 0 while unknown
};

/// Handed to a call as its last argument. A copy shares the state of its original. cancel() may be called from any
/// thread and from a signal handler; everything else is to be set before the call. One Context may serve several calls,
/// also at once; a cancelled Context stays cancelled.
class QUADSEG_API Context {
  public:
    using Clock = std::chrono::steady_clock;
    /// Called from the calling thread's arena, one call at a time, at most about 50 times a second; returning false
    /// cancels.
    using ProgressFunction = std::function<bool(const Progress&)>;

    Context();

    void cancel() noexcept;
    bool cancelled() const noexcept;

    /// The call stops soon after the deadline (aim: 50 ms; figures in tests/RELIABILITY.md) and returns its best
    /// partial result, marked.
    void set_deadline(Clock::time_point when);
    /// Deadline `seconds` from now. Throws Error invalid_argument unless seconds > 0.
    void set_time_limit(double seconds);
    bool past_deadline() const noexcept;

    /// At most `threads` threads take part in a call; 0 (default): as many as the caller's TBB arena has.
    void set_threads(int threads);
    int threads() const noexcept;

    /// A call that would need more than `bytes` (estimated from its input) refuses with Error memory_limit; 0: no
    /// limit.
    void set_memory_limit(std::size_t bytes);
    std::size_t memory_limit() const noexcept;

    void on_progress(ProgressFunction function);

    struct State;
    const std::shared_ptr<State>& state() const noexcept { return state_; }

  private:
    std::shared_ptr<State> state_;
};

}  // namespace quadseg
