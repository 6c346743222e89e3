#include "exact/second_opinion.h"

#include "exact/search.h"
#include "exact/select.h"

#include <algorithm>
#include <utility>

namespace quadseg::exact {

namespace {

constexpr double suspicious_turn = 1.7;

/// What a search beneath suspicious candidates finds.
template <class Suspicious>
std::vector<Candidate> ask_again(const Scene& scene, const Suspicious& suspicious, const SearchOptions& options,
                                 const std::vector<Candidate>& candidates) {
    // Where nothing was found the second search would find nothing either.
    std::vector<std::uint8_t> covered(scene.mesh.face_count(), no_seed);
    bool any = false;
    for (const Candidate& candidate : candidates) {
        if (!suspicious(candidate)) continue;
        any = true;
        for (const std::uint32_t f : candidate.faces) covered[f] = 0;
    }
    if (!any) return {};
    for (const Candidate& candidate : candidates) {
        if (suspicious(candidate)) continue;
        for (const std::uint32_t f : candidate.faces) covered[f] = explained;
    }
    std::vector<Candidate> found = search_surfaces(scene, options, covered);
    scene.control.check();
    return found;
}

}  // namespace

void ask_for_smaller_steps(const Scene& scene, double step, std::vector<Candidate>& candidates) {
    const auto turns_far = [&](const Candidate& c) {
        return c.surface.type != SurfaceType::plane && c.step > suspicious_turn * step;
    };
    const SearchOptions options{.rows_only = true, .most_step = suspicious_turn * step};
    append(candidates, ask_again(scene, turns_far, options, candidates));
}

void replace_loose(const Scene& scene, std::vector<Candidate>& candidates) {
    constexpr double nearly_all = 0.9;
    const double sure = sure_distance(scene, noise_of(candidates));
    if (!(sure < scene.tolerances.fit)) return;
    const auto is_loose = [&](const Candidate& c) { return c.surface.type != SurfaceType::plane && c.median > sure; };
    std::vector<Candidate> found = ask_again(scene, is_loose, {.tolerance = sure}, candidates);
    std::erase_if(found, is_loose);
    if (found.empty()) return;
    constexpr std::uint8_t before = 1, since = 2;
    std::vector<std::uint8_t> exact(scene.mesh.face_count(), 0);
    for (const Candidate& candidate : found) {
        for (const std::uint32_t f : candidate.faces) exact[f] = since;
    }
    for (const Candidate& candidate : candidates) {
        if (is_loose(candidate)) continue;
        for (const std::uint32_t f : candidate.faces) exact[f] = std::max(exact[f], before);
    }
    std::vector<std::uint8_t> given_way(scene.mesh.face_count(), 0);
    std::erase_if(candidates, [&](const Candidate& candidate) {
        if (!is_loose(candidate)) return false;
        double area = 0;
        bool any = false;
        for (const std::uint32_t f : candidate.faces) {
            if (exact[f] != 0) area += scene.mesh.areas[f];
            any = any || exact[f] == since;
        }
        if (!any || area < nearly_all * candidate.area) return false;
        for (const std::uint32_t f : candidate.faces) given_way[f] = 1;
        return true;
    });
    std::erase_if(found, [&](const Candidate& candidate) {
        return std::none_of(candidate.faces.begin(), candidate.faces.end(),
                            [&](std::uint32_t f) { return given_way[f] != 0; });
    });
    append(candidates, std::move(found));
}

}  // namespace quadseg::exact
