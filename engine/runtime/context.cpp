#include <quadseg/context.h>
#include <quadseg/error.h>

#include "runtime/context_state.h"

#include <cmath>
#include <string>
#include <utility>

namespace quadseg {

Context::Context() : state_(std::make_shared<State>()) {}

void Context::cancel() noexcept {
    state_->cancelled.store(true, std::memory_order_relaxed);
}

bool Context::cancelled() const noexcept {
    return state_->cancelled.load(std::memory_order_relaxed);
}

void Context::set_deadline(Clock::time_point when) {
    state_->deadline.store(when.time_since_epoch().count(), std::memory_order_relaxed);
}

void Context::set_time_limit(double seconds) {
    if (!(seconds > 0)) {
        throw Error(ErrorCode::invalid_argument,
                    "time limit: must be above 0 seconds, but is " + std::to_string(seconds));
    }
    const Clock::time_point now = Clock::now();
    const std::chrono::duration<double> room = Clock::time_point::max() - now;
    if (seconds >= 0.5 * room.count()) {  // centuries: as good as none, and the sum would overflow
        state_->deadline.store(State::no_deadline, std::memory_order_relaxed);
    } else {
        set_deadline(now + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds)));
    }
}

bool Context::past_deadline() const noexcept {
    return state_->past_deadline();
}

void Context::set_threads(int threads) {
    if (threads < 0) {
        throw Error(ErrorCode::invalid_argument,
                    "threads: must be 0 (as many as there are) or more, but is " + std::to_string(threads));
    }
    state_->threads.store(threads, std::memory_order_relaxed);
}

int Context::threads() const noexcept {
    return state_->threads.load(std::memory_order_relaxed);
}

void Context::set_memory_limit(std::size_t bytes) {
    state_->memory_limit.store(bytes, std::memory_order_relaxed);
}

std::size_t Context::memory_limit() const noexcept {
    return state_->memory_limit.load(std::memory_order_relaxed);
}

void Context::on_progress(ProgressFunction function) {
    state_->progress = std::move(function);
}

}  // namespace quadseg
