#include "flow/accidents.h"

#include <algorithm>

namespace quadseg::flow {

namespace {

/// Even a mesh without exact surfaces may stand on a plane: so many faces are none by chance.
constexpr std::size_t no_accident = 64;

}  // namespace

void release_accidents(partition::Labels& labels) {
    std::vector<std::size_t> faces;
    for (const std::int32_t label : labels) {
        if (label < 0) continue;
        faces.resize(std::max(faces.size(), static_cast<std::size_t>(label) + 1));
        ++faces[static_cast<std::size_t>(label)];
    }
    for (std::int32_t& label : labels) {
        if (label >= 0 && faces[static_cast<std::size_t>(label)] < no_accident) label = -1;
    }
}

}  // namespace quadseg::flow
