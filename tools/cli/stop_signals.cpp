#include "tools/cli/stop_signals.h"

#include <array>
#include <atomic>
#include <csignal>

namespace quadseg::cli {
namespace {

constexpr std::array stop_signals{SIGINT, SIGTERM};
// A handler can reach nothing but globals; Context::cancel() is one atomic store.
std::atomic<Context*> watched{nullptr};

extern "C" void cancel_watched(int) {
    if (Context* context = watched.load()) context->cancel();
}

}  // namespace

StopSignals::StopSignals(Context& context) {
    watched.store(&context);
    struct sigaction action {};
    action.sa_handler = cancel_watched;
    action.sa_flags = static_cast<int>(SA_RESETHAND | static_cast<unsigned>(SA_RESTART));
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
