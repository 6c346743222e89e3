#include "exact/select.h"

#include "exact/face_fit.h"
#include "mesh/group_sums.h"
#include "runtime/parallel.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace quadseg::exact {

namespace {

constexpr int rounds = 4;
constexpr double least_share_kept = 0.3;
/// A smaller candidate takes a face from a larger one only when it explains it better by this much: twins would share
/// by rounding noise.
constexpr float clear_gain = 0.5F;

/// Value at `share` of the total weight; (value, weight) pairs.
double weighted_quantile(std::vector<std::pair<double, double>> values, double share) {
    if (values.empty()) return 0;
    std::sort(values.begin(), values.end());
    double total = 0;
    for (const auto& v : values) total += v.second;
    double sum = 0;
    for (const auto& v : values) {
        sum += v.second;
        if (sum >= share * total) return v.first;
    }
    return values.back().first;
}

class Selector {
  public:
    Selector(const Scene& scene, const std::vector<Candidate>& candidates, double largest_step)
        : scene_(scene), candidates_(candidates), largest_step_(largest_step), alive_(candidates.size(), 1) {}

    Selection run() {
        by_area_.resize(candidates_.size());
        std::iota(by_area_.begin(), by_area_.end(), 0U);
        std::stable_sort(by_area_.begin(), by_area_.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return candidates_[a].area > candidates_[b].area; });
        result_.noise = noise_of(candidates_);
        demote();
        demand_small_steps();
        score_claims();
        result_.owner.assign(scene_.mesh.face_count(), -1);
        for (int round = 0; round < rounds; ++round) {
            scene_.control.check();
            assign();
            if (!drop_losers()) break;
        }
        return std::move(result_);
    }

  private:
    bool is_alive(std::size_t c) const { return alive_[c] != 0; }

    void demote() {
        const double s0 = std::max(result_.noise, 1e-11 * scene_.tolerances.diagonal);
        const double limit = std::max(30 * s0, scene_.tolerances.fit);
        const double trusted = std::max({3 * s0, 1e-9 * scene_.tolerances.diagonal, 10 * scene_.tolerances.precision});
        // Where the coordinates are rounded the first row of a tangent neighbour may creep away too, but not all
        // around.
        const double precision = scene_.tolerances.precision;
        const bool rounded = precision > 1e-9 * scene_.tolerances.diagonal;
        for (std::size_t c = 0; c < candidates_.size(); ++c) {
            const Candidate& k = candidates_[c];
            const bool creeps =
                rounded && ((k.gap > 0.6 && k.median > 1.5 * precision) || (k.gap > 0.75 && k.facets <= 24));
            const bool accidental = creeps || (k.median > limit && k.gap > 0.3) ||
                                    (k.median > 10 * limit && k.gap > 0.1) || (k.gap > 0.35 && k.median > trusted) ||
                                    (k.median > 20 * limit && k.gap > 0.05);
            if (accidental && k.surface.type != SurfaceType::plane) alive_[c] = 0;
        }
    }

    void demand_small_steps() {
        for (std::size_t c = 0; c < candidates_.size(); ++c) {
            const Candidate& k = candidates_[c];
            if (k.surface.type != SurfaceType::plane && k.facets <= 5 && k.step > largest_step_) alive_[c] = 0;
        }
    }

