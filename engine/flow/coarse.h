// Coarse to fine (section 5.2): segment a simplified mesh, bring its labels back, refine them at full resolution. Wraps
// any flow.
#pragma once

#include "flow/flow.h"
#include "simplify/decimate.h"

#include <cstddef>
#include <functional>
#include <vector>

namespace quadseg::flow {

using FlowFunction = std::function<FlowResult(const FlowInput&)>;
using SimplifyFunction = std::function<simplify::Decimated(const FlowInput&)>;
using RefineFunction = std::function<FlowResult(const FlowInput&, const partition::Labels&)>;

/// Faces of the simplified mesh that the options ask for on a mesh of `faces`; 0: none. Automatic (−1): where it pays,
/// that is the paper's loop from 10,000 faces on; the default flow takes hardly longer than simplifying.
std::size_t coarse_face_count(const Options& options, std::size_t faces);

/// The flow sees a mesh in the unit frame of input.mesh, so that energies and tolerances mean the same. Where the mesh
/// cannot be simplified to less than 70 % of its faces, the flow runs on it as it is. Stopped before or in the coarse
/// flow: its labels as projected, partial.
FlowResult run_coarse(const FlowInput& input, const SimplifyFunction& simplify, const FlowFunction& flow_on_coarse,
                      const RefineFunction& refine_on_fine);

/// Quadric-error decimation of the positions, which are the input mesh's or stand for them, that keeps edges sharper
/// than `crease` degrees where the options name no feature angle. Throws Stopped.
simplify::Decimated simplified(const FlowInput& input, const std::vector<Vec3>& positions, std::size_t faces,
                               double crease);

/// run_coarse for the paper's loop. With a number of regions wanted, the loop finds more on the simplified mesh, where
/// that is cheap, and merges most of what is too many there, the last on the fine mesh: lower energies than by
/// insertion alone.
FlowResult run_paper_coarse(const FlowInput& input, std::size_t coarse_faces);
/// run_coarse for the fast flow: regions by energy, also where none would be looked for on the vertices (which a
/// simplified mesh has not).
FlowResult run_fast_coarse(const FlowInput& input, std::size_t coarse_faces);

}  // namespace quadseg::flow
