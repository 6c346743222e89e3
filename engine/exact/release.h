// Giving back what only looks explained: facets of coarse or noisy smooth surfaces that pass for planes, and crumbs of
// accidental surfaces amid free-form faces.
#pragma once

#include "exact/explained.h"

namespace quadseg::exact {

/// Planar regions that fold gently into other planar regions along most of their border are strips of a tessellation
/// whose vertices are not on the surface (remeshed or subdivided): they become free. So do small regions amid free
/// faces.
void release_doubtful(const Scene& scene, Explained& state);

}  // namespace quadseg::exact
