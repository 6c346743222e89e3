// What a job is said to take bounds what it takes, and not by far: a job that fits is not to be refused.
#include <quadseg/segmentation.h>

#include "datasets/generate.h"
#include "flow/memory_estimate.h"
#include "runtime/parallel.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <malloc.h>
#include <string>

namespace quadseg {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool sanitized = true;
#elif defined(__has_feature)
constexpr bool sanitized = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
constexpr bool sanitized = false;
#endif

/// A line of /proc/self/status, bytes.
std::size_t status_bytes(const std::string& name) {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;) {
        std::size_t kilobytes = 0;
        if (word == name + ":" && status >> kilobytes) return kilobytes * 1024;
    }
    return 0;
}

struct Measured {
    std::size_t bytes = 0;  ///< by how much the resident memory rose at most while the job ran
    bool whole = false;     ///< else it was cut short, perhaps before its peak
};

Measured measure(const MeshView& mesh, const Options& options) {
    mallopt(M_MMAP_THRESHOLD, 1 << 16);  // or memory freed before would hide what the job takes
    malloc_trim(0);
    std::ofstream("/proc/self/clear_refs") << 5 << std::flush;  // the peak begins anew
    const std::size_t before = status_bytes("VmRSS");
    Context context;
    context.set_time_limit(3);
    const bool whole = !segment(mesh, options, &context).partial;
    return {status_bytes("VmHWM") - before, whole};
}

/// Every face with vertices of its own, as in an STL file that was not welded.
Mesh soup_of(const Mesh& mesh) {
    Mesh soup;
    for (const std::uint32_t v : mesh.triangles) {
        soup.triangles.push_back(static_cast<std::uint32_t>(soup.positions.size() / 3));
        for (std::size_t k = 0; k < 3; ++k) soup.positions.push_back(mesh.positions[3 * std::size_t{v} + k]);
    }
    return soup;
}

struct MemoryJob {
    const char* name;
    const char* part;
    double noise;
    bool soup;
    std::function<void(Options&)> set;
};

void PrintTo(const MemoryJob& job, std::ostream* out) {
    *out << job.name;
}

class Memory : public testing::TestWithParam<MemoryJob> {};

TEST_P(Memory, StaysWithinTheEstimate) {
    if (sanitized) GTEST_SKIP() << "sanitizers take memory of their own";
    const char* text = std::getenv("QUADSEG_MEMORY_FACES");
    const std::size_t faces = text != nullptr ? std::strtoull(text, nullptr, 10) : 60000;
    Mesh mesh = datasets::generate(GetParam().part, faces, GetParam().noise).mesh;
    if (GetParam().soup) mesh = soup_of(mesh);
    Options options;
    GetParam().set(options);
    const std::size_t estimate =
        flow::estimated_bytes(mesh.view(), options, runtime::arena_threads(),
                              GetParam().noise > 0 ? flow::Surfaces::noisy : flow::Surfaces::clean);
    const std::size_t arrays = mesh.positions.size() * sizeof(double) + mesh.triangles.size() * sizeof(std::uint32_t);
    const Measured job = measure(mesh.view(), options);
    const std::size_t measured = arrays + job.bytes;
    const auto a_face = [&](std::size_t bytes) {
        return static_cast<double>(bytes) / static_cast<double>(mesh.triangles.size() / 3);
    };
    if (text != nullptr) {
        std::printf("%-16s %7zu faces, bytes a face: %5.0f measured, %5.0f estimated\n", GetParam().name,
                    mesh.triangles.size() / 3, a_face(measured), a_face(estimate));
    }
    EXPECT_LE(measured, estimate);
    // Not by far: a job that fits is not to be refused.
    if (job.whole) {
        EXPECT_LE(estimate, 3 * measured + (std::size_t{8} << 20));
    }
}

void paper(Options& o) {
    o.preset = Preset::paper;
}

INSTANTIATE_TEST_SUITE_P(
    Jobs, Memory,
    testing::Values(MemoryJob{"clean", "plate", 0, false, [](Options&) {}},
                    MemoryJob{"quadrics", "quadrics", 0, false, [](Options&) {}},
                    MemoryJob{"noisy", "flange", 1e-3, false, [](Options&) {}},
                    MemoryJob{"very_noisy", "shaft", 1e-2, false, [](Options&) {}},
                    MemoryJob{"soup", "plate", 0, true, [](Options&) {}},
                    MemoryJob{"post", "quadrics", 0, false,
                              [](Options& o) {
                                  o.smooth = o.project = o.project_joint = true;
                                  o.feature_angle = 30;
                              }},
                    MemoryJob{"regions", "shaft", 0, false, [](Options& o) { o.regions = 20; }},
                    MemoryJob{"many_regions", "shaft", 0, false, [](Options& o) { o.regions = 2000; }},
                    MemoryJob{"tolerance", "flange", 0, false, [](Options& o) { o.tolerance = 1e-4; }},
                    MemoryJob{"regions_coarse", "shaft", 0, false,
                              [](Options& o) {
                                  o.regions = 20;
                                  o.coarse = 20000;
                              }},
                    MemoryJob{"paper", "plate", 0, false,
                              [](Options& o) {
                                  paper(o);
                                  o.regions = 10;
                              }},
                    MemoryJob{"paper_smooth", "plate", 0, false,
                              [](Options& o) {
                                  paper(o);
                                  o.regions = 5;
                                  o.smooth = o.project = true;
                              }},
                    MemoryJob{"paper_coarse", "flange", 0, false,
                              [](Options& o) {
                                  paper(o);
                                  o.regions = 10;
                                  o.coarse = 10000;
                              }},
                    MemoryJob{"hierarchical", "plate", 0, false,
                              [](Options& o) {
                                  paper(o);
                                  o.method = Method::hierarchical;
                                  o.regions = 10;
                              }}),
    [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace quadseg
