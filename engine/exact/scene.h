// What every step of the exact stage looks at: the mesh, its facets, its creases. Read-only after build_scene().
#pragma once

#include "exact/facets.h"
#include "exact/tolerances.h"
#include "mesh/work_mesh.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace quadseg::exact {

struct Scene {
    const mesh::WorkMesh& mesh;
    const runtime::RunControl& control;
    Tolerances tolerances;
    /// What does not depend on creases: scenes that differ in these have it in common.
    struct Ground {
        std::vector<float> heights;
        Facets facets;
    };
    std::shared_ptr<Ground> ground;
    const Facets& facets;
    const std::vector<float>& heights;  ///< smallest altitude of a face
    std::vector<std::uint8_t> creases;  ///< bit k: edge k is a border or sharper than the crease angle
    std::vector<std::int32_t> chart;    ///< smooth component of a face without sure planes; −1: in a sure plane
    std::size_t chart_count = 0;
    std::vector<std::uint16_t> depth;  ///< rings from the nearest crease, border or sure plane

    bool is_crease(std::size_t f, int k) const noexcept { return (creases[f] >> k & 1) != 0; }
    bool in_sure_plane(std::size_t f) const noexcept { return chart[f] < 0; }
};

Scene build_scene(const mesh::WorkMesh& mesh, const runtime::RunControl& control);

/// The same with creases at another angle, degrees.
Scene with_creases(const Scene& scene, double degrees);

/// Angle between the normals of two faces, radians; 0 where one has none.
double dihedral(const mesh::WorkMesh& mesh, std::size_t f, std::size_t g);

}  // namespace quadseg::exact
