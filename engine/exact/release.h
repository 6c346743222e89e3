// Giving back what only looks explained: facets of coarse or noisy smooth surfaces that pass for planes, and crumbs of
// accidental surfaces amid free-form faces.
#pragma once

#include "exact/explained.h"

namespace quadseg::exact {

/// Rows of flat facets all parallel to one direction are an extruded profile: their two rims lie on spheres, cones and
/// tori too, which is chance. Where a cylinder holds it takes their place, else the faces become free.
void release_extruded(const Scene& scene, Explained& state);

/// Planar regions that fold gently into other planar regions along most of their border are strips of a tessellation
/// whose vertices are not on the surface (remeshed or subdivided): they become free. So do small regions amid free
/// faces.
void release_doubtful(const Scene& scene, Explained& state);

/// When all searches are over, what free-form faces show by chance becomes free: curved surfaces of few facets that go
/// on gently into free faces along a good part of their border; planes that do so smoothly and through whose vertices
/// no exact plane goes (noise: of the vertices that exact surfaces explain, unit frame); planes of one triangle beside
/// free faces or each other.
void release_crumbs(const Scene& scene, double noise, Explained& state);

}  // namespace quadseg::exact