    /// Where a candidate has no rival, any claim that is allowed will do.
    void score_claims() {
        std::vector<std::uint8_t> rivals(scene_.mesh.face_count(), 0);  // at most two are counted
        for (std::size_t c = 0; c < candidates_.size(); ++c) {
            if (!is_alive(c)) continue;
            for (const std::uint32_t f : candidates_[c].faces) {
                rivals[f] = static_cast<std::uint8_t>(std::min(2, rivals[f] + 1));
            }
        }
        claims_.assign(candidates_.size(), {});
        contested_.assign(candidates_.size(), {});
        runtime::parallel_for(candidates_.size(), 1, [&](std::size_t c) {
            if (!is_alive(c)) return;
            const Candidate& candidate = candidates_[c];
            const FaceFitter fitter(scene_, candidate.surface);
            const bool plane = candidate.surface.type == SurfaceType::plane;
            const double allowed_step = 1.7 * std::max(largest_step_, candidate.step);
            claims_[c].reserve(candidate.faces.size());
            std::size_t polls = 0;
            for (std::size_t i = 0; i < candidate.faces.size(); ++i) {
                const std::uint32_t f = candidate.faces[i];
                scene_.control.check_often(polls);
                if (rivals[f] > 1) contested_[c].push_back(static_cast<std::uint32_t>(i));
                if (plane && rivals[f] == 1) {
                    claims_[c].push_back(0);
                    continue;
                }
                const FaceFit fit = fitter(f);
                const bool flat_cut = (!plane && fit.step > allowed_step) ||
                                      is_flat_cut(scene_, f, fit, candidate.surface.type, candidate.step);
                // Logarithmic: errors of trim curves must not outvote the normal.
                const double angle = std::isinf(fit.allowed) ? 0 : 2 * fit.angle / fit.allowed;
                const double unit = std::max(2e-7 * scene_.tolerances.diagonal, 4 * scene_.tolerances.precision);
                // Of two surfaces through the same vertices the one that turns less between them is meant.
                const double turn =
                    3 * std::log2(std::max({1.0, fit.step / largest_step_, candidate.step / largest_step_}));
                claims_[c].push_back(flat_cut ? -1.0F
                                              : static_cast<float>(std::log2(1 + fit.distance / unit) + angle + turn));
            }
        });
    }

    void assign() {
        std::vector<float> best(scene_.mesh.face_count(), 0);
        std::fill(result_.owner.begin(), result_.owner.end(), -1);
        // Most faces have one claim only: all threads see to those.
        runtime::parallel_for(candidates_.size(), 1, [&](std::size_t c) {
            if (!is_alive(c)) return;
            std::size_t next = 0;
            for (std::size_t i = 0; i < candidates_[c].faces.size(); ++i) {
                if (next < contested_[c].size() && contested_[c][next] == i) {
                    ++next;
                } else if (!(claims_[c][i] < 0)) {
                    result_.owner[candidates_[c].faces[i]] = static_cast<std::int32_t>(c);
                }
            }
        });
        for (const std::uint32_t c : by_area_) {
            if (!is_alive(c)) continue;
            for (const std::uint32_t i : contested_[c]) {
                const std::uint32_t f = candidates_[c].faces[i];
                const float score = claims_[c][i];
                if (score < 0 || (result_.owner[f] >= 0 && best[f] <= score + clear_gain)) continue;
                best[f] = score;
                result_.owner[f] = static_cast<std::int32_t>(c);
            }
        }
    }

    bool drop_losers() {
        std::vector<double> kept(candidates_.size(), 0);
        mesh::add_by_group(result_.owner, scene_.mesh.areas, kept);
        bool any = false;
        for (std::size_t c = 0; c < candidates_.size(); ++c) {
            if (!is_alive(c) || kept[c] >= least_share_kept * candidates_[c].area) continue;
            alive_[c] = 0;
            any = true;
        }
        return any;
    }

    const Scene& scene_;
    const std::vector<Candidate>& candidates_;
    double largest_step_;
    std::vector<std::uint32_t> by_area_;
    std::vector<std::uint8_t> alive_;
    std::vector<std::vector<float>> claims_;             ///< a face of each candidate
    std::vector<std::vector<std::uint32_t>> contested_;  ///< of these, the ones that others claim too
    Selection result_;
};

}  // namespace

double noise_of(const std::vector<Candidate>& candidates) {
    std::vector<std::pair<double, double>> medians;
    for (const Candidate& k : candidates) medians.emplace_back(k.median, k.area);
    return weighted_quantile(std::move(medians), 0.5);
}

double sure_distance(const Scene& scene, double noise) {
    return std::max({30 * noise, 1e-9 * scene.tolerances.diagonal, 10 * scene.tolerances.precision});
}

Selection select(const Scene& scene, const std::vector<Candidate>& candidates, double largest_step) {
    return Selector(scene, candidates, largest_step).run();
}

}  // namespace quadseg::exact
