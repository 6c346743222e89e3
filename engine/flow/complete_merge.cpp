#include "flow/complete_merge.h"

#include "flow/description_length.h"
#include "flow/merge_rounds.h"
#include "quadric/fit.h"
#include "quadric/ladder.h"
#include "runtime/parallel.h"

#include <algorithm>
#include <cmath>

namespace quadseg::flow {
namespace {

using partition::MergeRegion;

struct Part {
    MergeRegion moments;
    quadric::RegionFit fit;
    std::vector<std::uint32_t> faces;
    std::size_t fitted_faces = 0;  ///< of which `fit` was found
    double length = 0;             ///< of its description
};

using Pair = MergePair;

class CompleteMerger {
  public:
    CompleteMerger(const partition::Passage& passage, partition::Labels& labels, std::vector<quadric::RegionFit>&& fits,
                   std::vector<MergeRegion>&& moments, const CompleteMergeRules& rules,
                   const runtime::RunControl& control)
        : passage_(passage), mesh_(*passage.mesh), labels_(labels), rules_(rules), control_(control) {
        const partition::RegionFaces faces = partition::region_faces(labels, fits.size());
        parts_.resize(fits.size());
        runtime::parallel_for(parts_.size(), 16, [&](std::size_t r) {
            Part& part = parts_[r];
            part.fit = fits[r];
            part.fit.total = part.fit.energy.hybrid(rules_.weight);  // relaxation may have weighed otherwise
            part.moments = moments[r];
            part.faces.assign(faces.face.begin() + faces.begin[r], faces.face.begin() + faces.begin[r + 1]);
            part.fitted_faces = part.faces.size();
            score(part.moments);
            part.length = std::min(length_of(part.fit), part.moments.score.cost);
        });
    }

    std::size_t run() {
        pairs_ = merge_pairs_of<Pair>(passage_, labels_, control_);
        while (merge_round()) {
        }
        return partition::close_gaps(labels_);
    }

  private:
    double length_of(const quadric::RegionFit& fit) const noexcept {
        return fit.total + rules_.price * (fit.proxy.planar() ? 3 : quadric_parameters);
    }
    void score(MergeRegion& region) const noexcept {
        const PricedFit fit = fit_priced(region.moments, rules_.weight, rules_.price);
        region.score = {fit.length, fit.energy, fit.parameters};
    }

    double allowance(const Pair& p) const noexcept {
        const double smaller = std::min(parts_[p.a].moments.moments.total_area, parts_[p.b].moments.moments.total_area);
        return rules_.region_price + rules_.border_reward * p.border + rules_.misfit * smaller +
               partition::blurred(rules_.blur, rules_.blur_area, smaller);
    }

    MergeRegion join(const MergeRegion& a, const MergeRegion& b) const noexcept {
        MergeRegion r;
        const double area = a.moments.total_area + b.moments.total_area;
        r.origin = area > 0 ? a.origin + (b.origin - a.origin) * (b.moments.total_area / area) : a.origin;
        r.moments = quadric::joined(a.moments, a.origin, b.moments, b.origin, r.origin);
        score(r);
        return r;
    }

    double energy_under(const Part& small, const quadric::Proxy& proxy) const noexcept {
        double sum = 0;
        for (const std::uint32_t f : small.faces) {
            sum += quadric::triangle_energy(proxy, mesh_.corner(f, 0), mesh_.corner(f, 1), mesh_.corner(f, 2),
                                            mesh_.normals[f], mesh_.areas[f])
                       .hybrid(rules_.weight);
        }
        return sum;
    }

    quadric::RegionFit fit_union(const Part& a, const Part& b) const {
        std::vector<std::uint32_t> faces;
        faces.reserve(a.faces.size() + b.faces.size());
        std::merge(a.faces.begin(), a.faces.end(), b.faces.begin(), b.faces.end(), std::back_inserter(faces));
        return fit_faces(faces);
    }
    quadric::RegionFit fit_faces(const std::vector<std::uint32_t>& faces) const {
        partition::GatheredRegion gathered;
        partition::gather(mesh_, faces.data(), faces.size(), gathered);
        quadric::RegionFitOptions options;
        options.weight = rules_.weight;
        options.plane_tolerance = 0;
        return quadric::fit_region(gathered.soup(), options);
    }

