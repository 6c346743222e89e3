#include "exact/search.h"

#include "exact/hypothesis.h"
#include "exact/quadric_hypothesis.h"
#include "runtime/parallel.h"
#include "runtime/per_thread.h"
#include "runtime/run_control.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace quadseg::exact {

namespace {

/// Facets around a failed seed where no other seed is tried: only its own at first, more with every failure in a row,
/// since free-form patches would otherwise be tried facet by facet.
std::size_t quiet_zone(std::size_t failures) {
    constexpr std::size_t patience = 4, largest = 256;
    if (failures <= patience) return 1;
    return std::clamp<std::size_t>((failures - patience) * (failures - patience) / 2, 1, largest);
}

constexpr std::size_t most_seeds_at_once = 8;

/// After so many failures in a row, and twice as many each time, a chart is asked whether it is one quadric: that ends
/// the search at once, and the others of a free-form chart cost hundreds of times as much.
constexpr std::size_t failures_before_quadric = 16;
constexpr double whole_chart = 0.9;

/// One smooth chart: seeds farthest from creases first.
class ChartSearch {
  public:
    ChartSearch(const Scene& scene, std::vector<std::uint32_t> faces, const SearchOptions& options,
                std::vector<std::uint8_t>& covered, runtime::PerThread<Marks>& marks)
        : scene_(scene),
          faces_(std::move(faces)),
          options_(options),
          covered_(covered),
          marks_(marks),
          chart_(scene.chart[faces_.front()]),
          explanations_(scene, options.tolerance > 0 ? options.tolerance
                               : options.loose       ? scene.tolerances.loose_fit
                                                     : scene.tolerances.fit) {
        std::stable_sort(faces_.begin(), faces_.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return scene_.depth[a] > scene_.depth[b]; });
    }

    void run() {
        std::size_t next = 0;
        while (true) {
            scene_.control.check();
            const std::vector<std::uint32_t> seeds = take_seeds(next);
            if (seeds.empty()) break;
            std::vector<Finding> found(seeds.size());
            runtime::parallel_for(seeds.size(), 1, [&](std::size_t i) {
                const auto usable = [&](std::uint32_t f) {
                    return scene_.chart[f] != chart_ || covered_[f] != explained;
                };
                if (options_.quadrics) {
                    found[i].candidate = find_quadric(scene_, seeds[i], usable, marks_.local());
                } else {
                    found[i] = find_surface(scene_, seeds[i], options_, explanations_, usable, marks_.local());
                }
            });
            bool any = false;
            for (std::size_t i = 0; i < seeds.size(); ++i) {
                if (covered_[seeds[i]] == explained) continue;
                if (found[i].candidate && commit(std::move(*found[i].candidate))) {
                    any = true;
                    failures_ = 0;
                } else {
                    hush(seeds[i]);
                    for (const std::uint32_t f : found[i].refused) {
                        if (scene_.chart[f] == chart_ && covered_[f] == 0) covered_[f] = no_seed;
                    }
                }
            }
            if (failures_ >= failures_before_quadric_ && !options_.quadrics) {
                failures_before_quadric_ *= 2;
                if (is_one_quadric(seeds.front())) break;
            }
            at_once_ = any ? std::max<std::size_t>(1, at_once_ / 2) : std::min(most_seeds_at_once, at_once_ * 2);
        }
        if (!options_.quadrics) retry_regular_rows();
        for (const std::uint32_t f : faces_) {
            if (covered_[f] == no_seed) covered_[f] = 0;
        }
    }

    std::vector<Candidate> take() { return std::move(candidates_); }

  private:
    bool is_one_quadric(std::uint32_t seed) {
        const auto in_chart = [&](std::uint32_t f) { return scene_.chart[f] == chart_; };
        std::optional<Candidate> quadric = find_quadric(scene_, seed, in_chart, marks_.local());
        if (!quadric) return false;
        const auto inside = std::count_if(quadric->faces.begin(), quadric->faces.end(), in_chart);
        return static_cast<double>(inside) >= whole_chart * static_cast<double>(faces_.size()) &&
               commit(std::move(*quadric));
    }

    std::vector<std::uint32_t> take_seeds(std::size_t& next) {
        std::vector<std::uint32_t> seeds;
        for (; next < faces_.size() && seeds.size() < at_once_; ++next) {
            if (covered_[faces_[next]] == 0) seeds.push_back(faces_[next]);
        }
        return seeds;
    }

