#include "flow/representable.h"

#include <quadseg/error.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace quadseg::flow {

namespace {

constexpr double largest_coordinate = 1e100, smallest_diagonal = 1e-100;

}  // namespace

void require_representable(const MeshReport& report) {
    double largest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        largest = std::max({largest, std::abs(report.box_min[k]), std::abs(report.box_max[k])});
    }
    if (largest <= largest_coordinate && report.diagonal >= smallest_diagonal) return;
    std::ostringstream text;
    text << "the surfaces of a mesh with coordinates up to " << largest << " and a diagonal of " << report.diagonal
         << " leave the range of double numbers; scale it to within " << smallest_diagonal << " and "
         << largest_coordinate << " first";
    throw Error(ErrorCode::invalid_mesh, text.str());
}

}  // namespace quadseg::flow
