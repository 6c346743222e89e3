// The paper's method and those that it is compared with: what they fit to a region, and how they measure a face.
//
// All but `hierarchical` share the paper's loop (seeds, flood, fit, reseed, merge, insert): a method is a metric and a
// fit. What differs from the sources:
//  - quadric: the method of the paper. Beside Taubin's fit with one weighted least-squares step, the unit-weight fit
//    with one such step is tried, and the smaller true energy wins (Taubin's alone fails near planes).
//  - vsa_l21, vsa_l2: Cohen-Steiner, Alliez, Desbrun: Variational shape approximation, SIGGRAPH 2004. Planes under the
//    L2,1 metric (mean normal) and the L2 metric (principal component). The flood is ordered by error over area, as
//    here, instead of the error itself.
//  - hybrid: Wu, Kobbelt: Structure recovery via hybrid variational surface approximation, Eurographics 2005. Plane,
//    sphere or circular cylinder, whichever has the smallest energy; the metric is this paper's hybrid one (theirs are
//    L2 or L2,1), the fits are linear ones on moments, and rolling-ball blends are left out.
//  - quadric_l2: Yan, Liu, Wang: Quadric surface extraction by variational shape approximation, GMP 2006. Plane first,
//    else Taubin's fit; distance only.
//  - quadric_gradient: Kanai, Ohtake, Kase: Hierarchical error-driven approximation of implicit surfaces from polygonal
//    meshes, SGP 2006. One linear fit of ∫f² + ω∫|∇f − n|², nothing normalised; their octree of implicit patches is
//    replaced by the paper's loop.
//  - hierarchical: Attene, Falcidieno, Spagnuolo: Hierarchical mesh segmentation based on fitting primitives, The
//    Visual Computer 22 (2006). Greedy merging from single faces; planes, spheres, cylinders from additive moments;
//    cost is this paper's hybrid energy (theirs: L2), and pairs are re-evaluated lazily.
#pragma once

#include <quadseg/options.h>

#include "flow/flow.h"
#include "partition/face_metric.h"
#include "partition/merge_candidates.h"

namespace quadseg::flow {

struct MethodPolicy {
    partition::FaceMetric metric;
    partition::FitFunction fit;  ///< RegionFit::total is the energy of `metric`
};

/// For every method but hierarchical, whose regions are fitted as those of hybrid.
/// `poll` is called between the passes of a fit over its faces; what it throws ends the fit.
MethodPolicy method_policy(const Options& options, std::function<void()> poll = {});

/// Method::hierarchical: merges down to Options::regions; 0: as far as the energy stays below
/// PaperOptions::energy_threshold. Stopped while there are more than 20,000 regions: the components.
FlowResult run_hierarchical(const FlowInput& input);

}  // namespace quadseg::flow
