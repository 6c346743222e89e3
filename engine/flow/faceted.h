// Smooth parts whose mesh was made from a coarser tessellation (remeshed, subdivided): their vertices lie on its
// facets, not on the surface, so that no surface is exact there, small planes are, and the curvature jumps everywhere.
#pragma once

#include "flow/flow.h"
#include "partition/regions.h"

#include <cstdint>
#include <vector>

namespace quadseg::flow {

/// Flags of the faces in such parts: connected faces of label −1 and planes that fold gently into each other. Regions
/// that are a small share of a part beside them and pass smoothly into such parts along most of their border are
/// facets too, or accidents. Whatever is flagged gets the label −1. Labels are not renumbered. Throws Stopped.
std::vector<std::uint8_t> find_faceted(const FlowInput& input, const mesh::FeatureEdges& creases,
                                       const std::vector<Surface>& surfaces, partition::Labels& explained);

}  // namespace quadseg::flow
