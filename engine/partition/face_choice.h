// Which of the regions that meet at a face explains it best: the decision that boundary relaxation is made of.
#pragma once

#include "partition/border_price.h"
#include "partition/leaves.h"
#include "quadric/energy_batch.h"
#include "quadric/region_fit.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace quadseg::partition {

struct FaceChoice {
    std::int32_t label;  ///< the face's own, where nothing is gained
    double gain;         ///< by how much E falls when the face alone takes the label
};

struct ChoiceOptions {
    double weight = 0.5;  ///< ω
    BorderPrice border;
    double margin = 0;  ///< a face moves when it gains more than this share of its energy
};

/// Decides by labels and surfaces as they are at the call. Thread-safe while nobody changes them.
class FaceChooser {
  public:
    FaceChooser(const Passage& passage, const Labels& labels, const std::vector<quadric::RegionFit>& fits,
                const ChoiceOptions& options)
        : passage_(passage), mesh_(*passage.mesh), labels_(labels), fits_(fits), options_(options) {}

    /// One choice a face. Ties go to the smaller label.
    void decide(std::span<const std::uint32_t> faces, FaceChoice* out) const noexcept;

  private:
    struct Candidates {
        std::int32_t own = -1;                ///< −1: the face is at no border
        std::array<std::int32_t, 3> other{};  ///< −1: none, or the face's own, or one before
        std::array<std::size_t, 3> energy{};  ///< number of each in the batch …
        std::size_t own_energy = 0;           ///< … and of its own
        std::array<double, 3> price{};        ///< of border length, were the face to have the label
        double own_price = 0;
    };

    Candidates candidates(std::size_t f, quadric::EnergyBatch& batch) const noexcept;
    void add_prices(std::size_t f, const std::array<std::int32_t, 3>& across, Candidates& c) const noexcept;
    FaceChoice best(std::size_t f, const Candidates& c, const quadric::EnergyBatch& batch) const noexcept;

    const Passage& passage_;
    const mesh::WorkMesh& mesh_;
    const Labels& labels_;
    const std::vector<quadric::RegionFit>& fits_;
    ChoiceOptions options_;
};

}  // namespace quadseg::partition
