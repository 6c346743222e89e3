// The surface that is reported for each region: section 4.4.2, decided by refits to the vertices.
#pragma once

#include "flow/flow.h"
#include "quadric/region_fit.h"

#include <optional>
#include <vector>

namespace quadseg::flow {

struct FinalSurface {
    Surface surface;         ///< unit frame
    quadric::Proxy quadric;  ///< the same as a quadric (torus, blend, freeform: the best one)
    /// The proxy of least energy, which the energies speak of, where the surface is a later refit to the vertices.
    std::optional<quadric::Proxy> loop_proxy;
    std::optional<quadric::TriangleEnergy> loop_energy;  ///< loop_proxy's over all faces, where it is known
    bool one_sheet = true;                               ///< the region's foot points on the quadric lie on one sheet
    // What the regularities between surfaces are judged by.
    std::vector<Vec3> points;  ///< a few vertices
    Vec3 centroid;
    double extent = 0;         ///< RMS radius of the region
    double rms = 0;            ///< of the sampled vertices' distances
    std::size_t evidence = 0;  ///< vertices that were looked at
};

/// One a region. A surface that the flow verified stays and is only refined on the region's vertices; others are
/// chosen: the simplest type whose refit is not meaningfully worse. Free-form regions of the default preset are typed
/// only where a surface explains the vertices within the noise. The comparison methods of preset paper keep their own
/// proxies. Parallel over regions; a region costs its sample, not its size (preset paper: its fit). Deterministic.
std::vector<FinalSurface> final_surfaces(const FlowInput& input, const partition::RegionFaces& regions,
                                         const FlowResult& flow);

/// A typed surface as a quadric in a frame about `origin`; false for types that are none (torus, blend, freeform).
bool quadric_of(const Surface& surface, const Vec3& origin, quadric::Proxy& proxy);

}  // namespace quadseg::flow
