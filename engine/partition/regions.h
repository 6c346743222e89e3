// Basic facts about a labelling: region lists, connectivity, compaction.
#pragma once

#include "mesh/work_mesh.h"
#include "quadric/region_fit.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace quadseg::partition {

using Labels = std::vector<std::int32_t>;

/// Faces of every region, CSR, faces ascending: faces of r are face[begin[r]] … face[begin[r+1]−1]. Labels are 0 …
/// count−1.
struct RegionFaces {
    std::vector<std::uint32_t> begin, face;
    std::size_t count() const noexcept { return begin.empty() ? 0 : begin.size() - 1; }
    std::size_t size(std::size_t r) const noexcept { return begin[r + 1] - begin[r]; }
};
RegionFaces region_faces(const Labels& labels, std::size_t count);

/// Renumbers to 0 … n−1 by first face; returns n.
std::size_t compact(Labels& labels);
/// And says by what number each former label was replaced; −1: by none, no face had it.
std::size_t compact(Labels& labels, std::vector<std::int32_t>& renumbered);
/// Renumbers to 0 … n−1, labels keep their order; the same return value and replacements. (An order by first face
/// depends on how the mesh lies in its axes; where labels were numbered by what faces look like, this one does not.)
std::size_t close_gaps(Labels& labels);
std::size_t close_gaps(Labels& labels, std::vector<std::int32_t>& renumbered);
/// Splits regions that are not edge-connected (each part becomes a region, the part with the first face keeps the
/// label, then compact()). Returns the number of regions.
std::size_t split_disconnected(const mesh::WorkMesh& mesh, Labels& labels);

/// Corner, normal and area arrays of a list of faces.
struct GatheredRegion {
    std::vector<Vec3> corners, normals;
    std::vector<double> areas;
    quadric::TriangleSoup soup() const noexcept { return {corners, normals, areas}; }
    void clear() noexcept {
        corners.clear();
        normals.clear();
        areas.clear();
    }
    void reserve(std::size_t faces) {
        corners.reserve(3 * faces);
        normals.reserve(faces);
        areas.reserve(faces);
    }
};
/// The arrays of a million faces are 100 MB, of which half the time is the system's to give them: with a control, it is
/// asked on the way.
void gather(const mesh::WorkMesh& mesh, const std::uint32_t* faces, std::size_t count, GatheredRegion& out,
            const runtime::RunControl* control = nullptr);
/// Adds to what is there.
void append(const mesh::WorkMesh& mesh, const std::uint32_t* faces, std::size_t count, GatheredRegion& out);

/// Fits all regions in parallel (largest first is not needed: one task a region, deterministic each).
std::vector<quadric::RegionFit> fit_regions(const mesh::WorkMesh& mesh, const RegionFaces& regions,
                                            const quadric::RegionFitOptions& options,
                                            const runtime::RunControl& control);

}  // namespace quadseg::partition