    /// Rise of the description length when the pair becomes one region; the dearest way to know it comes last.
    double rise_of(const Pair& p) const {
        const Part &a = parts_[p.a], &b = parts_[p.b];
        const double apart = a.length + b.length, limit = allowance(p);
        const MergeRegion joint = join(a.moments, b.moments);
        double rise = joint.score.cost - apart;
        if (rise <= limit) return rise;
        const bool a_is_small = a.faces.size() < b.faces.size();
        const Part &small = a_is_small ? a : b, &large = a_is_small ? b : a;
        if (rules_.size_ratio * static_cast<double>(small.faces.size()) < static_cast<double>(large.faces.size())) {
            return std::min(rise, energy_under(small, large.fit.proxy) - small.length);
        }
        // Least squares overestimate a joint quadric's energy, but not by more than this on true surfaces.
        constexpr double overestimate = 0.25;
        if (joint.score.energy - a.moments.score.energy - b.moments.score.energy >
            overestimate * (a.moments.score.energy + b.moments.score.energy)) {
            return rise;
        }
        // No quadric is nearer to the pair than Taubin's: what it refuses by its distance alone need not be fitted.
        const quadric::Spread size = quadric::spread(joint.moments);
        if (size.radius > 0) {
            const double scale = 1 / size.radius;
            const quadric::Moments local = quadric::scaled(quadric::shifted(joint.moments, size.centroid), scale);
            const double distance = quadric::fit_taubin(local).energy / (scale * scale * scale * scale);
            if (distance + 3 * rules_.price - apart > limit) return rise;
        }
        rise = std::min(rise, length_of(fit_union(a, b)) - apart);
        return rise;
    }

    bool merge_round() {
        measure_pairs(
            pairs_, [&](Pair& p) { p.rise = rise_of(p); }, control_);
        const std::vector<Pair> merges = best_merges(
            pairs_, parts_.size(), [&](const Pair& p) { return p.rise <= allowance(p); },
            [&](const Pair& p) { return p.rise - allowance(p); });
        if (merges.empty()) return false;
        runtime::parallel_for(merges.size(), 1, [&](std::size_t i) {
            control_.check();
            unite(merges[i]);
        });
        rename_merged(pairs_, parts_.size(), merges);
        return true;
    }

    void unite(const Pair& p) {
        Part &a = parts_[p.a], &b = parts_[p.b];
        std::vector<std::uint32_t> faces;
        faces.reserve(a.faces.size() + b.faces.size());
        std::merge(a.faces.begin(), a.faces.end(), b.faces.begin(), b.faces.end(), std::back_inserter(faces));
        for (const std::uint32_t f : b.faces) labels_[f] = static_cast<std::int32_t>(p.a);
        const double expected = a.length + b.length + p.rise;
        a.moments = join(a.moments, b.moments);
        const Part& large = a.faces.size() < b.faces.size() ? b : a;
        const Part& small = &large == &a ? b : a;
        quadric::RegionFit fit = large.fit;
        std::size_t fitted = large.fitted_faces;
        // A surface hardly changes with the small ones that join it one by one: it is found anew when they add up.
        if (rules_.size_ratio * static_cast<double>(faces.size() - fitted) < static_cast<double>(fitted)) {
            fit.total += energy_under(small, fit.proxy);
        } else {
            fit = fit_faces(faces);
            fitted = faces.size();
        }
        a.fit = fit;
        a.fitted_faces = fitted;
        a.faces = std::move(faces);
        b.faces = {};
        a.length = std::min({expected, length_of(a.fit), a.moments.score.cost});
    }

    const partition::Passage& passage_;
    const mesh::WorkMesh& mesh_;
    partition::Labels& labels_;
    const CompleteMergeRules& rules_;
    const runtime::RunControl& control_;
    std::vector<Part> parts_;
    std::vector<Pair> pairs_;
};

}  // namespace

std::size_t merge_by_complete_fits(const partition::Passage& passage, partition::Labels& labels,
                                   std::vector<quadric::RegionFit> fits, std::vector<partition::MergeRegion> moments,
                                   const CompleteMergeRules& rules, const runtime::RunControl& control) {
    return CompleteMerger(passage, labels, std::move(fits), std::move(moments), rules, control).run();
}

}  // namespace quadseg::flow
