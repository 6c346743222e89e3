// Is a rival's result what its adapter promises? Only then is its time worth a line.
#pragma once

#include "bench/rivals/adapter.h"
#include "bench/support/score.h"

#include <string>
#include <vector>

namespace quadseg::bench {

/// What is wrong with a result, one sentence each; empty: nothing. `blind` is the score of blind_partition() with the
/// same number of regions: labels in a wrong order, or of another mesh, lose against it.
std::vector<std::string> faults(const Traits& traits, std::size_t regions, const Score& score, const Score& blind);

}  // namespace quadseg::bench
