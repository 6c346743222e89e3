// Hypotheses: surfaces fitted to small patches, accepted only where the vertices lie on them.
#pragma once

#include "exact/explanations.h"
#include "exact/grow.h"
#include "exact/search.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace quadseg::exact {

/// Faces around a seed in a growing order of facets, creases not crossed.
struct Patch {
    std::vector<std::uint32_t> faces;
    std::vector<std::size_t> facet_end;  ///< after the k-th facet: number of faces
    std::vector<std::uint32_t> up_to(std::size_t facets) const {
        return {faces.begin(), faces.begin() + static_cast<std::ptrdiff_t>(facet_end[facets - 1])};
    }
};

/// How a patch takes its neighbours. On CAD tessellations breadth runs out of a row of long facets at once, over its
/// short sides; a row is followed over edges parallel to a rung, and to one side, since a seed at the end of a row has
/// only one.
struct PatchShape {
    Vec3 rung;     ///< zero: breadth first
    Vec3 forward;  ///< along the row
};

/// `usable(f)`: faces that may be part of it (not yet explained).
Patch collect_patch(const Scene& scene, std::uint32_t seed, std::size_t facets, const PatchShape& shape,
                    const std::function<bool(std::uint32_t)>& usable, Marks& marks);

/// Vertices of a patch, ascending, with normals there: means of the faces', and of a local polynomial where there are
/// enough.
struct PatchPoints {
    std::vector<std::uint32_t> vertices;
    std::vector<Vec3> points, face_normals, jet_normals;
};
PatchPoints patch_points(const Scene& scene, std::span<const std::uint32_t> faces, Marks& marks);

/// Half of the vertices on the surface to the last digit: no accident (those miss by 1e-7), whatever trim curves do to
/// the border.
bool at_precision(const Scene& scene, const Candidate& candidate);

/// The surface that explains a patch, if one does within the tolerance. `coarse`: facets turn far, face normals are
/// worth a try.
std::optional<Surface> explain(const Scene& scene, std::span<const std::uint32_t> faces, double tolerance, bool coarse,
                               Marks& marks);

struct Finding {
    std::optional<Candidate> candidate;
    /// Faces of the largest surface that was grown and then refused for its border: other seeds on it would lead to it
    /// again.
    std::vector<std::uint32_t> refused;
};

/// Tries discs and rows of facets around a seed; grows the first surface that holds. No candidate: no surface, or one
/// that an honest look at its border refuses. `explanations`: of the search's tolerance.
Finding find_surface(const Scene& scene, std::uint32_t seed, const SearchOptions& options, Explanations& explanations,
                     const std::function<bool(std::uint32_t)>& usable, Marks& marks);

}  // namespace quadseg::exact
