#include "exact/select.h"

#include "exact/face_fit.h"
#include "runtime/parallel.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace quadseg::exact {

namespace {

constexpr int rounds = 4;
constexpr double least_share_kept = 0.3;
constexpr double duplicate_share = 0.9;

using Indices = std::vector<std::uint32_t>;

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
        find_noise();
        demote();
        drop_duplicates();
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

    /// A surface found twice, or again inside a larger find, would share faces by rounding noise.
    void drop_duplicates() {
        Indices order(candidates_.size());
        std::iota(order.begin(), order.end(), 0U);
        std::stable_sort(order.begin(), order.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return candidates_[a].area > candidates_[b].area; });
        // A linked list of claims a face: overlaps are few, faces are many.
        struct Claim {
            std::uint32_t candidate;
            std::int32_t next;
        };
        std::vector<Claim> claims;
        std::vector<std::int32_t> head(scene_.mesh.face_count(), -1);
        std::vector<double> shared(candidates_.size(), 0);
        for (const std::uint32_t c : order) {
            scene_.control.check();
            if (!is_alive(c)) continue;
            const Candidate& candidate = candidates_[c];
            Indices touched;
            for (const std::uint32_t f : candidate.faces) {
                for (std::int32_t i = head[f]; i >= 0; i = claims[static_cast<std::size_t>(i)].next) {
                    const std::uint32_t other = claims[static_cast<std::size_t>(i)].candidate;
                    if (shared[other] == 0) touched.push_back(other);
                    shared[other] += scene_.mesh.areas[f] + 1e-300;
                }
            }
            for (const std::uint32_t other : touched) {
                const Candidate& larger = candidates_[other];
                const double limit = std::max(3 * candidate.median, trusted_);
                if (shared[other] >= duplicate_share * candidate.area && larger.median <= limit) alive_[c] = 0;
                shared[other] = 0;
            }
            if (!is_alive(c)) continue;
            for (const std::uint32_t f : candidate.faces) {
                claims.push_back({c, head[f]});
                head[f] = static_cast<std::int32_t>(claims.size() - 1);
            }
        }
    }

    void find_noise() {
        std::vector<std::pair<double, double>> medians;
        for (std::size_t c = 0; c < candidates_.size(); ++c) {
            if (is_alive(c)) medians.emplace_back(candidates_[c].median, candidates_[c].area);
        }
        result_.noise = weighted_quantile(std::move(medians), 0.5);
    }

    void demote() {
        const double s0 = std::max(result_.noise, 1e-11 * scene_.tolerances.diagonal);
        const double limit = std::max(30 * s0, scene_.tolerances.fit);
        trusted_ = std::max({3 * s0, 1e-9 * scene_.tolerances.diagonal, 10 * scene_.tolerances.precision});
        for (std::size_t c = 0; c < candidates_.size(); ++c) {
            const Candidate& k = candidates_[c];
            const bool accidental =
                (k.median > limit && k.gap > 0.1) || (k.gap > 0.35 && k.median > 3 * s0) || k.median > 20 * limit;
            if (accidental && k.surface.type != SurfaceType::plane) alive_[c] = 0;
        }
    }

    void demand_small_steps() {
        for (std::size_t c = 0; c < candidates_.size(); ++c) {
            const Candidate& k = candidates_[c];
            if (k.surface.type != SurfaceType::plane && k.facets <= 5 && k.step > largest_step_) alive_[c] = 0;
        }
    }

    void score_claims() {
        claims_.assign(candidates_.size(), {});
        runtime::parallel_for(candidates_.size(), 1, [&](std::size_t c) {
            if (!is_alive(c)) return;
            const Candidate& candidate = candidates_[c];
            const FaceFitter fitter(scene_, candidate.surface);
            const double allowed_step = 1.7 * std::max(largest_step_, candidate.step);
            claims_[c].reserve(candidate.faces.size());
            for (const std::uint32_t f : candidate.faces) {
                const FaceFit fit = fitter(f);
                const bool flat_cut = candidate.surface.type != SurfaceType::plane && fit.step > allowed_step;
                // Logarithmic: errors of trim curves must not outvote the normal.
                const double angle = std::isinf(fit.allowed) ? 0 : 2 * fit.angle / fit.allowed;
                const double unit = std::max(2e-7 * scene_.tolerances.diagonal, 4 * scene_.tolerances.precision);
                // Of two surfaces through the same vertices the one that turns less between them is meant.
                const double turn = 3 * std::log2(std::max(1.0, fit.step / largest_step_));
                claims_[c].push_back(flat_cut ? -1.0F
                                              : static_cast<float>(std::log2(1 + fit.distance / unit) + angle + turn));
            }
        });
    }

    void assign() {
        std::vector<float> best(scene_.mesh.face_count(), 0);
        std::fill(result_.owner.begin(), result_.owner.end(), -1);
        for (std::size_t c = 0; c < candidates_.size(); ++c) {
            if (!is_alive(c)) continue;
            for (std::size_t i = 0; i < candidates_[c].faces.size(); ++i) {
                const std::uint32_t f = candidates_[c].faces[i];
                const float score = claims_[c][i];
                if (score < 0 || (result_.owner[f] >= 0 && best[f] <= score)) continue;
                best[f] = score;
                result_.owner[f] = static_cast<std::int32_t>(c);
            }
        }
    }

    bool drop_losers() {
        std::vector<double> kept(candidates_.size(), 0);
        for (std::size_t f = 0; f < result_.owner.size(); ++f) {
            if (result_.owner[f] >= 0) kept[static_cast<std::size_t>(result_.owner[f])] += scene_.mesh.areas[f];
        }
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
    std::vector<std::uint8_t> alive_;
    double trusted_ = 0;  ///< median distance up to which a fit is no accident
    std::vector<std::vector<float>> claims_;
    Selection result_;
};

}  // namespace

Selection select(const Scene& scene, const std::vector<Candidate>& candidates, double largest_step) {
    return Selector(scene, candidates, largest_step).run();
}

}  // namespace quadseg::exact
