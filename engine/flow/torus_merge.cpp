#include "flow/torus_merge.h"

#include "flow/description_length.h"
#include "flow/merge_rounds.h"
#include "flow/region_sample.h"
#include "partition/band_cut.h"
#include "partition/border_price.h"
#include "runtime/parallel.h"
#include "surface/evaluate.h"
#include "surface/fit.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <optional>
#include <utility>

namespace quadseg::flow {
namespace {

using surface::SurfaceEvaluator;

constexpr int torus_parameters = 7;
/// Vertices that a torus is fitted to, of both regions together, and of the smaller one at least.
constexpr std::size_t sample_size = 240, least_sample = 40;
/// Those that tell at once that there is none, by so many times the distance that is too much.
constexpr std::size_t hasty_sample = 80;
constexpr double hasty_slack = 1.1;
constexpr int hasty_iterations = 20;
/// Rings of faces on both sides of a torus's border that may change sides at once, and how often.
constexpr std::size_t cut_rings = 12;
constexpr int cut_passes = 8;

struct Part {
    std::vector<std::uint32_t> faces;  ///< ascending
    quadric::Proxy proxy;
    std::optional<Surface> torus;  ///< instead of the proxy
    bool plane = false;
    double area = 0;
    double length = 0;  ///< of its description
};

struct Pair : MergePair {
    Surface torus;  ///< of both
    bool possible = false;
};

class TorusMerger {
  public:
    TorusMerger(const partition::Passage& passage, partition::Labels& labels,
                const std::vector<quadric::RegionFit>& fits, const std::vector<partition::MergeRegion>& moments,
                const TorusMergeRules& rules, const runtime::RunControl& control)
        : passage_(passage), mesh_(*passage.mesh), labels_(labels), rules_(rules), control_(control) {
        const partition::RegionFaces faces = partition::region_faces(labels, fits.size());
        parts_.resize(fits.size());
        runtime::parallel_for(parts_.size(), 16, [&](std::size_t r) {
            Part& part = parts_[r];
            const PricedFit least = fit_priced(moments[r].moments, rules_.merge.weight, rules_.merge.price);
            part.proxy = fits[r].proxy;
            part.plane = least.parameters == 3;
            part.area = moments[r].moments.total_area;
            part.faces.assign(faces.face.begin() + faces.begin[r], faces.face.begin() + faces.begin[r + 1]);
            const int parameters = part.proxy.planar() ? 3 : quadric_parameters;
            part.length =
                std::min(fits[r].energy.hybrid(rules_.merge.weight) + rules_.merge.price * parameters, least.length);
        });
    }

    std::vector<Surface> run() {
        pairs_ = merge_pairs_of<Pair>(passage_, labels_, control_);
        while (merge_round()) {
        }
        for (int pass = 0; pass < cut_passes && cut_borders(); ++pass) {
        }
        std::vector<std::int32_t> renumbered;
        Surface none;
        none.type = SurfaceType::freeform;
        std::vector<Surface> surfaces(partition::close_gaps(labels_, renumbered), none);
        for (std::size_t r = 0; r < renumbered.size(); ++r) {
            if (parts_[r].torus && renumbered[r] >= 0)
                surfaces[static_cast<std::size_t>(renumbered[r])] = *parts_[r].torus;
        }
        return surfaces;
    }

  private:
    double allowance(const Pair& p) const noexcept {
        const double smaller = std::min(parts_[p.a].area, parts_[p.b].area);
        const CompleteMergeRules& m = rules_.merge;
        return m.region_price + m.border_reward * p.border + m.misfit * smaller +
               partition::blurred(m.blur, m.blur_area, smaller);
    }

    /// E_d, of distances that are linear across the face, and ω E_n at its centroid.
    double energy(const SurfaceEvaluator& torus, std::size_t f, double weight) const {
        const double a = torus.distance(mesh_.corner(f, 0)), b = torus.distance(mesh_.corner(f, 1)),
                     c = torus.distance(mesh_.corner(f, 2));
        const double distance = (a * a + b * b + c * c + a * b + b * c + c * a) / 6;
        const double turn = squared_norm(torus.normal(mesh_.centroid(f)) - mesh_.normals[f]);
        return mesh_.areas[f] * (distance + weight * turn);
    }
    double energy(const SurfaceEvaluator& torus, const std::vector<std::uint32_t>& faces) const {
        double sum = 0;
        std::size_t polls = 0;
        for (const std::uint32_t f : faces) {
            control_.check_often(polls);
            sum += energy(torus, f, rules_.merge.weight);
        }
        return sum;
    }

