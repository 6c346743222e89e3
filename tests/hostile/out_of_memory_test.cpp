// Every allocation of small jobs fails once: std::bad_alloc, nothing lost, and the next job is as good as ever.
// Allocations inside TBB's own library are not reached by this.
#include "tests/hostile/failing_allocations.h"

#ifndef QUADSEG_THREAD_SANITIZER

#include <quadseg/error.h>
#include <quadseg/segmentation.h>
#include <quadseg/segmenter.h>

#include "tests/golden/shapes.h"
#include "tests/pipeline/result_checks.h"

#include <functional>
#include <gtest/gtest.h>

namespace quadseg::test {
namespace {

struct SmallJob {
    const char* name;
    std::function<void(Options&)> set;
    bool noisy = false;
    bool stepwise = false;
};

void PrintTo(const SmallJob& job, std::ostream* out) {
    *out << job.name;
}

class OutOfMemory : public testing::TestWithParam<SmallJob> {
  protected:
    void SetUp() override {
        shape_ = can(12, 3);
        Random random{9};
        for (double& x : shape_.positions) {
            if (GetParam().noisy) x += 1e-3 * static_cast<double>(random.below(1000)) / 1000;
        }
        GetParam().set(options_);
    }
    std::string run() const {
        Context context;
        context.set_threads(1);  // so that allocations have an order
        if (!GetParam().stepwise) return ResultBytes::of(segment(shape_.view(), options_, &context));
        Segmenter s(shape_.view(), options_, &context);
        s.insert();
        s.insert(7);
        s.relax(2);
        s.undo();
        s.run();
        return ResultBytes::of(s.result());
    }
    enum class End { done, out_of_memory, other };
    End end() const {
        try {
            run();
            return End::done;
        } catch (const std::bad_alloc&) {
            return End::out_of_memory;
        } catch (...) {
            return End::other;
        }
    }

    Shape shape_;
    Options options_;
};

TEST_P(OutOfMemory, AtEveryAllocation) {
    const std::string expected = run();
    run();
    const long before = live.load();
    allocations = 0;
    ASSERT_EQ(end(), End::done);
    const long total = allocations.load();
    ASSERT_EQ(live.load(), before) << "a job leaks";
    const bool thorough = std::getenv("QUADSEG_LONG_TESTS") != nullptr;
    const long stride = thorough ? 1 : std::max(1L, total / 120);
    for (long k = 0; k < total; k += k < 100 || k > total - 60 ? 1 : stride) {
        allocations = 0;
        failing = k;
        const End how = end();
        failing = -1;
        ASSERT_EQ(how, End::out_of_memory) << "allocation " << k << " of " << total;
        ASSERT_EQ(live.load(), before) << "allocation " << k << " of " << total << " leaves something behind";
    }
    EXPECT_TRUE(run() == expected);
}

INSTANTIATE_TEST_SUITE_P(Jobs, OutOfMemory,
                         testing::Values(SmallJob{"clean", [](Options&) {}}, SmallJob{"noisy", [](Options&) {}, true},
                                         SmallJob{"regions", [](Options& o) { o.regions = 3; }},
                                         SmallJob{"post",
                                                  [](Options& o) {
                                                      o.smooth = o.project = o.project_joint = true;
                                                      o.feature_angle = 30;
                                                  },
                                                  true},
                                         SmallJob{"paper",
                                                  [](Options& o) {
                                                      o.preset = Preset::paper;
                                                      o.regions = 3;
                                                  }},
                                         SmallJob{"paper_coarse",
                                                  [](Options& o) {
                                                      o.preset = Preset::paper;
                                                      o.regions = 3;
                                                      o.coarse = 50;
                                                  }},
                                         SmallJob{"stepwise", [](Options& o) { o.preset = Preset::paper; }, false,
                                                  true}),
                         [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace quadseg::test

#endif
