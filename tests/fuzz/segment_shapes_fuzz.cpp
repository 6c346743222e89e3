// Any mesh, any options: a result that keeps the rules, or an Error, in 10 seconds of CPU time.
#include <quadseg/error.h>
#include <quadseg/segmentation.h>

#include "cpu_limit.h"
#include "segment_recipe.h"
#include "tests/pipeline/result_checks.h"

#include <cstdio>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace quadseg;
    fuzz::Bytes in(data, size);
    const Options options = fuzz::options_of(in);
    const test::Shape shape = fuzz::shape_of(in);
    if (!validate(options).empty()) return 0;
    const fuzz::CpuLimit limit(10);
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
    return 0;
}
