// How good a labelling is, whoever made it: the one ruler of bench/rivals.
#pragma once

#include <quadseg/mesh.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace quadseg::bench {

struct Score {
    std::size_t regions = 0;     ///< labels that occur
    std::size_t pieces = 0;      ///< edge-connected parts of them
    double unlabelled_area = 0;  ///< share of the whole area
    double energy = 0;           ///< hybrid energy of the labelled area, ω = .5, unit cube
    double energy_density = 0;   ///< energy / labelled area
    double rms = 0;              ///< of the labelled area, relative to the diagonal
};

/// Every region gets the plane or quadric that our own complete fit gives it; distances are exact, area-weighted, at
/// the corners. Labels: one a face, negative: unlabelled. Throws std::invalid_argument for a wrong number of labels.
Score score(const MeshView& mesh, std::span<const std::int32_t> labels);

/// A partition into `regions` connected regions that looks at no geometry: breadth-first from evenly spaced faces. What
/// a segmentation must beat to be one.
std::vector<std::int32_t> blind_partition(const MeshView& mesh, std::size_t regions);

}  // namespace quadseg::bench
