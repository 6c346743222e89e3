// Same input and options, same bytes: at any number of threads, again and again, alone or beside other jobs.
#include <quadseg/segmentation.h>
#include <quadseg/segmenter.h>

#include "datasets/generate.h"
#include "tests/golden/shapes.h"
#include "tests/pipeline/result_checks.h"

#include <functional>
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <thread>

namespace quadseg::test {
namespace {

struct Job {
    std::string name;
    datasets::Recipe recipe;
    Options options;
};

void PrintTo(const Job& job, std::ostream* out) {
    *out << job.name;
}

Job job(
    const std::string& name, const std::string& part, std::size_t faces, double noise,
    const std::function<void(Options&)>& set = [](Options&) {}) {
    Job j{name, {part, faces, noise, 1, true}, {}};
    set(j.options);
    return j;
}

std::vector<Job> jobs() {
    const auto paper = [](std::size_t regions) {
        return [=](Options& o) {
            o.preset = Preset::paper;
            o.regions = regions;
        };
    };
    return {
        job("plate", "plate", 6000, 0),
        job("quadrics", "quadrics", 8000, 0),
        job("noisy", "flange", 6000, 1e-3),
        job("noisier", "fillets", 6000, 5e-3),
        job("regions", "shaft", 6000, 0, [](Options& o) { o.regions = 12; }),
        job("tolerance", "quadrics", 6000, 0, [](Options& o) { o.tolerance = 1e-3; }),
        job("features", "flange", 6000, 0, [](Options& o) { o.feature_angle = 30; }),
        job("smooth", "flange", 6000, 1e-3,
            [](Options& o) {
                o.smooth = true;
                o.project = true;
            }),
        job("paper", "shaft", 3000, 0, paper(0)),
        job("paper_regions", "plate", 3000, 0, paper(12)),
        job("paper_noisy", "shaft", 3000, 1e-3, paper(8)),
        job("paper_features", "flange", 4000, 0,
            [&](Options& o) {
                paper(30)(o);
                o.feature_angle = 30;
            }),
        job("paper_coarse", "flange", 8000, 0,
            [&](Options& o) {
                paper(12)(o);
                o.coarse = 2000;
            }),
    };
}

std::string run(const MeshView& mesh, const Options& options, int threads) {
    Context context;
    context.set_threads(threads);
    return ResultBytes::of(segment(mesh, options, &context));
}

class Identical : public testing::TestWithParam<Job> {
  protected:
    tbb::global_control eight_{tbb::global_control::max_allowed_parallelism, 8};
};

TEST_P(Identical, AtAnyNumberOfThreads) {
    const datasets::Generated part = datasets::generate(GetParam().recipe);
    const MeshView mesh = part.mesh.view();
    Context one;
    one.set_threads(1);
    const Segmentation result = segment(mesh, GetParam().options, &one);
    EXPECT_EQ(broken_rule(mesh, result), "");
    const std::string bytes = ResultBytes::of(result);
    for (const int threads : {1, 2, 3, 8}) {
        EXPECT_TRUE(run(mesh, GetParam().options, threads) == bytes) << threads << " threads";
    }
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 3);
    EXPECT_TRUE(run(mesh, GetParam().options, 0) == bytes) << "the caller's own limit";
}

INSTANTIATE_TEST_SUITE_P(Jobs, Identical, testing::ValuesIn(jobs()), [](const auto& one) { return one.param.name; });

TEST(Concurrent, EightDifferentJobsAreTheirSequentialSelves) {
    const tbb::global_control eight(tbb::global_control::max_allowed_parallelism, 8);
    struct Work {
        datasets::Generated part;
        Options options;
        std::string alone, together;
    };
    std::vector<Work> work;
    const auto names = datasets::generator_names();
    for (std::size_t i = 0; i < 8; ++i) {
        Work w{datasets::generate(names[i % names.size()], 2500 + 150 * i, i % 3 == 1 ? 2e-3 : 0, i + 1), {}, {}, {}};
        w.options.preset = i % 4 == 3 ? Preset::paper : Preset::standard;
        w.options.regions = i % 4 >= 2 ? 9 : 0;
        w.alone = run(w.part.mesh.view(), w.options, 1);
        work.push_back(std::move(w));
    }
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < work.size(); ++i) {
        threads.emplace_back(
            [&w = work[i], i] { w.together = run(w.part.mesh.view(), w.options, static_cast<int>(i % 4)); });
    }
    for (std::thread& t : threads) t.join();
    for (std::size_t i = 0; i < work.size(); ++i) EXPECT_TRUE(work[i].alone == work[i].together) << "job " << i;
}

TEST(Stepwise, TheSegmenterRunsTheSameAtAnyNumberOfThreads) {
    const tbb::global_control eight(tbb::global_control::max_allowed_parallelism, 8);
    const datasets::Generated part = datasets::generate("shaft", 2000);
    Options options;
    options.preset = Preset::paper;
    std::string first;
    for (const int threads : {1, 2, 8}) {
        Context context;
        context.set_threads(threads);
        Segmenter s(part.mesh.view(), options, &context);
        for (int i = 0; i < 6; ++i) s.insert();
        s.relax(5);
        s.insert(part.truth.size() / 3);
        s.merge(0, [&] {  // any neighbour of region 0
            for (std::int32_t r = 1; r < static_cast<std::int32_t>(s.region_count()); ++r) {
                try {
                    s.merge_candidate(0, r);
                    return r;
                } catch (const std::runtime_error&) {
                }
            }
            return 1;
        }());
        const Segmentation result = s.result();
        EXPECT_EQ(broken_rule(part.mesh.view(), result), "");
        const std::string bytes = ResultBytes::of(result);
        if (first.empty()) first = bytes;
        EXPECT_TRUE(bytes == first) << threads << " threads";
    }
}

}  // namespace
}  // namespace quadseg::test
