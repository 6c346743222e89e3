#include "partition/relax.h"

#include "partition/border_cut.h"
#include "partition/face_choice.h"
#include "quadric/ladder.h"
#include "runtime/parallel.h"
#include "runtime/per_thread.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>

namespace quadseg::partition {
namespace {

constexpr std::size_t face_grain = 8192;
constexpr std::size_t work_grain = 1024;
constexpr std::size_t region_grain = 64;
constexpr int most_sweeps = 200;
constexpr std::int32_t orphan = -2;
/// Of |∇f|, which least squares with unit weights keep near 1 (MATH.md §3).
constexpr double gradient_floor = 0.05;

class Relaxer {
  public:
    Relaxer(const Passage& passage, Labels& labels, std::vector<MergeRegion>&& regions, const RelaxOptions& options,
            const runtime::RunControl& control)
        : passage_(passage),
          mesh_(*passage.mesh),
          labels_(labels),
          count_(regions.size()),
          options_(options),
          control_(control),
          moments_(std::move(regions)),
          dirty_(count_, 1),
          stale_(count_, 0),
          stamp_(labels.size(), 0) {
        result_.fits.resize(count_);
    }

    Relaxed run() {
        Labels best = labels_;
        try {
            if (options_.moment_steps > 0) {
                fitted_labels_ = labels_;
                for (int step = 0; step < options_.moment_steps; ++step) {
                    refit_from_moments();
                    if (!move_faces()) break;
                    repair_connectivity();
                }
                best = labels_;
            }
            if (options_.steps >= 0) {
                std::fill(dirty_.begin(), dirty_.end(), std::uint8_t{1});
                iterate(options_.steps, best, [this] { refit(); });
            }
        } catch (const runtime::Stopped&) {
            result_.stopped = true;
        }
        labels_ = std::move(best);
        return std::move(result_);
    }

  private:
    template <class Refit>
    void iterate(int steps, Labels& best, const Refit& refit_dirty) {
        refit_dirty();
        Relaxed kept = result_;
        std::vector<std::uint8_t> kept_stale = stale_;
        for (int step = 0; step < steps; ++step) {
            const double before = kept.energy;
            if (!move_faces()) break;
            repair_connectivity();
            refit_dirty();
            if (!(result_.energy < before)) break;
            best = labels_;
            kept = result_;
            kept_stale = stale_;
            if (!(result_.energy < (1 - options_.stop) * before)) break;
        }
        labels_ = best;
        result_ = std::move(kept);
        fit_stale(kept_stale);
    }

    quadric::TriangleEnergy energies(std::size_t f, const quadric::Proxy& proxy) const noexcept {
        return quadric::triangle_energy(proxy, mesh_.corner(f, 0), mesh_.corner(f, 1), mesh_.corner(f, 2),
                                        mesh_.normals[f], mesh_.areas[f]);
    }
    double energy(std::size_t f, std::int32_t label) const noexcept {
        return energies(f, result_.fits[static_cast<std::size_t>(label)].proxy).hybrid(options_.fit.weight);
    }
    std::int32_t label_across(std::size_t f, std::size_t k) const noexcept {
        const std::int32_t g = passage_.across(f, k);
        return g < 0 ? -1 : labels_[static_cast<std::size_t>(g)];
    }

    struct Change {
        std::int32_t region;
        std::uint32_t face;
        double sign;  ///< +1: the face joined the region, −1: it left
    };

    /// What changed since the last call, by region, then face.
    std::vector<Change> changes() {
        std::vector<Change> result;
        for (std::size_t f = 0; f < labels_.size(); ++f) {
            if (labels_[f] == fitted_labels_[f]) continue;
            result.push_back({fitted_labels_[f], static_cast<std::uint32_t>(f), -1});
            result.push_back({labels_[f], static_cast<std::uint32_t>(f), 1});
            fitted_labels_[f] = labels_[f];
        }
        control_.check();
        std::sort(result.begin(), result.end(), [](const Change& a, const Change& b) {
            return a.region != b.region ? a.region < b.region : a.face < b.face;
        });
        return result;
    }

