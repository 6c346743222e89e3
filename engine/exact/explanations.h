// What is known of the patches that a search has asked about: neighbouring seeds lead to the same few facets again and
// again, and half of a free-form chart's patches have been refused before.
#pragma once

#include <quadseg/segmentation.h>

#include "exact/grow.h"

#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

namespace quadseg::exact {

/// explain() of hypothesis.h for sets of faces, of one scene and tolerance. The answer depends on the set alone, not on
/// the order of its faces, nor on which thread asks first. Threads may ask at once.
class Explanations {
  public:
    Explanations(const Scene& scene, double tolerance) : scene_(scene), tolerance_(tolerance) {}

    std::optional<Surface> of(std::span<const std::uint32_t> faces, bool coarse, Marks& marks);

  private:
    struct Question {
        std::vector<std::uint32_t> faces;  ///< ascending
        bool coarse = false;
        bool operator==(const Question&) const = default;
    };
    struct Hash {
        std::size_t operator()(const Question& question) const noexcept;
    };

    const Scene& scene_;
    double tolerance_;
    std::mutex mutex_;
    std::unordered_map<Question, std::optional<Surface>, Hash> known_;
    std::size_t kept_ = 0;  ///< faces of all questions, and what comes with them
};

}  // namespace quadseg::exact
