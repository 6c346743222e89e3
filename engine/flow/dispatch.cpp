#include "flow/dispatch.h"

#include "flow/fast.h"
#include "flow/paper.h"
#include "flow/standard.h"

namespace quadseg::flow {

FlowResult run_flow(const FlowInput& input) {
    return input.options.preset == Preset::paper ? run_paper(input) : run_standard(input);
}

}  // namespace quadseg::flow
