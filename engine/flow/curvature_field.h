// Curvature on both sides of every edge of faces that follow no simple surface: smooth patches that meet without a
// crease still differ in curvature, and their border is sharp in it if no estimate looks across.
#pragma once

#include "mesh/features.h"
#include "mesh/work_mesh.h"
#include "surface/curvature_tensor.h"

#include <cstdint>
#include <span>
#include <vector>

namespace quadseg::flow {

/// The tensor of a face is the most certain one of the discs around it (Kuwahara's filter): beside a border that is a
/// disc which does not reach over it.
struct CurvatureField {
    std::vector<std::uint32_t> face;               ///< the active faces, ascending
    std::vector<std::int32_t> slot;                ///< F' positions in `face`; −1: inactive
    std::vector<surface::CurvatureTensor> tensor;  ///< of each active face; infinite error: none could be fitted

    const surface::CurvatureTensor& of(std::size_t f) const { return tensor[static_cast<std::size_t>(slot[f])]; }
};

CurvatureField estimate_curvatures(const mesh::WorkMesh& mesh, std::span<const std::uint8_t> active,
                                   const mesh::FeatureEdges& creases, const runtime::RunControl& control);

/// How the curvatures of two faces differ across their common edge, each in its own tangent plane.
struct CurvatureJump {
    double difference = 0;  ///< Frobenius norm, 1/length
    double relative = 0;    ///< to the larger of the two curvatures
};
CurvatureJump curvature_jump(const CurvatureField& field, const mesh::WorkMesh& mesh, std::size_t f,
                             std::size_t k) noexcept;

}  // namespace quadseg::flow
