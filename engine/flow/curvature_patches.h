// Smooth patches of free-form faces: what is bounded by creases, by explained faces and by lines where the curvature
// jumps.
#pragma once

#include "flow/curvature_field.h"
#include "partition/regions.h"

namespace quadseg::flow {

struct PatchRules {
    double alike = 0.05;        ///< relative jumps below this join faces before any region is looked at
    double jump = 0.3;          ///< median relative jump along a border that stands
    double turn = 2;            ///< degrees that the smaller side's normals must differ by for it to count in full
    std::size_t few_faces = 6;  ///< regions of fewer count less
};

/// Of the faces of the field that are `wanted`: labels 0 … by first face, −1: the others. Borders of the lowest jump go
/// first; medians are those of the whole border of two regions, so that a border holds where single edges are in doubt.
partition::Labels curvature_patches(const mesh::WorkMesh& mesh, const mesh::FeatureEdges& creases,
                                    const CurvatureField& field, std::span<const std::uint8_t> wanted,
                                    const PatchRules& rules, const runtime::RunControl& control);

}  // namespace quadseg::flow