    static auto first_of(const std::vector<Change>& changes, std::size_t r) {
        return std::lower_bound(changes.begin(), changes.end(), r, [](const Change& c, std::size_t region) {
            return static_cast<std::size_t>(c.region) < region;
        });
    }

    /// Brings the moments of the regions up to date, face by face that changed.
    void update_moments(const std::vector<Change>& changes) {
        runtime::parallel_blocks(count_, region_grain, [&](std::size_t begin, std::size_t end) {
            control_.check();
            for (auto change = first_of(changes, begin), last = first_of(changes, end); change != last; ++change) {
                MergeRegion& region = moments_[static_cast<std::size_t>(change->region)];
                const std::size_t f = change->face;
                quadric::accumulate(region.moments, mesh_.corner(f, 0) - region.origin,
                                    mesh_.corner(f, 1) - region.origin, mesh_.corner(f, 2) - region.origin,
                                    mesh_.normals[f], change->sign * mesh_.areas[f]);
            }
        });
    }

    /// A region that hardly changed keeps its surface: E is additive, so its faces' energies come and go. False: it
    /// changed by more than options.settled of its area.
    bool keep_surface(std::size_t r, const std::vector<Change>& changes) {
        const auto begin = first_of(changes, r), end = first_of(changes, r + 1);
        if (begin == end) return true;
        double moved = 0;
        for (auto change = begin; change != end; ++change) moved += mesh_.areas[change->face];
        if (!(moved <= options_.settled * moments_[r].moments.total_area)) return false;
        quadric::RegionFit& fit = result_.fits[r];
        for (auto change = begin; change != end; ++change) {
            const quadric::TriangleEnergy e = energies(change->face, fit.proxy);
            fit.energy.distance = std::max(0.0, fit.energy.distance + change->sign * e.distance);
            fit.energy.normal = std::max(0.0, fit.energy.normal + change->sign * e.normal);
        }
        fit.total = fit.energy.hybrid(options_.fit.weight);
        stale_[r] = 1;
        return true;
    }

    /// In the end those that kept their surface so get the one of their faces.
    void fit_stale(const std::vector<std::uint8_t>& stale) {
        std::vector<std::uint32_t> work;
        for (std::uint32_t r = 0; r < count_; ++r) {
            if (stale[r] != 0) work.push_back(r);
        }
        if (work.empty()) return;
        regions_ = region_faces(labels_, count_);
        fit_completely(work, false);
        sum_energy();
    }

    void refit_from_moments() {
        update_moments(changes());
        runtime::parallel_blocks(count_, region_grain, [&](std::size_t begin, std::size_t end) {
            control_.check();
            for (std::size_t r = begin; r < end; ++r) {
                if (dirty_[r] == 0) continue;
                const MergeRegion& region = moments_[r];
                const MomentFit fit =
                    options_.moment_fit ? options_.moment_fit(region.moments) : plane_or_quadric(region.moments);
                result_.fits[r].proxy = {region.origin, fit.c, gradient_floor};
                result_.fits[r].total = fit.energy;
            }
        });
        sum_energy();
    }

    /// A region whose moments already say that it is plane enough needs no look at its faces, of which it may have
    /// very many.
    bool fit_plane_from_moments(std::size_t r) {
        const MergeRegion& region = moments_[r];
        const double area = region.moments.total_area;
        const double tolerance = options_.fit.plane_tolerance * (options_.fit.plane_tolerance_per_area ? area : 1);
        const quadric::LadderFit plane = quadric::fit_ladder(region.moments, options_.fit.weight, false);
        if (!(area > 0) || plane.model != quadric::LadderModel::plane) return false;
        const quadric::TriangleEnergy e = quadric::moment_energy(plane.c, region.moments);
        const quadric::TriangleEnergy energy{std::max(0.0, e.distance), std::max(0.0, e.normal)};
        if (!(energy.hybrid(options_.fit.weight) <= tolerance)) return false;
        quadric::RegionFit& fit = result_.fits[r];
        fit = {};
        fit.proxy = {region.origin, plane.c, 1e-6};
        fit.energy = energy;
        fit.total = energy.hybrid(options_.fit.weight);
        return true;
    }

