#include "tools/cli/stop_signals.h"

#include <array>
#include <atomic>
#include <csignal>
#include <ctime>

namespace quadseg::cli {
namespace {

constexpr std::array stop_signals{SIGINT, SIGTERM};
// A handler can reach nothing but globals; Context::cancel() is one atomic store.
std::atomic<Context*> watched{nullptr};
std::atomic<long> first_signal{0};  ///< milliseconds; 0: none yet

/// timeout(1) signals the process and its group: two signals that mean one.
constexpr long same_signal = 200;

long milliseconds() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * 1000 + now.tv_nsec / 1000000;
}

/// The first one asks the call to stop; one that comes later means it.
extern "C" void cancel_watched(int signal) {
    const long now = milliseconds();
    long first = 0;
    if (first_signal.compare_exchange_strong(first, now)) {
        if (Context* context = watched.load()) context->cancel();
    } else if (now - first > same_signal) {
        std::signal(signal, SIG_DFL);
        std::raise(signal);
    }
}

}  // namespace

StopSignals::StopSignals(Context& context) {
    watched.store(&context);
    first_signal.store(0);
    struct sigaction action {};
    action.sa_handler = cancel_watched;
    action.sa_flags = SA_RESTART;
    for (const int signal : stop_signals) {
        struct sigaction before {};
        // What the parent process has chosen to ignore (nohup) stays ignored.
        if (sigaction(signal, nullptr, &before) == 0 && before.sa_handler == SIG_IGN) continue;
        sigaction(signal, &action, nullptr);
    }
}

StopSignals::~StopSignals() {
    for (const int signal : stop_signals) {
        struct sigaction now {};
        if (sigaction(signal, nullptr, &now) == 0 && now.sa_handler == cancel_watched) std::signal(signal, SIG_DFL);
    }
    watched.store(nullptr);
}

}  // namespace quadseg::cli
