#include "exact/explanations.h"

#include "exact/hypothesis.h"

#include <algorithm>
#include <utility>

namespace quadseg::exact {

namespace {

/// Of all questions together; beyond, answers are not kept: a bound on memory, not on results. A facet may have any
/// number of faces.
constexpr std::size_t most_faces = std::size_t{1} << 21U;
/// What a question takes beside its faces, in these.
constexpr std::size_t faces_a_question = 128;

}  // namespace

std::size_t Explanations::Hash::operator()(const Question& question) const noexcept {
    std::uint64_t hash = question.coarse ? 1 : 0;
    for (const std::uint32_t f : question.faces) {
        hash = (hash ^ f) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 32;
    }
    return static_cast<std::size_t>(hash);
}

std::optional<Surface> Explanations::of(std::span<const std::uint32_t> faces, bool coarse, Marks& marks) {
    Question question{{faces.begin(), faces.end()}, coarse};
    std::sort(question.faces.begin(), question.faces.end());
    {
        const std::lock_guard lock(mutex_);
        if (const auto found = known_.find(question); found != known_.end()) return found->second;
    }
    const std::optional<Surface> surface = explain(scene_, question.faces, tolerance_, coarse, marks);
    const std::lock_guard lock(mutex_);
    const std::size_t size = question.faces.size() + faces_a_question;
    if (size <= most_faces - kept_ && known_.emplace(std::move(question), surface).second) kept_ += size;
    return surface;
}

}  // namespace quadseg::exact
