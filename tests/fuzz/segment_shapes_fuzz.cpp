// Any mesh, any options: a result that keeps the rules, or an Error, in 10 seconds of CPU time (libFuzzer's -timeout
// counts the wall's, which a busy machine stretches).
#include <quadseg/error.h>
#include <quadseg/segmentation.h>

#include "segment_recipe.h"
#include "tests/pipeline/result_checks.h"

#include <cstdio>
#include <ctime>

namespace {

double cpu_seconds() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

constexpr double most_seconds = 10;

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace quadseg;
    fuzz::Bytes in(data, size);
    const Options options = fuzz::options_of(in);
    const test::Shape shape = fuzz::shape_of(in);
    if (!validate(options).empty()) return 0;
    const double start = cpu_seconds();
    try {
        const Segmentation result = segment(shape.view(), options);
        const std::string wrong = test::broken_rule(shape.view(), result);
        if (!wrong.empty() || result.partial) {
            std::fprintf(stderr, "%s\n", wrong.c_str());
            __builtin_trap();
        }
    } catch (const Error& error) {
        if (error.code() != ErrorCode::empty_mesh && error.code() != ErrorCode::invalid_mesh) {
            std::fprintf(stderr, "%s\n", error.what());
            __builtin_trap();
        }
    }
    if (cpu_seconds() - start > most_seconds) {
        std::fprintf(stderr, "%.1f s of CPU time\n", cpu_seconds() - start);
        __builtin_trap();
    }
    return 0;
}
