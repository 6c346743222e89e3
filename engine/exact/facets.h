// Facets: clusters of coplanar triangles. Evidence is counted in facets, since coplanar triangles say a thing only
// once.
#pragma once

#include "exact/tolerances.h"
#include "mesh/work_mesh.h"

#include <cstdint>
#include <vector>

namespace quadseg::exact {

struct Facet {
    Vec3 normal;
    double offset = 0;  ///< normal·x = offset
    double area = 0;
    bool sure = false;  ///< a plane of the part, not a strip of a curved surface
};

struct Facets {
    std::vector<std::int32_t> of_face;
    std::vector<Facet> facet;
    std::vector<std::uint32_t> begin, face;  ///< CSR: faces of a facet

    std::size_t count() const noexcept { return facet.size(); }
    std::size_t size(std::size_t f) const noexcept { return begin[f + 1] - begin[f]; }
};

/// Smallest altitude of each face; 0 for faces without area.
std::vector<float> face_heights(const mesh::WorkMesh& mesh);

Facets find_facets(const mesh::WorkMesh& mesh, const Tolerances& tolerances, const std::vector<float>& heights,
                   const runtime::RunControl& control);

}  // namespace quadseg::exact
