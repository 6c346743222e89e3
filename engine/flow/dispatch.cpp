#include "flow/dispatch.h"

#include "flow/coarse.h"
#include "flow/paper.h"
#include "flow/standard.h"

namespace quadseg::flow {

FlowResult run_flow(const FlowInput& input) {
    if (input.options.preset != Preset::paper) return run_standard(input);
    const std::size_t coarse = coarse_face_count(input.options, input.mesh.face_count());
    return coarse > 0 ? run_paper_coarse(input, coarse) : run_paper(input);
}

}  // namespace quadseg::flow
