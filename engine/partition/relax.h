// Boundary relaxation: Lloyd's iteration in which only faces at region borders move, to a neighbour's surface that
// explains them better. 3 to 10 times less work than flooding, and never a higher energy from merged labels.
#pragma once

#include "partition/border_price.h"
#include "partition/leaves.h"
#include "partition/pair_merge.h"
#include "partition/regions.h"
#include "quadric/region_fit.h"
#include "runtime/run_control.h"

#include <cstddef>
#include <functional>
#include <vector>

namespace quadseg::partition {

/// A surface from moments about the region's origin.
struct MomentFit {
    quadric::Coefficients c{};
    double energy = 0;
};

struct RelaxOptions {
    int moment_steps = 6;  ///< first steps with surfaces from summed moments: no face is visited to fit them
    int steps = 6;         ///< then steps with complete fits, each {move faces, repair connectivity, refit}; < 0: none
    double margin = 1e-4;  ///< a face moves when it gains more than this share of its energy
    double stop = 1e-3;    ///< ends when a step lowers the energy by less than this share
    /// Complete steps after moment steps: a region of which at most this share of the area changed keeps its surface.
    double settled = 0;
    quadric::RegionFitOptions fit;
    /// A price of border length makes borders short, as noise asks for.
    BorderPrice border;
    /// With a price of borders: the border between two regions is first cut anew within so many rings of faces; 0: not.
    int cut_rings = 0;
    /// Fits of the first steps; none: plane or quadric by least squares. Callable from several threads at once.
    std::function<MomentFit(const quadric::Moments&)> moment_fit = {};
};

struct Relaxed {
    std::vector<quadric::RegionFit> fits;  ///< one a label; regions without faces keep a default fit
    double energy = 0;                     ///< Σ fits[r].total, and the price of the borders
    bool stopped = false;                  ///< by control: the best labels so far
};

/// Improves labels 0 … count−1 (−1: left out) in place; regions that were edge-connected stay so; a label may lose all
/// its faces. Keeps the state of lowest energy. Jacobi sweeps: the same result at any thread count.
/// `regions`: moments of the labels, as merging left them, for the first steps.
Relaxed relax(const Passage& passage, Labels& labels, std::vector<MergeRegion> regions, const RelaxOptions& options,
              const runtime::RunControl& control);

}  // namespace quadseg::partition
