// Growing a surface over the mesh from a patch on which it was found.
#pragma once

#include "exact/candidate.h"
#include "mesh/marks.h"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace quadseg::exact {

using mesh::Marks;

/// The faces that can be reached from `start` over faces on the surface (start faces that are not are left out). Sure
/// planes are not entered unless the surface is a plane.
std::vector<std::uint32_t> reach(const Scene& scene, const Surface& surface, std::span<const std::uint32_t> start,
                                 double largest_turn, Marks& marks);

/// Different vertices of faces, in order of first use; at most `most` of them, taken evenly.
std::vector<Vec3> vertices_of(const Scene& scene, std::span<const std::uint32_t> faces, std::size_t most, Marks& marks);

/// Grows, refits, grows again until the faces are stable; fills the figures of a candidate.
Candidate grow(const Scene& scene, const Surface& start, std::span<const std::uint32_t> patch, double largest_turn,
               Marks& marks);

/// Fills facets, area, median, gap and step of a candidate whose surface and faces are set.
void measure_candidate(const Scene& scene, Candidate& candidate, Marks& marks);

/// 75 % quantile by area of faces' (step, area). By area: a surface laid through the rims of three bands turns most
/// across the widest of them.
double typical_step(std::vector<std::pair<double, double>> steps);

}  // namespace quadseg::exact
