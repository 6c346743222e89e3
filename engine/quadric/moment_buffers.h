// The paper's precomputation: moments of every triangle in structure-of-arrays buffers (by eights), from which the
// weighted sums of the second step are streams of multiply-adds.
//
// One frame for a whole mesh would make them numerically worthless for regions below a hundredth of its size
// (MATH.md §3). So faces come in small groups (blocks, e.g. superfacets), each with its own origin; a region's sums are
// made block by block and shifted once a block.
#pragma once

#include "quadric/moments.h"
#include "quadric/pack.h"
#include "quadric/region_fit.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace quadseg::quadric {

/// Moments of all triangles about `origin`, unit weights: accumulate() on packs, a third of its cost a face.
Moments soup_moments(const TriangleSoup& soup, const Vec3& origin) noexcept;
/// Area-weighted centroid; the first corner where there is no area.
Vec3 soup_centroid(const TriangleSoup& soup) noexcept;

/// 304 bytes a face, rounded up to eight faces a block.
class MomentBuffers {
  public:
    /// Block b holds slots block_begin[b] … block_begin[b+1]−1: ascending, the first 0.
    explicit MomentBuffers(std::vector<std::uint32_t> block_begin);

    /// Computes block b from its faces, one a slot, about their centroid. Different blocks may be filled at once.
    void fill(std::size_t b, const TriangleSoup& faces);

    std::size_t block_count() const noexcept { return blocks_.size(); }
    std::size_t block_size(std::size_t b) const noexcept { return begin_[b + 1] - begin_[b]; }
    const Vec3& origin(std::size_t b) const noexcept { return blocks_[b].origin; }
    /// Unit-weight moments of the whole block about its origin.
    const Moments& block_moments(std::size_t b) const noexcept { return blocks_[b].sum; }
    std::size_t bytes() const noexcept;

    /// Moments about origin(b) of faces first … first+count−1 of the block with weights w2 = 1/|∇f⁰|² and w1 = 1/|∇f⁰|
    /// (count entries each). Faces of weight w2 = 0 do not take part, so that one call serves any subset of a range.
    Moments weighted_moments(std::size_t b, std::size_t first, std::span<const double> w2,
                             std::span<const double> w1) const noexcept;
    /// Adds them, shifted once, to the moments of a region about `region_origin`.
    void accumulate(Moments& region, const Vec3& region_origin, std::size_t b, std::size_t first,
                    std::span<const double> w2, std::span<const double> w1) const noexcept;
    /// Adds the whole block with unit weights.
    void accumulate(Moments& region, const Vec3& region_origin, std::size_t b) const noexcept;

  private:
    /// Eight faces, one a lane. Arrays of lanes in groups of eight rather than whole columns: one stream to write and
    /// to read instead of 38.
    struct Group {
        Pack moments[35];
        Pack normal[3];
    };
    struct Block {
        Vec3 origin;
        Moments sum;
        std::size_t first_group = 0, groups = 0;
    };

    std::vector<std::uint32_t> begin_;
    std::vector<Block> blocks_;
    std::unique_ptr<Group[]> groups_;
    std::size_t group_count_ = 0;
};

}  // namespace quadseg::quadric