    MomentFit plane_or_quadric(const quadric::Moments& m) const {
        const quadric::LadderFit fit = quadric::fit_ladder(m, options_.fit.weight, false);
        return {fit.c, fit.energy};
    }

    double border_cost() const {
        const auto of_faces = [&](std::size_t begin, std::size_t end) {
            control_.check();
            double sum = 0;
            for (std::size_t f = begin; f < end; ++f) {
                for (std::size_t k = 0; k < 3; ++k) {
                    const std::int32_t own = labels_[f], other = label_across(f, k);
                    if (own < 0 || other <= own) continue;
                    sum += options_.border.of_edge(mesh_, f, k, static_cast<std::size_t>(passage_.across(f, k)),
                                                   result_.fits[static_cast<std::size_t>(own)].proxy,
                                                   result_.fits[static_cast<std::size_t>(other)].proxy);
                }
            }
            return sum;
        };
        return runtime::reduce_blocks(labels_.size(), face_grain, 0.0, of_faces, std::plus<>());
    }

    void sum_energy() {
        result_.energy = options_.border.length > 0 ? border_cost() : 0;
        for (const quadric::RegionFit& fit : result_.fits) result_.energy += fit.total;
    }

    /// Complete fits of the dirty regions; what keeps its surface is dirty no more.
    void refit() {
        if (!regions_current_) regions_ = region_faces(labels_, count_);
        regions_current_ = false;
        const bool moments_known = options_.moment_steps > 0;
        if (moments_known) {
            const std::vector<Change> changed = changes();
            update_moments(changed);
            if (complete_ && options_.settled > 0) {
                runtime::parallel_for(count_, region_grain, [&](std::size_t r) {
                    if (dirty_[r] != 0 && regions_.size(r) > 0 && keep_surface(r, changed)) dirty_[r] = 0;
                });
            }
        }
        complete_ = true;
        std::vector<std::uint32_t> work;
        for (std::uint32_t r = 0; r < count_; ++r) {
            if (dirty_[r] != 0 && regions_.size(r) > 0) work.push_back(r);
        }
        fit_completely(work, moments_known);
        for (std::size_t r = 0; r < count_; ++r) {
            if (regions_.size(r) == 0) result_.fits[r] = {};
        }
        sum_energy();
    }

    /// Of regions_, which are those of labels_.
    void fit_completely(std::vector<std::uint32_t> work, bool moments_known) {
        // Largest first, so that one big region does not start last.
        std::sort(work.begin(), work.end(), [&](std::uint32_t a, std::uint32_t b) {
            return regions_.size(a) != regions_.size(b) ? regions_.size(a) > regions_.size(b) : a < b;
        });
        quadric::RegionFitOptions fit = options_.fit;
        fit.poll = [this] { control_.check(); };  // a region may have most of the mesh's faces
        runtime::parallel_for(work.size(), 1, [&](std::size_t i) {
            control_.check();
            const std::size_t r = work[i];
            stale_[r] = 0;
            if (moments_known && fit_plane_from_moments(r)) return;
            GatheredRegion& gathered = gathered_.local();
            gather(mesh_, regions_.face.data() + regions_.begin[r], regions_.size(r), gathered, &control_);
            result_.fits[r] = quadric::fit_region(gathered.soup(), fit);
        });
    }

    std::vector<std::uint32_t> border_faces() const {
        const auto find = [&](std::size_t begin, std::size_t end, std::vector<std::uint32_t>& found) {
            control_.check();
            for (std::size_t f = begin; f < end; ++f) {
                const std::int32_t own = labels_[f];
                if (own < 0) continue;
                for (std::size_t k = 0; k < 3; ++k) {
                    const std::int32_t other = label_across(f, k);
                    if (other < 0 || other == own) continue;
                    // Between two regions that did not change nothing has become cheaper.
                    if (dirty_[static_cast<std::size_t>(own)] == 0 && dirty_[static_cast<std::size_t>(other)] == 0)
                        continue;
                    found.push_back(static_cast<std::uint32_t>(f));
                    break;
                }
            }
        };
        return runtime::collect_blocks<std::uint32_t>(labels_.size(), face_grain, find);
    }

