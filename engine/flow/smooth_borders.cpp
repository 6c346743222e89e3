#include "flow/smooth_borders.h"

namespace quadseg::flow {

bool smooth_borders(const FlowInput&, FlowResult&, const partition::RegionFaces&, const std::vector<FinalSurface>&) {
    return false;
}

}  // namespace quadseg::flow
