#include "flow/project.h"

namespace quadseg::flow {

std::vector<double> projected_positions(const FlowInput&, const partition::Labels&, const std::vector<FinalSurface>&) {
    return {};
}

}  // namespace quadseg::flow
