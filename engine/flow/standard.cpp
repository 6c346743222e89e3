#include "flow/standard.h"

#include "flow/fast.h"

namespace quadseg::flow {

FlowResult run_standard(const FlowInput& input) {
    return run_fast(input, fast_options(input.options));
}

}  // namespace quadseg::flow
