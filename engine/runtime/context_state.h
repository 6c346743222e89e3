// What all copies of a Context share. Everything that a running call reads is atomic.
#pragma once

#include <quadseg/context.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace quadseg {

struct Context::State {
    using Ticks = Clock::rep;
    static constexpr Ticks no_deadline = std::numeric_limits<Ticks>::max();

    std::atomic<bool> cancelled{false};  // lock-free: cancel() may come from a signal handler
    std::atomic<Ticks> deadline{no_deadline};
    std::atomic<int> threads{0};
    std::atomic<std::size_t> memory_limit{0};

    ProgressFunction progress;  // set before the call
    /// Set while a callback runs. A report that finds it set is dropped: waiting could deadlock when the callback
    /// itself runs tasks of the arena.
    std::atomic_flag in_callback = ATOMIC_FLAG_INIT;

    static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<Ticks>::is_always_lock_free);

    bool past_deadline() const noexcept {
        const Ticks when = deadline.load(std::memory_order_relaxed);
        return when != no_deadline && Clock::now().time_since_epoch().count() >= when;
    }
};

}  // namespace quadseg