    std::vector<std::uint32_t> all_border_faces() {
        const std::vector<std::uint8_t> dirty = dirty_;
        std::fill(dirty_.begin(), dirty_.end(), std::uint8_t{1});
        std::vector<std::uint32_t> border = border_faces();
        dirty_ = dirty;
        return border;
    }

    /// All pairs are cut at once; a cut holds unless another one before it changed a face that it reckoned with.
    bool cut_borders() {
        const std::vector<BorderCut> cuts = partition::cut_borders(
            passage_, labels_, result_.fits, {options_.fit.weight, options_.border, options_.cut_rings}, border_faces(),
            control_);
        ++sweep_stamp_;
        std::fill(dirty_.begin(), dirty_.end(), std::uint8_t{0});
        bool moved = false;
        for (const BorderCut& cut : cuts) {
            const auto touched = [&](std::uint32_t f) {
                if (stamp_[f] == sweep_stamp_) return true;
                for (std::size_t k = 0; k < 3; ++k) {
                    const std::int32_t g = passage_.across(f, k);
                    if (g >= 0 && stamp_[static_cast<std::size_t>(g)] == sweep_stamp_) return true;
                }
                return false;
            };
            if (cut.faces.empty() || std::any_of(cut.faces.begin(), cut.faces.end(), touched)) continue;
            for (const std::uint32_t f : cut.faces) {
                labels_[f] = labels_[f] == cut.a ? cut.b : cut.a;
                stamp_[f] = sweep_stamp_;
            }
            dirty_[static_cast<std::size_t>(cut.a)] = dirty_[static_cast<std::size_t>(cut.b)] = 1;
            moved = true;
            regions_current_ = false;
        }
        return moved;
    }

    /// Sweeps over the border until no face gains. Without a price of borders E is a sum over faces and all may decide
    /// at once (Jacobi); with one, neighbours take turns: the larger gain first.
    bool move_faces() {
        const bool cut = options_.border.length > 0 && options_.cut_rings > 0 && cut_borders();
        const std::vector<std::uint8_t> cut_dirty = cut ? dirty_ : std::vector<std::uint8_t>();
        return sweep(cut ? all_border_faces() : border_faces(), cut_dirty) || cut;
    }

    bool sweep(std::vector<std::uint32_t> work, const std::vector<std::uint8_t>& dirty_before) {
        std::fill(dirty_.begin(), dirty_.end(), std::uint8_t{0});
        if (!dirty_before.empty()) dirty_ = dirty_before;
        const bool take_turns = options_.border.length > 0;
        if (take_turns && gain_.empty()) gain_.assign(labels_.size(), 0);
        const FaceChooser chooser(passage_, labels_, result_.fits,
                                  {options_.fit.weight, options_.border, options_.margin});
        std::vector<FaceChoice> decided;
        bool moved = false;
        for (int sweep = 0; sweep < most_sweeps && !work.empty(); ++sweep) {
            decided.resize(work.size());
            runtime::parallel_blocks(work.size(), work_grain, [&](std::size_t begin, std::size_t end) {
                control_.check();
                chooser.decide({&work[begin], end - begin}, &decided[begin]);
            });
            std::vector<std::uint32_t> waiting;
            if (take_turns) waiting = wait_for_neighbors(work, decided);
            control_.check();
            work = apply(work, decided);
            moved = moved || !work.empty();
            for (const std::uint32_t f : waiting) {
                if (stamp_[f] == sweep_stamp_) continue;
                stamp_[f] = sweep_stamp_;
                work.push_back(f);
            }
        }
        return moved;
    }

