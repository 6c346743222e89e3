// Vertices of a region with normals: what typed surfaces are fitted to.
#pragma once

#include "mesh/work_mesh.h"
#include "partition/regions.h"
#include "surface/fit.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace quadseg::flow {

struct RegionSample {
    std::vector<Vec3> points, normals;
    bool complete = false;  ///< every vertex of the region is there

    surface::PointSet all() const noexcept { return {points, normals, {}}; }
    /// At most `limit` of them, evenly spread over the region.
    RegionSample thinned(std::size_t limit) const;
};

/// At most about `limit` vertices, evenly spread over the region (its faces follow the Morton curve). A normal is the
/// mean of the region's faces around the vertex by their angles there, which does not depend on how facets are cut into
/// triangles. `faces` ascending, all of one label. Of more than `smooth_normals` vertices only those that
/// thinned(smooth_normals) takes have such a normal; that of the others is one face's. `left_out`: flags of vertices
/// that are no evidence; empty: none.
RegionSample sample_region(const mesh::WorkMesh& mesh, const partition::Labels& labels, const std::uint32_t* faces,
                           std::size_t count, std::size_t limit,
                           std::size_t smooth_normals = std::numeric_limits<std::size_t>::max(),
                           const std::vector<std::uint8_t>& left_out = {});

}  // namespace quadseg::flow
