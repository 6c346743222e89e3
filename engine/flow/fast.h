// The fast flow: leaves → merging on additive moments → boundary relaxation. Bottom-up, 50 to 300 times less work than
// the loop.
#pragma once

#include "flow/flow.h"

#include <span>

namespace quadseg::flow {

struct FastOptions {
    std::size_t regions = 0;  ///< merge down to this many; 0: until nothing is worth merging
    double tolerance = 0;     ///< > 0: merge while the RMS distance of the union stays below, relative to the diagonal
    double misfit_angle = 4.4;  ///< degrees: a merge may cost ω·angle² per area of the smaller side (clean meshes)
    double noise_factor = 10;   ///< κ: and this many times the noise of the degrees of freedom that it saves
    bool ladder = true;         ///< plane < sphere < cylinder < revolution < quadric with mild factors
    double leaf_angle = 8;      ///< degrees between a face and the mean normal of its leaf
    int moment_steps = 2;       ///< boundary relaxation with surfaces from moments
    int relax_steps = 3;        ///< and with complete fits
    /// Of {dissolve the regions of highest energy into leaves, merge again, relax}, where surfaces explain the mesh
    /// badly (organic shapes).
    int split_rounds = 1;
    std::size_t smallest_region = 4;  ///< regions of fewer faces join a neighbour at the end
    /// F' flags: only these faces take part; borders of the others are barriers; their labels come out −1. Empty: all.
    std::span<const std::uint8_t> active = {};
};

/// With FastOptions from options.regions, tolerance and detail by fast_options().
FastOptions fast_options(const Options& options);
FlowResult run_fast(const FlowInput& input, const FastOptions& fast);
/// From connected labels 0 … n−1 (of a simplified mesh, brought over): what is too many is merged, then borders relax.
FlowResult refine_fast(const FlowInput& input, const FastOptions& fast, const partition::Labels& initial);

}  // namespace quadseg::flow
