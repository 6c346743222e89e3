#include "runtime/run_control.h"

#include <quadseg/error.h>

#include "runtime/parallel.h"

#include <atomic>
#include <cmath>
#include <csignal>
#include <gtest/gtest.h>
#include <limits>
#include <stdexcept>
#include <thread>
#include <vector>

namespace quadseg::runtime {
namespace {

using namespace std::chrono_literals;

TEST(Context, CopiesShareTheirState) {
    Context a;
    const Context b = a;
    EXPECT_FALSE(b.cancelled());
    a.cancel();
    EXPECT_TRUE(b.cancelled());
    EXPECT_FALSE(Context().cancelled());
}

TEST(Context, KeepsItsSettings) {
    Context c;
    EXPECT_EQ(c.threads(), 0);
    EXPECT_EQ(c.memory_limit(), 0U);
    c.set_threads(3);
    c.set_memory_limit(1000);
    EXPECT_EQ(c.threads(), 3);
    EXPECT_EQ(c.memory_limit(), 1000U);
}

TEST(Context, RefusesSettingsOutOfRange) {
    Context c;
    for (const double seconds : {0.0, -1.0, std::nan("")}) {
        try {
            c.set_time_limit(seconds);
            FAIL() << seconds;
        } catch (const Error& e) {
            EXPECT_EQ(e.code(), ErrorCode::invalid_argument);
        }
    }
    EXPECT_THROW(c.set_threads(-1), Error);
    EXPECT_FALSE(c.past_deadline());
}

TEST(Context, HugeTimeLimitsAreNone) {
    Context c;
    for (const double seconds : {1e9, 1e30, 1e300, std::numeric_limits<double>::infinity()}) {
        c.set_time_limit(seconds);
        EXPECT_FALSE(c.past_deadline()) << seconds;
    }
}

TEST(Context, CanBeCancelledFromASignalHandler) {
    static Context* target = nullptr;
    Context c;
    target = &c;
    const auto before = std::signal(SIGUSR1, [](int) { target->cancel(); });
    std::raise(SIGUSR1);
    std::signal(SIGUSR1, before);
    EXPECT_TRUE(c.cancelled());
}

TEST(RunControl, WithoutContextNeverStops) {
    const RunControl control(nullptr);
    EXPECT_FALSE(control.should_stop());
    EXPECT_NO_THROW(control.check());
    control.report(Phase::fine, 0.5);
}

TEST(RunControl, StopsWhenCancelledAndSaysWhy) {
    Context c;
    RunControl control(&c);
    EXPECT_NO_THROW(control.check());
    c.cancel();
    EXPECT_TRUE(control.should_stop());
    try {
        control.check();
        FAIL();
    } catch (const Stopped& s) {
        EXPECT_FALSE(s.deadline);
    }
    control.ignore_stop();
    EXPECT_FALSE(control.should_stop());
    EXPECT_NO_THROW(control.check());
}

TEST(RunControl, StopsAtTheDeadline) {
    Context c;
    const RunControl control(&c);
    c.set_deadline(Context::Clock::now() + 1h);
    EXPECT_FALSE(control.should_stop());
    c.set_time_limit(0.01);
    const auto begin = Context::Clock::now();
    try {
        for (;;) control.check();
    } catch (const Stopped& s) {
        EXPECT_TRUE(s.deadline);
    }
    EXPECT_GE(Context::Clock::now() - begin, 9ms);
    EXPECT_TRUE(c.past_deadline());
}

TEST(RunControl, StopLeavesAParallelLoop) {
    Context c;
    const RunControl control(&c);
    std::atomic<std::size_t> done{0};
    EXPECT_THROW(parallel_for(1'000'000, 10,
                              [&](std::size_t i) {
                                  if (i == 5) c.cancel();
                                  control.check();
                                  ++done;
                              }),
                 Stopped);
    EXPECT_LT(done, 1'000'000U);
}

TEST(RunControl, CheckOftenChecksInTime) {
    Context c;
    c.cancel();
    const RunControl control(&c);
    std::size_t counter = 0;
    int calls = 0;
    EXPECT_THROW(for (; calls < 1000; ++calls) control.check_often(counter), Stopped);
    EXPECT_LT(calls, 256);
}

TEST(Progress, IsMonotoneThrottledAndEndsAtOne) {
    Context c;
    std::vector<Progress> seen;
    c.on_progress([&](const Progress& p) {
        seen.push_back(p);
        return true;
    });
    const RunControl control(&c);
    const auto begin = Context::Clock::now();
    for (int i = 0; i < 200'000; ++i) control.report(Phase::fine, (i % 1000) / 2000.0, 7, 0.25);
    control.report(Phase::post, std::nan(""));
    control.report(Phase::write, 2);
    const std::chrono::duration<double> seconds = Context::Clock::now() - begin;
    ASSERT_GE(seen.size(), 3U);
    EXPECT_LE(static_cast<double>(seen.size()), 4 + seconds.count() / 0.02);
    for (std::size_t i = 1; i < seen.size(); ++i) EXPECT_GE(seen[i].fraction, seen[i - 1].fraction);
    EXPECT_EQ(seen.front().regions, 7U);
    EXPECT_EQ(seen.front().energy, 0.25);
    EXPECT_EQ(seen.back().phase, Phase::write);
    EXPECT_EQ(seen.back().fraction, 1);
}

TEST(Progress, ReturningFalseCancels) {
    Context c;
    c.on_progress([](const Progress&) { return false; });
    const RunControl control(&c);
    control.report(Phase::read, 0.1);
    EXPECT_TRUE(c.cancelled());
    EXPECT_THROW(control.check(), Stopped);
}

TEST(Progress, OneCallAtATimeFromManyThreads) {
    Context c;
    std::atomic<int> inside{0}, calls{0};
    std::atomic<bool> overlapped{false};
    c.on_progress([&](const Progress&) {
        if (inside.fetch_add(1) != 0) overlapped = true;
        std::this_thread::sleep_for(2ms);
        inside.fetch_sub(1);
        ++calls;
        return true;
    });
    const RunControl first(&c), second(&c);  // two calls that share a context
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t) {
        threads.emplace_back([&, t] {
            for (int i = 0; i < 3000; ++i) {
                (t % 2 ? first : second).report(i % 2 ? Phase::fine : Phase::coarse, i / 3000.0);
                if (i % 100 == 0) std::this_thread::sleep_for(1ms);
            }
        });
    }
    for (auto& t : threads) t.join();
    EXPECT_FALSE(overlapped);
    EXPECT_GT(calls, 1);
}

TEST(Progress, CallbackThatThrowsLeavesTheContextUsable) {
    Context c;
    int calls = 0;
    c.on_progress([&](const Progress&) -> bool {
        if (++calls == 1) throw std::runtime_error("of the caller");
        return true;
    });
    const RunControl control(&c);
    EXPECT_THROW(control.report(Phase::read, 0), std::runtime_error);
    control.report(Phase::fine, 0.5);
    EXPECT_EQ(calls, 2);
}

TEST(Progress, CallbackMayUseTheArena) {
    Context c;
    const RunControl control(&c);
    std::atomic<int> calls{0};
    c.on_progress([&](const Progress&) {
        parallel_for(100, 1, [&](std::size_t) { control.report(Phase::post, 0.9); });  // dropped, no deadlock
        ++calls;
        return true;
    });
    parallel_for(100, 1, [&](std::size_t) { control.report(Phase::fine, 0.1); });
    EXPECT_GE(calls, 1);
}

}  // namespace
}  // namespace quadseg::runtime
