// Which flow serves which options.
#pragma once

#include "flow/flow.h"

namespace quadseg::flow {

/// Runs the flow that the options ask for, through a simplified mesh where they ask for that.
FlowResult run_flow(const FlowInput& input);

}  // namespace quadseg::flow
