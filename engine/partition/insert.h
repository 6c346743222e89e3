// Where new regions begin: random seeds (section 4.2), seed update (4.3.2) and the farthest-point rule (4.3.3).
#pragma once

#include "mesh/work_mesh.h"
#include "partition/leaves.h"
#include "partition/regions.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace quadseg::partition {

/// PCG32 (O'Neill 2014): the same numbers on every platform, unlike the distributions of the standard library.
class RandomNumbers {
  public:
    explicit RandomNumbers(std::uint64_t seed) noexcept;
    std::uint32_t next() noexcept;
    /// Uniform in [0, bound), without bias; bound ≥ 1.
    std::uint32_t below(std::uint32_t bound) noexcept;

  private:
    std::uint64_t state_ = 0;
};

/// One seed in every group of faces, then random ones up to `count` in all (fewer when the mesh has fewer faces):
/// distinct, ascending. Faces with area come first.
std::vector<std::uint32_t> random_seeds(const mesh::WorkMesh& mesh, const Labels& groups, std::size_t group_count,
                                        std::size_t count, std::uint64_t seed);

/// Face of smallest error density, ties by index; faces without area only when there are no others.
std::uint32_t best_face(const mesh::WorkMesh& mesh, std::span<const std::uint32_t> faces,
                        const std::vector<double>& density, std::optional<std::uint32_t> except = {});

/// Face of largest error density other than `except`, ties by index. Slivers are passed over as long as there are
/// others: the normal of a face far below the mean area of its region is noise.
std::optional<std::uint32_t> worst_face(const mesh::WorkMesh& mesh, std::span<const std::uint32_t> faces,
                                        const std::vector<double>& density, std::uint32_t except);

/// Densities of the faces of one region, averaged `rounds` times with those of their neighbours by area: the maximum is
/// then the middle of a patch that fits badly and not a single odd face. Other faces keep theirs.
std::vector<double> smoothed_density(const Passage& passage, std::span<const std::uint32_t> faces, const Labels& labels,
                                     const std::vector<double>& density, int rounds);

/// What the farthest-point rule asks of a region.
struct InsertionCandidate {
    double energy = 0, area = 0;
    bool valid = true;
    std::size_t faces = 0;
};
/// Order in which regions are split: of those with more than one face the invalid ones first, then by falling E/area;
/// ties by index.
std::vector<std::uint32_t> farthest_regions(std::span<const InsertionCandidate> regions);

}  // namespace quadseg::partition
