#include "bench/support/child.h"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>

namespace quadseg::bench {
namespace {

TEST(Child, ExitCodeAndOutputComeBack) {
    const TemporaryFolder folder;
    const ChildResult result =
        run_child({"sh", "-c", "echo to stdout; echo to stderr >&2; exit 3"}, folder.file("log"));
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_FALSE(result.timed_out);
    std::ifstream log(folder.file("log"));
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(log), {}), "to stdout\nto stderr\n");
}

TEST(Child, WorkCountsAsCpuAndSleepOnlyAsWall) {
    const ChildResult busy = run_child({"sh", "-c", "i=0; while [ $i -lt 100000 ]; do i=$((i+1)); done"});
    EXPECT_GT(busy.cpu_seconds, 0.01);
    const ChildResult idle = run_child({"sleep", "0.3"});
    EXPECT_GE(idle.wall_seconds, 0.3);
    EXPECT_LT(idle.cpu_seconds, 0.1);
}

TEST(Child, PeakIsThatOfTheChild) {
    const ChildResult small = run_child({"true"});
    const ChildResult large = run_child({"dd", "if=/dev/zero", "of=/dev/null", "bs=200M", "count=1"});
    EXPECT_GT(large.peak_bytes, std::size_t{200'000'000});
    EXPECT_LT(small.peak_bytes, std::size_t{100'000'000});
}

TEST(Child, OneThatOutlastsItsTimeIsEnded) {
    const ChildResult result = run_child({"sleep", "60"}, {}, 0.2);
    EXPECT_TRUE(result.timed_out);
    EXPECT_NE(result.exit_code, 0);
    EXPECT_LT(result.wall_seconds, 10);
}

TEST(Child, AProgramThatIsNotThereIsAnError) {
    EXPECT_THROW(run_child({"/no/such/program"}), std::runtime_error);
}

TEST(TemporaryFolder, GoesWithItsObject) {
    std::string path;
    {
        const TemporaryFolder folder;
        path = folder.path();
        std::ofstream(folder.file("x")) << 1;
        EXPECT_TRUE(std::filesystem::exists(path));
    }
    EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace quadseg::bench
