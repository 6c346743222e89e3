// Rulings of general cylinders (extruded profiles: engraved letters, cams) among free-form faces. The faces of a CAD
// model meet along rulings; in the mesh these are rows of edges, exactly parallel, that cross the part from rim to rim.
// Inside a face there are none, unless the tessellation consists of rows: then a border is where the profile has a
// kink.
#pragma once

#include "mesh/features.h"

#include <cstdint>
#include <span>
#include <vector>

namespace quadseg::flow {

struct Rulings {
    mesh::FeatureEdges borders;       ///< the creases and the rulings that are borders
    std::vector<std::uint8_t> ruled;  ///< F flags: of a general cylinder that has no borders but these
};

/// Among the faces that are `free`.
Rulings find_rulings(const mesh::WorkMesh& mesh, const mesh::FeatureEdges& creases, std::span<const std::uint8_t> free,
                     const runtime::RunControl& control);

}  // namespace quadseg::flow
