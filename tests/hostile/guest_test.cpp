// The library is a guest in its process: it prints nothing, changes nothing, keeps nothing.
#include <quadseg/error.h>
#include <quadseg/segmentation.h>
#include <quadseg/segmenter.h>

#include "datasets/generate.h"
#include "tests/hostile/nasty_shapes.h"
#include "tests/pipeline/result_checks.h"

#include <array>
#include <cfenv>
#include <clocale>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <malloc.h>
#include <tbb/global_control.h>
#include <unistd.h>

namespace quadseg::test {
namespace {

/// What is written to file descriptors 1 and 2 while `body` runs.
template <class Body>
std::string captured(const Body& body) {
    std::fflush(nullptr);
    const int out = dup(1), err = dup(2);
    std::FILE* sink = std::tmpfile();
    dup2(fileno(sink), 1);
    dup2(fileno(sink), 2);
    body();
    std::fflush(nullptr);
    dup2(out, 1);
    dup2(err, 2);
    close(out);
    close(err);
    std::rewind(sink);
    std::string text;
    for (int c = std::fgetc(sink); c != EOF; c = std::fgetc(sink)) text += static_cast<char>(c);
    std::fclose(sink);
    return text;
}

void all_kinds_of_jobs() {
    Options paper, post, coarse;
    paper.preset = coarse.preset = Preset::paper;
    paper.regions = coarse.regions = 6;
    coarse.coarse = 300;
    post.smooth = post.project = true;
    for (const NamedShape& nasty : nasty_shapes()) {
        if (nasty.shape.faces() > 600) continue;
        for (const Options& options : {Options{}, paper, post, coarse}) {
            try {
                Context context;
                context.set_threads(64);
                segment(nasty.shape.view(), options, &context);
            } catch (const Error&) {
            }
        }
    }
}

std::size_t open_files() {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) ++count;
    return count;
}

TEST(Guest, PrintsNothing) {
    EXPECT_EQ(captured(all_kinds_of_jobs), "");
    EXPECT_EQ(captured([] { std::fputs("seen", stderr); }), "seen");
}

TEST(Guest, LeavesTheProcessAsItWas) {
    const std::string locale = std::setlocale(LC_ALL, nullptr);
    const auto folder = std::filesystem::current_path();
    const int rounding = std::fegetround();
    const std::size_t files = open_files();
    std::array<struct sigaction, 32> before{}, after{};
    const auto handlers = [](std::array<struct sigaction, 32>& all) {
        for (int s = 1; s < 32; ++s) sigaction(s, nullptr, &all[static_cast<std::size_t>(s)]);
    };
    handlers(before);
    const datasets::Generated part = datasets::generate("flange", 3000, 1e-3);
    segment(part.mesh.view());
    handlers(after);
    EXPECT_EQ(locale, std::setlocale(LC_ALL, nullptr));
    EXPECT_EQ(folder, std::filesystem::current_path());
    EXPECT_EQ(rounding, std::fegetround());
    EXPECT_EQ(files, open_files());
    for (std::size_t s = 1; s < 32; ++s) EXPECT_EQ(before[s].sa_handler, after[s].sa_handler) << "signal " << s;
}

TEST(Guest, LeavesItsInputAsItWas) {
    const datasets::Generated part = datasets::generate("plate", 2000);
    const Mesh copy = part.mesh;
    segment(part.mesh.view());
    EXPECT_EQ(copy.positions, part.mesh.positions);
    EXPECT_EQ(copy.triangles, part.mesh.triangles);
}

std::size_t resident_bytes() {
    std::ifstream statm("/proc/self/statm");
    std::size_t total = 0, resident = 0;
    statm >> total >> resident;
    return resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

TEST(Guest, KeepsNoMemoryOverManyRuns) {
    const int runs = std::getenv("QUADSEG_LONG_TESTS") != nullptr ? 1000 : 120;
    Options paper, post;
    paper.preset = Preset::paper;
    paper.regions = 4;
    post.smooth = post.project = true;
    std::vector<datasets::Generated> parts;
    for (const std::string& name : datasets::generator_names()) {
        parts.push_back(datasets::generate(name, 600, parts.size() % 2 == 0 ? 0 : 1e-3));
    }
    const auto run = [&](int i) {
        const auto& part = parts[static_cast<std::size_t>(i) % parts.size()];
        const std::array<Options, 3> options{Options{}, paper, post};
        try {
            Context context;
            if (i % 7 == 6) context.set_time_limit(1e-3);
            segment(part.mesh.view(), options[static_cast<std::size_t>(i) / parts.size() % 3], &context);
        } catch (const Error&) {
        }
    };
    for (int i = 0; i < 60; ++i) run(i);
    malloc_trim(0);
    const std::size_t before = resident_bytes();
    for (int i = 0; i < runs; ++i) run(i);
    malloc_trim(0);
    const std::size_t after = resident_bytes();
    RecordProperty("grown_bytes", std::to_string(after > before ? after - before : 0));
    EXPECT_LE(after, before + (std::size_t{4} << 20));
}

}  // namespace
}  // namespace quadseg::test
