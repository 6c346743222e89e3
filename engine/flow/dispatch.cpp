#include "flow/dispatch.h"

#include "flow/coarse.h"
#include "flow/paper.h"
#include "flow/standard.h"

namespace quadseg::flow {

FlowResult run_flow(const FlowInput& input) {
    const std::size_t coarse = coarse_face_count(input.options, input.mesh.face_count());
    if (input.options.preset != Preset::paper) return coarse > 0 ? run_fast_coarse(input, coarse) : run_standard(input);
    return coarse > 0 ? run_paper_coarse(input, coarse) : run_paper(input);
}

}  // namespace quadseg::flow