    RegionSample sample(const Part& a, const Part& b) const {
        const double share = a.area / (a.area + b.area);
        const auto count = [&](double s) {
            return std::max(least_sample, static_cast<std::size_t>(s * static_cast<double>(sample_size)));
        };
        RegionSample both = sample_region(mesh_, labels_, a.faces.data(), a.faces.size(), count(share));
        both = both.thinned(count(share));
        const RegionSample other =
            sample_region(mesh_, labels_, b.faces.data(), b.faces.size(), count(1 - share)).thinned(count(1 - share));
        both.points.insert(both.points.end(), other.points.begin(), other.points.end());
        both.normals.insert(both.normals.end(), other.normals.begin(), other.normals.end());
        return both;
    }

    void measure(Pair& p) const {
        p.possible = false;
        const Part &a = parts_[p.a], &b = parts_[p.b];
        const bool a_is_small = a.faces.size() < b.faces.size();
        const Part &small = a_is_small ? a : b, &large = a_is_small ? b : a;
        if (large.plane && !large.torus) return;
        if (small.plane && !large.torus && 4 * small.area > large.area) return;
        const double apart = a.length + b.length, limit = allowance(p);
        const auto accept = [&](const Surface& torus, double rise) {
            p.torus = torus;
            p.rise = rise;
            p.possible = rise <= limit;
        };
        if (large.torus && rules_.merge.size_ratio * static_cast<double>(small.faces.size()) <
                               static_cast<double>(large.faces.size())) {
            accept(*large.torus, energy(SurfaceEvaluator(*large.torus), small.faces) - small.length);
            return;
        }
        // What the distances alone refuse need not be measured. (Linear ones across faces: at least a quarter of d².)
        const double price = torus_parameters * rules_.merge.price, most = limit + apart - price;
        if (!(most > 0)) return;
        const double most_rms = std::sqrt(4 * most / (a.area + b.area));
        const RegionSample points = sample(a, b);
        surface::FitOptions options;
        options.robust = false;
        if (!large.torus) {
            // Most pairs lie on no torus, which fewer points tell sooner.
            surface::FitOptions hasty = options;
            hasty.most_rms = hasty_slack * most_rms;
            hasty.iterations = hasty_iterations;
            if (!surface::fit(SurfaceType::torus, points.thinned(hasty_sample).all(), hasty).ok) return;
        }
        const surface::SurfaceFit fit = large.torus ? surface::refine(*large.torus, points.all(), options)
                                                    : surface::fit(SurfaceType::torus, points.all(), options);
        if (!fit.ok || fit.rms > most_rms) return;
        if (!(fit.surface.radius > rules_.least_ratio * fit.surface.minor_radius)) return;
        const SurfaceEvaluator torus(fit.surface);
        accept(fit.surface, energy(torus, a.faces) + energy(torus, b.faces) + price - apart);
    }

    bool merge_round() {
        measure_pairs(
            pairs_, [&](Pair& p) { measure(p); }, control_);
        const std::vector<Pair> merges = best_merges(
            pairs_, parts_.size(), [](const Pair& p) { return p.possible; },
            [&](const Pair& p) { return p.rise - allowance(p); });
        if (merges.empty()) return false;
        for (const Pair& p : merges) unite(p);
        rename_merged(pairs_, parts_.size(), merges);
        return true;
    }

    void unite(const Pair& p) {
        Part &a = parts_[p.a], &b = parts_[p.b];
        for (const std::uint32_t f : b.faces) labels_[f] = static_cast<std::int32_t>(p.a);
        a.faces = merged(a.faces, b.faces);
        a.length += b.length + p.rise;
        a.area += b.area;
        a.torus = p.torus;
        a.plane = false;
        b.faces = {};
        b.area = 0;
    }

