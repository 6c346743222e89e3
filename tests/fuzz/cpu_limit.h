// A unit may take so much CPU time. libFuzzer's -timeout counts the wall's, which a busy machine stretches and which
// runs on while the process is stopped; run with -timeout=0.
#pragma once

#include <csignal>
#include <ctime>

namespace quadseg::fuzz {

/// While it lives, the process is aborted once it has used `seconds` more: libFuzzer then keeps the unit.
class CpuLimit {
  public:
    explicit CpuLimit(int seconds) {
        timer();  // made by the first unit
        set(seconds);
    }
    ~CpuLimit() { set(0); }
    CpuLimit(const CpuLimit&) = delete;
    CpuLimit& operator=(const CpuLimit&) = delete;

  private:
    static timer_t timer() {
        static const timer_t one = [] {
            sigevent event{};
            event.sigev_notify = SIGEV_SIGNAL;
            event.sigev_signo = SIGABRT;
            timer_t made{};
            if (timer_create(CLOCK_PROCESS_CPUTIME_ID, &event, &made) != 0) __builtin_trap();
            return made;
        }();
        return one;
    }
    static void set(int seconds) {
        itimerspec time{};
        time.it_value.tv_sec = seconds;
        timer_settime(timer(), 0, &time, nullptr);
    }
};

}  // namespace quadseg::fuzz
