// Uniting what is one: adjacent regions on equal surfaces, and scraps that a neighbour explains.
#pragma once

#include "exact/explained.h"

namespace quadseg::exact {

/// Adjacent regions become one where the smaller lies on the surface of the larger, or one surface fits both.
void unite_equal(const Scene& scene, double largest_step, Explained& state);

/// Small curved regions all of whose vertices lie on a much larger neighbour's surface are pieces of it that its
/// tessellation cut off in slivers.
void absorb_exact_crumbs(const Scene& scene, Explained& state);

/// Free pieces beside a curved surface that lie along it with all faces, but end at trim curves that are farther off
/// than trim curves usually are, join it.
void absorb_badly_trimmed(const Scene& scene, double largest_step, Explained& state);

/// Pieces of a few faces, free or barely supported, join the neighbour that encloses and explains them.
void absorb_scraps(const Scene& scene, double largest_step, Explained& state);

}  // namespace quadseg::exact
