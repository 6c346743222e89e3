#include "bench/rivals/verdict.h"

#include <cmath>

namespace quadseg::bench {

std::vector<std::string> faults(const Traits& traits, std::size_t regions, const Score& score, const Score& blind) {
    std::vector<std::string> result;
    if (score.regions == 0) result.emplace_back("no region at all");
    if (!std::isfinite(score.energy) || !std::isfinite(score.rms)) result.emplace_back("energy or RMS is not finite");
    // Components, and proxies that lost all their faces, make a few more or less.
    const auto asked = static_cast<double>(regions);
    if (traits.takes_regions && std::abs(static_cast<double>(score.regions) - asked) > 1 + 0.02 * asked) {
        result.push_back(std::to_string(score.regions) + " regions instead of " + std::to_string(regions));
    }
    if (traits.labels_everything && score.unlabelled_area > 1e-9) {
        result.push_back("unlabelled faces: " + std::to_string(100 * score.unlabelled_area) + " % of the area");
    }
    if (score.unlabelled_area > 0.9) result.emplace_back("nearly nothing labelled");
    // Shapes without orientation join faces of opposite normals: near in distance, far in energy.
    if (!(score.energy_density < blind.energy_density) && !(score.rms < 0.9 * blind.rms)) {
        result.emplace_back("no better than regions that look at no geometry");
    }
    return result;
}

}  // namespace quadseg::bench
