// What the flows have in common: input, result.
#pragma once

#include <quadseg/segmentation.h>

#include "mesh/features.h"
#include "mesh/work_mesh.h"
#include "partition/regions.h"
#include "quadric/region_fit.h"
#include "runtime/run_control.h"

#include <cstdint>
#include <vector>

namespace quadseg::flow {

struct FlowInput {
    const mesh::WorkMesh& mesh;
    const mesh::FeatureEdges* features;  ///< edges that no region crosses; null: none
    const Options& options;
    const runtime::RunControl& control;
};

/// A flow that is stopped returns its best partition so far with `partial` set; it does not throw Stopped.
struct FlowResult {
    partition::Labels labels;  ///< a work face each, 0 … regions−1, every region edge-connected
    std::size_t regions = 0;
    StopReason stop = StopReason::converged;
    bool partial = false;
    std::vector<MergeStep> history;
    std::vector<double> energies;
    /// Empty, or one a region: the surface that the flow verified on the vertices (unit frame); type freeform: none, to
    /// be chosen.
    std::vector<Surface> surfaces;
    bool scan = false;  ///< regions without such a surface are judged by the noise: they need not be free-form
    /// Empty, or one a region: 1 where no vertex lies on a surface (flow/faceted.h), so that the type is chosen by what
    /// explains them best.
    std::vector<std::uint8_t> faceted;
    /// Empty, or one a region: the complete fits to its faces, which the flow ended with.
    std::vector<quadric::RegionFit> fits;
    /// Empty, or one a vertex: 1 where it lies on the facets of its surface, not on the surface (flow/divided.h).
    std::vector<std::uint8_t> on_facets;
    double coarse_seconds = 0;  ///< spent on the simplified mesh
    double noise = 0;           ///< estimated standard deviation of the vertices, unit frame; 0: not estimated
};

}  // namespace quadseg::flow