    static std::vector<std::uint32_t> merged(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
        std::vector<std::uint32_t> both;
        both.reserve(a.size() + b.size());
        std::merge(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
        return both;
    }

    std::function<double(std::uint32_t)> energy_in(const Part& part) const {
        if (part.torus) {
            return [this, torus = SurfaceEvaluator(*part.torus)](std::uint32_t f) {
                return energy(torus, f, rules_.cut_weight);
            };
        }
        return [this, &proxy = part.proxy](std::uint32_t f) {
            return quadric::triangle_energy(proxy, mesh_.corner(f, 0), mesh_.corner(f, 1), mesh_.corner(f, 2),
                                            mesh_.normals[f], mesh_.areas[f])
                .hybrid(rules_.cut_weight);
        };
    }

    /// The borders of all tori, one after the other. False: nothing has moved.
    bool cut_borders() {
        bool any = false;
        node_.assign(labels_.size(), -1);
        for (const Pair& p : pairs_) {
            if (!parts_[p.a].torus && !parts_[p.b].torus) continue;
            control_.check();
            any = cut(p) || any;
        }
        return any;
    }

    bool cut(const Pair& p) {
        const auto a = static_cast<std::int32_t>(p.a), b = static_cast<std::int32_t>(p.b);
        const std::vector<std::uint32_t> band = band_of(a, b);
        for (std::size_t i = 0; i < band.size(); ++i) node_[band[i]] = static_cast<std::int32_t>(i);
        cut_.clear();
        const auto energy_in_a = energy_in(parts_[p.a]), energy_in_b = energy_in(parts_[p.b]);
        for (const std::uint32_t f : band) {
            double in_a = energy_in_a(f), in_b = energy_in_b(f);
            for (std::size_t k = 0; k < 3; ++k) {
                const std::int32_t g = passage_.across(f, k);
                if (g < 0 || node_[static_cast<std::size_t>(g)] >= 0) continue;
                const double price = rules_.border_price * partition::edge_length(mesh_, f, k);
                if (labels_[static_cast<std::size_t>(g)] == a) in_b += price;
                if (labels_[static_cast<std::size_t>(g)] == b) in_a += price;
            }
            cut_.add_node(in_a, in_b);
        }
        for (std::size_t i = 0; i < band.size(); ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                const std::int32_t g = passage_.across(band[i], k);
                if (g < 0 || node_[static_cast<std::size_t>(g)] <= static_cast<std::int32_t>(i)) continue;
                const std::size_t slot = mesh::matching_edge(mesh_, band[i], k);
                cut_.add_edge(i, k, static_cast<std::size_t>(node_[static_cast<std::size_t>(g)]), slot,
                              rules_.border_price * partition::edge_length(mesh_, band[i], k));
            }
        }
        const std::vector<std::uint8_t>& side = cut_.solve();
        std::size_t moved = 0;
        for (std::size_t i = 0; i < band.size(); ++i) {
            node_[band[i]] = -1;
            moved += relabel(band[i], side[i] == 0 ? a : b) ? 1 : 0;
        }
        try {
            if (moved > 0) keep_connected(p);
        } catch (const runtime::Stopped&) {
            for (; !relabelled_.empty(); relabelled_.pop_back())
                labels_[relabelled_.back().first] = relabelled_.back().second;
            throw;
        }
        relabelled_.clear();
        return moved > 0;
    }
    bool relabel(std::uint32_t f, std::int32_t label) {
        if (labels_[f] == label) return false;
        relabelled_.emplace_back(f, labels_[f]);
        labels_[f] = label;
        return true;
    }

