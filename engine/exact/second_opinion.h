// A second search beneath surfaces that were found but are suspicious.
#pragma once

#include "exact/candidate.h"

#include <vector>

namespace quadseg::exact {

/// Where facets turn suspiciously far beside `step`, what this mesh's tessellator let them turn: surfaces that turn
/// less are added; selection decides. Throws Stopped.
void ask_for_smaller_steps(const Scene& scene, double step, std::vector<Candidate>& candidates);

/// A surface that its vertices miss by more than others of this mesh gives way where surfaces on which they lie are
/// found beneath nearly all of it: a torus may pass near a fillet along a straight edge and the one along the arc
/// behind it. Throws Stopped.
void replace_loose(const Scene& scene, std::vector<Candidate>& candidates);

}  // namespace quadseg::exact