    /// Of two neighbours that both want to move the one with the smaller gain stays for this sweep.
    std::vector<std::uint32_t> wait_for_neighbors(const std::vector<std::uint32_t>& work,
                                                  std::vector<FaceChoice>& decided) {
        control_.check();
        for (std::size_t i = 0; i < work.size(); ++i) {
            gain_[work[i]] = decided[i].label != labels_[work[i]] ? decided[i].gain : 0;
        }
        std::vector<std::uint32_t> waiting;
        for (std::size_t i = 0; i < work.size(); ++i) {
            const std::uint32_t f = work[i];
            if (decided[i].label == labels_[f]) continue;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::int32_t g = passage_.across(f, k);
                if (g < 0) continue;
                const double gain = gain_[static_cast<std::size_t>(g)];
                if (gain > decided[i].gain || (gain == decided[i].gain && static_cast<std::uint32_t>(g) < f)) {
                    waiting.push_back(f);
                    decided[i].label = labels_[f];
                    break;
                }
            }
        }
        for (const std::uint32_t f : work) gain_[f] = 0;
        return waiting;
    }

    /// Moves the faces and returns those that the moves may concern.
    std::vector<std::uint32_t> apply(const std::vector<std::uint32_t>& work, const std::vector<FaceChoice>& decided) {
        std::vector<std::uint32_t> concerned;
        ++sweep_stamp_;
        const auto concern = [&](std::size_t f) {
            if (stamp_[f] == sweep_stamp_) return;
            stamp_[f] = sweep_stamp_;
            concerned.push_back(static_cast<std::uint32_t>(f));
        };
        for (std::size_t i = 0; i < work.size(); ++i) {
            const std::size_t f = work[i];
            if (decided[i].label == labels_[f]) continue;
            regions_current_ = false;
            dirty_[static_cast<std::size_t>(labels_[f])] = 1;
            dirty_[static_cast<std::size_t>(decided[i].label)] = 1;
            labels_[f] = decided[i].label;
            concern(f);
            for (std::size_t k = 0; k < 3; ++k) {
                const std::int32_t g = passage_.across(f, k);
                if (g >= 0 && labels_[static_cast<std::size_t>(g)] >= 0) concern(static_cast<std::size_t>(g));
            }
        }
        return concerned;
    }

    /// Of every changed region the largest part stays; the rest is flooded again from around it.
    void repair_connectivity() {
        control_.check();
        regions_ = region_faces(labels_, count_);
        std::vector<std::uint32_t> changed;
        for (std::uint32_t r = 0; r < count_; ++r) {
            if (dirty_[r] != 0 && regions_.size(r) > 1) changed.push_back(r);
        }
        ++sweep_stamp_;
        std::vector<std::vector<std::uint32_t>> cut(changed.size());
        runtime::parallel_for(changed.size(), 1, [&](std::size_t i) {
            control_.check();
            cut[i] = smaller_parts(changed[i]);
        });
        std::vector<std::uint32_t> orphans;
        for (const auto& part : cut) orphans.insert(orphans.end(), part.begin(), part.end());
        if (!orphans.empty()) flood(orphans);
        regions_current_ = orphans.empty();
    }