    /// Between two neighbours of its own size the facet folds by the same angle: so do those of cylinders, and hardly
    /// ever those of free-form faces.
    bool is_in_regular_row(std::uint32_t face) const {
        constexpr double equal = 0.01, least_fold = 1e-3;
        const Facets& facets = scene_.facets;
        const auto own = static_cast<std::size_t>(facets.of_face[face]);
        const double area = facets.facet[own].area;
        std::array<std::int32_t, 2> beside{-1, -1};
        std::array<double, 2> folds{};
        std::size_t count = 0;
        for (std::size_t j = facets.begin[own]; j < facets.begin[own + 1]; ++j) {
            const std::uint32_t f = facets.face[j];
            for (int k = 0; k < 3; ++k) {
                const std::int32_t g = scene_.mesh.neighbors[f][static_cast<std::size_t>(k)];
                if (scene_.is_crease(f, k) || scene_.in_sure_plane(static_cast<std::size_t>(g))) continue;
                const std::int32_t other = facets.of_face[static_cast<std::size_t>(g)];
                if (other == facets.of_face[face] || other == beside[0] || other == beside[1]) continue;
                const Facet& facet = facets.facet[static_cast<std::size_t>(other)];
                if (count == 2 || std::abs(facet.area - area) > equal * area) return false;
                beside[count] = other;
                folds[count++] = angle_between(facet.normal, facets.facet[own].normal);
            }
        }
        return count == 2 && folds[0] > least_fold && std::abs(folds[0] - folds[1]) <= equal * folds[0];
    }

    /// Quiet zones of free-form faces reach into narrow faces beside them.
    void retry_regular_rows() {
        constexpr std::size_t most_failures = 24;
        std::size_t failures = 0;
        for (const std::uint32_t seed : faces_) {
            if (covered_[seed] != no_seed || !is_in_regular_row(seed)) continue;
            scene_.control.check();
            const auto usable = [&](std::uint32_t f) { return scene_.chart[f] != chart_ || covered_[f] != explained; };
            Finding found = find_surface(scene_, seed, options_, explanations_, usable, marks_.local());
            const bool curved = found.candidate && found.candidate->surface.type != SurfaceType::plane;
            if (curved && commit(std::move(*found.candidate))) {
                failures = 0;
            } else if (++failures > most_failures) {
                return;
            }
        }
    }

    bool commit(Candidate candidate) {
        std::size_t fresh = 0;
        for (const std::uint32_t f : candidate.faces) {
            if (scene_.chart[f] != chart_) continue;
            if (covered_[f] != explained) ++fresh;
            covered_[f] = explained;
        }
        if (fresh == 0) return false;
        candidates_.push_back(std::move(candidate));
        return true;
    }

    /// No seeds near a failed one; its faces stay free to be grown into.
    void hush(std::uint32_t seed) {
        const Patch patch = collect_patch(
            scene_, seed, quiet_zone(++failures_), PatchShape{},
            [&](std::uint32_t f) { return scene_.chart[f] == chart_ && covered_[f] != explained; }, marks_.local());
        for (const std::uint32_t f : patch.faces) covered_[f] = no_seed;
        covered_[seed] = no_seed;
    }

    const Scene& scene_;
    std::vector<std::uint32_t> faces_;
    SearchOptions options_;
    std::vector<std::uint8_t>& covered_;
    runtime::PerThread<Marks>& marks_;
    std::int32_t chart_;
    Explanations explanations_;
    std::vector<Candidate> candidates_;
    std::size_t failures_ = 0, failures_before_quadric_ = failures_before_quadric, at_once_ = 1;
};

}  // namespace

std::vector<Candidate> search_surfaces(const Scene& scene, const SearchOptions& options,
                                       std::vector<std::uint8_t>& covered) {
    std::vector<std::vector<std::uint32_t>> charts(scene.chart_count);
    for (std::size_t f = 0; f < scene.chart.size(); ++f) {
        if (scene.chart[f] >= 0 && covered[f] == 0) {
            charts[static_cast<std::size_t>(scene.chart[f])].push_back(static_cast<std::uint32_t>(f));
        }
    }
    std::vector<std::vector<Candidate>> found(charts.size());
    runtime::PerThread<Marks> marks;
    runtime::parallel_for(charts.size(), 1, [&](std::size_t c) {
        if (charts[c].empty()) return;
        ChartSearch search(scene, std::move(charts[c]), options, covered, marks);
        try {
            search.run();
        } catch (const runtime::Stopped&) {
            // The caller asks the control; what was found counts.
        }
        found[c] = search.take();
    });
    std::vector<Candidate> all;
    for (auto& list : found) {
        for (Candidate& candidate : list) all.push_back(std::move(candidate));
    }
    return all;
}

double learn_step(const std::vector<Candidate>& candidates) {
    std::vector<double> steps;
    for (const Candidate& k : candidates) {
        const bool ruled = k.surface.type == SurfaceType::cylinder || k.surface.type == SurfaceType::cone;
        if (ruled && k.facets >= 8) steps.push_back(k.step);
    }
    if (steps.empty()) return 0;
    const auto q90 = steps.begin() + static_cast<std::ptrdiff_t>(0.9 * static_cast<double>(steps.size() - 1));
    std::nth_element(steps.begin(), q90, steps.end());
    return 1.3 * *q90;
}

}  // namespace quadseg::exact
