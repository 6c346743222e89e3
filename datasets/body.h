// A plate whose top and bottom are divided into square cells; in the middle of each cell a feature may stand.
#pragma once

#include "datasets/builder.h"
#include "datasets/surfaces.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace quadseg::datasets {

/// Makes a feature around the z axis of `frame` (z = 0 is the face, z up is outside) and returns its outer edge, a loop
/// of `count` = 4n vertices in the plane z = 0. A feature may use the face's own surface, `face`.
using Feature = std::function<Loop(Builder& builder, const Frame& frame, std::uint32_t count, std::int32_t face)>;

struct BodyShape {
    double cell = 1;               ///< side of a cell
    std::uint32_t nx = 2, ny = 2;  ///< cells, each at least 2
    double height = 1;
    double corner_radius = 0.3;  ///< of the outline, below `cell`
    double fillet = 0.1;         ///< of the top edge, below corner_radius; 0: sharp
    double chamfer = 0.1;        ///< of the bottom edge, below corner_radius; 0: sharp
};

/// Feature `i + nx·j` stands in the cell at x = (i + ½)·cell, y = (j + ½)·cell, at z = height (top) or 0 (bottom); a
/// null one leaves the cell flat. Bottom features are made first.
void build_body(Builder& builder, const BodyShape& shape, const std::vector<Feature>& top,
                const std::vector<Feature>& bottom);

}  // namespace quadseg::datasets
