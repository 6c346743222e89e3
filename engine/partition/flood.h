// Distortion-minimising flooding (section 4.3.1; Cohen-Steiner, Alliez, Desbrun 2004).
#pragma once

#include "partition/face_metric.h"
#include "partition/leaves.h"
#include "partition/regions.h"
#include "runtime/run_control.h"

#include <cstdint>
#include <span>
#include <vector>

namespace quadseg::partition {

/// A proxy and the face from which it grows.
struct SeededRegion {
    std::int32_t label = 0;
    std::uint32_t seed = 0;
    const quadric::Proxy* proxy = nullptr;
};

/// Keeps its buffers from one flood to the next, so that a flood costs its faces and not the mesh's.
///
/// The paper puts every tested pair (face, proxy) into the queue. Of several pairs of one face only the one with the
/// smallest priority ever counts, so a pair enters only when it beats those of its face before it: the same partition
/// from a third of the entries. Ties are broken by face, then by label.
class Flood {
  public:
    explicit Flood(const Passage& passage);

    /// Distributes `faces` among `regions`; all other faces keep their labels and are not crossed. Seeds must be
    /// distinct and among `faces`, and every face must be reachable from a seed within `faces`: true for the union of
    /// connected regions that each hold a seed.
    ///
    /// In: labels[f] ≥ 0 tells for which proxy density[f] = E/area is known already (−1: none). Out: the new labels,
    /// and density[f] with respect to the proxy that took f. Throws Stopped, leaving labels and density half done.
    void run(std::span<const SeededRegion> regions, std::span<const std::uint32_t> faces, const FaceMetric& metric,
             Labels& labels, std::vector<double>& density, const runtime::RunControl& control);

  private:
    /// 4-ary heap of (priority as ordered float bits) << 32 | face.
    class Queue {
      public:
        bool empty() const noexcept { return heap_.empty(); }
        void clear() noexcept { heap_.clear(); }
        void push(std::uint64_t entry);
        std::uint64_t pop();

      private:
        std::vector<std::uint64_t> heap_;
    };
    struct Offer {
        double density = 0;
        float priority = 0;
        std::int32_t region = -1;  ///< index into `regions`, −1: nobody yet
    };
    static constexpr std::int32_t closed = -2;

    void grow(std::size_t face, std::size_t region, float priority, std::span<const SeededRegion> regions,
              const FaceMetric& metric, const Labels& labels, const std::vector<double>& density);

    Passage passage_;
    Queue queue_;
    std::vector<Offer> offers_;  ///< best offer so far; region `closed` outside the current flood or when taken
};

}  // namespace quadseg::partition
