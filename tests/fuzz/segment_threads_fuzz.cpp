// One thread and three give the same bytes.
#include <quadseg/error.h>
#include <quadseg/segmentation.h>

#include "cpu_limit.h"
#include "segment_recipe.h"
#include "tests/pipeline/result_checks.h"

#include <string>
#include <tbb/global_control.h>

namespace {

std::string run(const quadseg::MeshView& mesh, const quadseg::Options& options, int threads) {
    quadseg::Context context;
    context.set_threads(threads);
    try {
        return quadseg::test::ResultBytes::of(quadseg::segment(mesh, options, &context));
    } catch (const quadseg::Error& error) {
        return error.what();
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace quadseg;
    static const tbb::global_control three(tbb::global_control::max_allowed_parallelism, 3);
    fuzz::Bytes in(data, size);
    const Options options = fuzz::options_of(in);
    const fuzz::CpuLimit limit(30);
    const test::Shape shape = fuzz::shape_of(in);
    if (run(shape.view(), options, 1) != run(shape.view(), options, 3)) __builtin_trap();
    return 0;
}