    /// Faces of region r outside its part of largest area.
    std::vector<std::uint32_t> smaller_parts(std::uint32_t r) {
        const std::uint32_t* const faces = regions_.face.data() + regions_.begin[r];
        const std::size_t size = regions_.size(r);
        std::vector<std::uint32_t> order;
        std::vector<std::size_t> part_begin;
        std::vector<double> part_area;
        order.reserve(size);
        for (std::size_t i = 0; i < size; ++i) {
            if (stamp_[faces[i]] == sweep_stamp_) continue;
            part_begin.push_back(order.size());
            double area = 0;
            stamp_[faces[i]] = sweep_stamp_;
            order.push_back(faces[i]);
            for (std::size_t head = part_begin.back(); head < order.size(); ++head) {
                const std::size_t f = order[head];
                area += mesh_.areas[f];
                for (std::size_t k = 0; k < 3; ++k) {
                    const std::int32_t g = passage_.across(f, k);
                    if (g < 0) continue;
                    const auto u = static_cast<std::size_t>(g);
                    if (labels_[u] != static_cast<std::int32_t>(r) || stamp_[u] == sweep_stamp_) continue;
                    stamp_[u] = sweep_stamp_;
                    order.push_back(static_cast<std::uint32_t>(u));
                }
            }
            part_area.push_back(area);
        }
        if (part_begin.size() < 2) return {};
        const std::size_t largest =
            static_cast<std::size_t>(std::max_element(part_area.begin(), part_area.end()) - part_area.begin());
        part_begin.push_back(order.size());
        order.erase(order.begin() + static_cast<std::ptrdiff_t>(part_begin[largest]),
                    order.begin() + static_cast<std::ptrdiff_t>(part_begin[largest + 1]));
        return order;
    }

    struct Claim {
        double energy;
        std::uint32_t face;
        std::int32_t label;
        friend bool operator<(const Claim& a, const Claim& b) noexcept {
            if (a.energy != b.energy) return a.energy > b.energy;
            if (a.face != b.face) return a.face > b.face;
            return a.label > b.label;
        }
    };

    void flood(const std::vector<std::uint32_t>& orphans) {
        std::vector<std::int32_t> former(orphans.size());
        for (std::size_t i = 0; i < orphans.size(); ++i) {
            former[i] = labels_[orphans[i]];
            labels_[orphans[i]] = orphan;
        }
        std::priority_queue<Claim> claims;
        const auto claim = [&](std::size_t f, std::int32_t label) {
            const double e = energy(f, label);
            claims.push({std::isnan(e) ? std::numeric_limits<double>::max() : e, static_cast<std::uint32_t>(f), label});
        };
        std::size_t polled = 0;
        for (const std::uint32_t f : orphans) {
            control_.check_often(polled);
            for (std::size_t k = 0; k < 3; ++k) {
                if (const std::int32_t label = label_across(f, k); label >= 0) claim(f, label);
            }
        }
        while (!claims.empty()) {
            control_.check_often(polled);
            const Claim c = claims.top();
            claims.pop();
            if (labels_[c.face] != orphan) continue;
            labels_[c.face] = c.label;
            dirty_[static_cast<std::size_t>(c.label)] = 1;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::int32_t g = passage_.across(c.face, k);
                if (g >= 0 && labels_[static_cast<std::size_t>(g)] == orphan)
                    claim(static_cast<std::size_t>(g), c.label);
            }
        }
        // Parts that were cut off from everything already in the input stay as they are.
        for (std::size_t i = 0; i < orphans.size(); ++i) {
            if (labels_[orphans[i]] == orphan) labels_[orphans[i]] = former[i];
        }
    }

    const Passage& passage_;
    const mesh::WorkMesh& mesh_;
    Labels& labels_;
    std::size_t count_;
    const RelaxOptions& options_;
    const runtime::RunControl& control_;
    std::vector<MergeRegion> moments_;
    Labels fitted_labels_;  ///< those that the moments belong to
    std::vector<std::uint8_t> dirty_;
    std::vector<std::uint8_t> stale_;  ///< faces came or went since the surface was fitted
    std::vector<std::uint32_t> stamp_;
    std::vector<double> gain_;  ///< of the faces that want to move, else 0
    std::uint32_t sweep_stamp_ = 0;
    RegionFaces regions_;
    bool regions_current_ = false;  ///< regions_ are those of labels_
    runtime::PerThread<GatheredRegion> gathered_;
    bool complete_ = false;  ///< the fits are complete ones, not those from moments
    Relaxed result_;
};

}  // namespace

Relaxed relax(const Passage& passage, Labels& labels, std::vector<MergeRegion> regions, const RelaxOptions& options,
              const runtime::RunControl& control) {
    return Relaxer(passage, labels, std::move(regions), options, control).run();
}

}  // namespace quadseg::partition
