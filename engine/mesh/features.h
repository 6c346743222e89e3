// Feature edges: sharp edges that are not facet borders of a tessellated smooth surface (sections 5.1; MATH.md §4).
#pragma once

#include "mesh/work_mesh.h"

#include <cstdint>
#include <vector>

namespace quadseg::mesh {

/// Bit k of element f: edge k of face f is a feature. Both faces of an edge agree. Border edges are no features.
using FeatureEdges = std::vector<std::uint8_t>;

/// Edges whose dihedral angle exceeds `degrees` and that do not belong to a tessellated smooth surface (a coarse
/// cylinder of 8 facets has 45° between its facets: no crease).
FeatureEdges find_feature_edges(const WorkMesh& mesh, double degrees, const runtime::RunControl& control);

/// Groups of faces connected without crossing features (section 5.1): group id per face, by first face; count in
/// `groups`.
std::vector<std::int32_t> feature_groups(const WorkMesh& mesh, const FeatureEdges& features, std::size_t& groups);

std::size_t count_feature_edges(const FeatureEdges& features);

}  // namespace quadseg::mesh
