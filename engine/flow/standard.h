// The default flow: exact surfaces where the mesh is exact, likelihood where it is noisy, energy where the user asks
// for a number.
#pragma once

#include "flow/flow.h"

namespace quadseg::flow {

FlowResult run_standard(const FlowInput& input);

}  // namespace quadseg::flow
