// Boundary smoothing by graph cuts: section 4.4.1.
#pragma once

#include "partition/border_bands.h"
#include "partition/leaves.h"
#include "partition/min_cut.h"
#include "partition/regions.h"
#include "runtime/run_control.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace quadseg::partition {

/// Distance of a face from the surface of a region.
using FaceDistance = std::function<double(std::uint32_t face, std::int32_t region)>;

struct SmoothRules {
    int band = 2;               ///< faces on each side of a border that may change their label
    double lambda = 1;          ///< weight of E2, the length of the cut
    double no_distance = 1e-9;  ///< a face nearer than this to both surfaces does not tell them apart: E1 is ½ for both
};

/// Relabels the faces near each border between two regions by the minimum of the paper's E1 + λ E2. E1 of a face is
/// weighed by its area over the mesh's mean face area, so that how finely a border is cut into triangles does not
/// matter. Faces that have an edge in common with a band keep their label (the paper's V0 and V1), and so does the face
/// that suits its region best where a region lies in its band altogether. Regions stay connected and non-empty, labels
/// keep their numbers, nothing crosses a barrier of the passage. Pairs are cut in batches that do not touch:
/// the same result at any thread count. Returns how many faces changed. Throws Stopped with labels as they were.
std::size_t smooth_borders(const Passage& passage, Labels& labels, std::size_t count, const FaceDistance& distance,
                           const SmoothRules& rules, const runtime::RunControl& control);

/// The graph of one pair: the band's faces that still carry one of its labels (`nodes`), both terminals made of V0 and
/// V1.
struct BandGraph {
    std::vector<std::uint32_t> nodes;
    std::vector<std::uint8_t> anchored0, anchored1;  ///< a neighbour belongs to V0, V1
    CutGraph graph;
};
/// `local`: scratch, F entries of −1, left so.
BandGraph band_graph(const Passage& passage, const Labels& labels, const BorderBands& bands, std::size_t pair,
                     const FaceDistance& distance, const SmoothRules& rules, double mean_edge, double mean_area,
                     std::vector<std::int32_t>& local);

/// Mean length of the mesh's edges (each face's, with area or not).
double mean_edge_length(const mesh::WorkMesh& mesh);

}  // namespace quadseg::partition
