// What final surfaces have in common: groups, snapped where the data allow, and one id for the regions of one analytic
// surface.
#pragma once

#include "flow/final_surfaces.h"

#include <cstdint>
#include <vector>

namespace quadseg::flow {

/// Finds the groups among plane … torus surfaces and snaps their parameters. A region whose vertices would leave their
/// surface by more than the noise keeps its own; a group counts as snapped if all its regions are. Region ids are
/// indices. `noise`: of the vertices, unit frame.
std::vector<Regularity> snap_regularities(std::vector<FinalSurface>& surfaces, const std::vector<double>& areas,
                                          double noise);

/// Equal for regions on one analytic surface, touching or not: the smallest index among them. O(n log n) but for
/// surfaces that agree in type and size.
std::vector<std::int32_t> analytic_surface_ids(const std::vector<FinalSurface>& surfaces, double noise);

}  // namespace quadseg::flow