    std::vector<std::uint32_t> band_of(std::int32_t a, std::int32_t b) {
        std::vector<std::uint32_t> band;
        std::size_t polls = 0;
        for (const std::int32_t own : {a, b}) {
            const std::int32_t other = own == a ? b : a;
            for (const std::uint32_t f : parts_[static_cast<std::size_t>(own)].faces) {
                control_.check_often(polls);
                for (std::size_t k = 0; k < 3 && node_[f] < 0; ++k) {
                    const std::int32_t g = passage_.across(f, k);
                    if (g < 0 || labels_[static_cast<std::size_t>(g)] != other) continue;
                    node_[f] = 0;
                    band.push_back(f);
                }
            }
        }
        for (std::size_t ring = 0, begin = 0; ring < cut_rings; ++ring) {
            const std::size_t end = band.size();
            for (std::size_t i = begin; i < end; ++i) {
                for (std::size_t k = 0; k < 3; ++k) {
                    const std::int32_t g = passage_.across(band[i], k);
                    if (g < 0 || node_[static_cast<std::size_t>(g)] >= 0) continue;
                    const std::int32_t label = labels_[static_cast<std::size_t>(g)];
                    if (label != a && label != b) continue;
                    node_[static_cast<std::size_t>(g)] = 0;
                    band.push_back(static_cast<std::uint32_t>(g));
                }
            }
            begin = end;
        }
        return band;
    }

    /// Lists the faces of both regions anew; all but the largest part of each goes to the other one.
    void keep_connected(const Pair& p) {
        const std::vector<std::uint32_t> both = merged(parts_[p.a].faces, parts_[p.b].faces);
        for (int round = 0; round < 2; ++round) {
            for (const std::uint32_t r : {p.a, p.b}) give_islands_away(both, r, r == p.a ? p.b : p.a);
        }
        std::vector<std::uint32_t> in_a, in_b;
        std::size_t polls = 0;
        for (const std::uint32_t f : both) {
            control_.check_often(polls);
            (labels_[f] == static_cast<std::int32_t>(p.a) ? in_a : in_b).push_back(f);
        }
        parts_[p.a].faces = std::move(in_a);
        parts_[p.b].faces = std::move(in_b);
    }
    void give_islands_away(const std::vector<std::uint32_t>& both, std::uint32_t from, std::uint32_t to) {
        const auto own = static_cast<std::int32_t>(from);
        std::vector<std::vector<std::uint32_t>> parts;
        std::size_t largest = 0, polls = 0;
        for (const std::uint32_t seed : both) {
            control_.check_often(polls);
            if (labels_[seed] != own || node_[seed] >= 0) continue;
            std::vector<std::uint32_t> part{seed};
            node_[seed] = 0;
            for (std::size_t i = 0; i < part.size(); ++i) {
                control_.check_often(polls);
                for (std::size_t k = 0; k < 3; ++k) {
                    const std::int32_t g = passage_.across(part[i], k);
                    if (g < 0 || labels_[static_cast<std::size_t>(g)] != own || node_[static_cast<std::size_t>(g)] >= 0)
                        continue;
                    node_[static_cast<std::size_t>(g)] = 0;
                    part.push_back(static_cast<std::uint32_t>(g));
                }
            }
            if (!parts.empty() && part.size() > parts[largest].size()) largest = parts.size();
            parts.push_back(std::move(part));
        }
        for (std::size_t i = 0; i < parts.size(); ++i) {
            for (const std::uint32_t f : parts[i]) {
                node_[f] = -1;
                if (i != largest) (void)relabel(f, static_cast<std::int32_t>(to));
            }
        }
    }

    const partition::Passage& passage_;
    const mesh::WorkMesh& mesh_;
    partition::Labels& labels_;
    const TorusMergeRules& rules_;
    const runtime::RunControl& control_;
    std::vector<Part> parts_;
    std::vector<Pair> pairs_;
    partition::BandCut cut_;
    std::vector<std::int32_t> node_;  ///< of a face; −1 between the steps
    /// What the present cut has changed: faces with their labels before.
    std::vector<std::pair<std::uint32_t, std::int32_t>> relabelled_;
};

}  // namespace

std::vector<Surface> merge_into_tori(const partition::Passage& passage, partition::Labels& labels,
                                     const std::vector<quadric::RegionFit>& fits,
                                     const std::vector<partition::MergeRegion>& moments, const TorusMergeRules& rules,
                                     const runtime::RunControl& control) {
    return TorusMerger(passage, labels, fits, moments, rules, control).run();
}

}  // namespace quadseg::flow
