#include "runtime/parallel.h"

#include <atomic>
#include <cmath>
#include <gtest/gtest.h>
#include <stdexcept>
#include <string>
#include <tbb/global_control.h>

namespace quadseg::runtime {
namespace {

TEST(ParallelBlocks, VisitsEveryIndexOnceInBlocksOfTheGrain) {
    for (const std::size_t count : {0U, 1U, 9U, 10U, 11U, 1000U}) {
        std::vector<std::atomic<int>> visits(count);
        parallel_blocks(count, 10, [&](std::size_t begin, std::size_t end) {
            EXPECT_EQ(begin % 10, 0U);
            EXPECT_TRUE(end == begin + 10 || end == count);
            for (std::size_t i = begin; i < end; ++i) ++visits[i];
        });
        for (const auto& v : visits) EXPECT_EQ(v, 1);
    }
}

TEST(ParallelFor, PassesExceptionsOn) {
    EXPECT_THROW(parallel_for(1000, 1,
                              [](std::size_t i) {
                                  if (i == 567) throw std::runtime_error("567");
                              }),
                 std::runtime_error);
}

TEST(ReduceBlocks, SameBitsAtAnyNumberOfThreads) {
    const tbb::global_control more_than_cores(tbb::global_control::max_allowed_parallelism, 8);
    const auto harmonic = [] {
        return reduce_blocks(
            100'000, 64, 0.0,
            [](std::size_t begin, std::size_t end) {
                double sum = 0;
                for (std::size_t i = begin; i < end; ++i) sum += 1 / static_cast<double>(i + 1);
                return sum;
            },
            [](double a, double b) { return a + b; });
    };
    double one = 0;
    in_arena(1, [&] { one = harmonic(); });
    EXPECT_NEAR(one, std::log(100'000.0) + 0.57721566490, 1e-5);
    for (const int threads : {0, 2, 3, 8}) {
        double many = 0;
        in_arena(threads, [&] { many = harmonic(); });
        EXPECT_EQ(many, one);
    }
}

TEST(ReduceBlocks, JoinsInOrder) {
    const auto text = reduce_blocks(
        26, 4, std::string(),
        [](std::size_t begin, std::size_t end) {
            std::string s;
            for (std::size_t i = begin; i < end; ++i) s += static_cast<char>('a' + i);
            return s;
        },
        [](std::string a, const std::string& b) { return a + b; });
    EXPECT_EQ(text, "abcdefghijklmnopqrstuvwxyz");
    EXPECT_EQ(reduce_blocks(
                  0, 4, 7, [](std::size_t, std::size_t) { return 1; }, [](int a, int b) { return a + b; }),
              7);
}

TEST(CollectBlocks, KeepsTheOrderOfTheIndices) {
    const tbb::global_control more_than_cores(tbb::global_control::max_allowed_parallelism, 8);
    for (const std::size_t count : {0U, 1U, 10U, 11U, 1000U}) {
        std::vector<std::size_t> expected;
        for (std::size_t i = 0; i < count; i += 3) expected.push_back(i);
        EXPECT_EQ(collect_blocks<std::size_t>(count, 10,
                                              [](std::size_t begin, std::size_t end, std::vector<std::size_t>& out) {
                                                  EXPECT_TRUE(out.empty());
                                                  for (std::size_t i = begin; i < end; ++i)
                                                      if (i % 3 == 0) out.push_back(i);
                                              }),
                  expected);
    }
}

TEST(ExclusiveScan, GivesBeginsAndTotal) {
    std::vector<int> v{3, 0, 4, 1};
    EXPECT_EQ(exclusive_scan(v), 8);
    EXPECT_EQ(v, (std::vector<int>{0, 3, 3, 7}));
}

TEST(ParallelSort, AgreesWithTheOrder) {
    std::vector<std::uint64_t> v(50'000);
    std::uint64_t x = 1;
    for (auto& e : v) e = x = x * 6364136223846793005ULL + 1442695040888963407ULL;
    auto sorted = v;
    std::sort(sorted.begin(), sorted.end());
    parallel_sort(v.begin(), v.end(), [](std::uint64_t a, std::uint64_t b) { return a < b; });
    EXPECT_EQ(v, sorted);
}

TEST(InArena, LimitsThreadsAndAsksForNoMoreThanAllowed) {
    const tbb::global_control four(tbb::global_control::max_allowed_parallelism, 4);
    in_arena(2, [] { EXPECT_EQ(arena_threads(), 2); });
    in_arena(1, [] { EXPECT_EQ(arena_threads(), 1); });
    in_arena(1000, [] { EXPECT_EQ(arena_threads(), 4); });
    in_arena(3, [] {
        const int outer = arena_threads();
        in_arena(0, [&] { EXPECT_EQ(arena_threads(), outer); });
    });
}

}  // namespace
}  // namespace quadseg::runtime
