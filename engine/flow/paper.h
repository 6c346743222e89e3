// The variational loop of the paper's section 4, a function per box of its Fig. 2.
#pragma once

#include "flow/flow.h"

namespace quadseg::flow {

/// `initial`: labels to begin with instead of seeds (from a coarse mesh); null: section 4.2.
FlowResult run_paper(const FlowInput& input, const partition::Labels* initial = nullptr);

}  // namespace quadseg::flow
