#include "simplify/decimate.h"

#include "runtime/parallel.h"
#include "simplify/collapse_mesh.h"
#include "simplify/face_map.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

namespace quadseg::simplify {
namespace {

constexpr std::size_t grain = 1024;
constexpr std::size_t collapse_grain = 128;
/// Each round considers this share of the vertices, those with the cheapest collapses.
constexpr double candidate_share = 0.3;
constexpr std::size_t quantile_samples = 4096;
/// Rivals whose stars overlap compete this often a round.
constexpr std::uint64_t contests = 2;
constexpr float unusable = std::numeric_limits<float>::infinity();

/// Ban bits of a corner: the edge to its successor or its predecessor was refused and nothing around it has changed.
enum Ban : std::uint8_t { ban_next = 1, ban_previous = 2 };

struct Candidate {
    std::uint32_t partner = none;  ///< the vertex of higher index that collapses into this one
    float cost = unusable;
};

/// One to one on 32 bits (Wellons' lowbias32): spreads rivals of equal cost over the surface.
std::uint32_t scramble(std::uint32_t x) {
    x ^= x >> 16;
    x *= 0x7feb352dU;
    x ^= x >> 15;
    x *= 0x846ca68bU;
    x ^= x >> 16;
    return x;
}

void lower(std::uint64_t& claim, std::uint64_t key) {
    std::atomic_ref<std::uint64_t> shared(claim);
    std::uint64_t seen = shared.load(std::memory_order_relaxed);
    while (key < seen && !shared.compare_exchange_weak(seen, key, std::memory_order_relaxed)) {
    }
}

/// The elements of `list` that `keep` wants, in order.
template <class Keep>
std::vector<std::uint32_t> filter(const std::vector<std::uint32_t>& list, const Keep& keep) {
    std::vector<std::vector<std::uint32_t>> parts((list.size() + grain - 1) / grain);
    runtime::parallel_blocks(list.size(), grain, [&](std::size_t begin, std::size_t end) {
        std::vector<std::uint32_t>& part = parts[begin / grain];
        for (std::size_t i = begin; i < end; ++i) {
            if (keep(list[i])) part.push_back(list[i]);
        }
    });
    std::vector<std::uint32_t> kept;
    for (const auto& part : parts) kept.insert(kept.end(), part.begin(), part.end());
    return kept;
}

/// Rounds of collapses at once: the cheapest edge of every vertex; a threshold; of rivals whose stars overlap the
/// cheapest (Luby's independent sets); their collapses in parallel; new costs around them only.
class Decimator {
  public:
    Decimator(CollapseMesh& mesh, std::size_t target, const std::function<bool()>& stopped)
        : mesh_(mesh), target_(target), stopped_(stopped) {}

    void run() {
        const std::size_t vertices = mesh_.vertices.size();
        candidates_.resize(vertices);
        changed_.assign(vertices, 0);
        dirty_.assign(vertices, 0);
        has_ban_.assign(vertices, 0);
        bans_.assign(mesh_.next_corner.size(), 0);
        vertex_claims_.assign(vertices, std::numeric_limits<std::uint64_t>::max());
        face_claims_.assign(mesh_.faces.size(), std::numeric_limits<std::uint64_t>::max());
        live_.clear();
        for (std::size_t v = 0; v < vertices; ++v) {
            if (mesh_.first_corner[v] != none) live_.push_back(static_cast<std::uint32_t>(v));
        }
        for (const bool keep_shape : {true, false}) {
            keep_shape_ = keep_shape;
            evaluate_all_ = true;
            double share = candidate_share;
            while (mesh_.face_count > target_ && !stopped_()) {
                const RoundResult result = round(share);
                if (result.candidates == 0) break;
                share = 64 * result.collapses < result.candidates ? 1 : candidate_share;
            }
            std::fill(bans_.begin(), bans_.end(), std::uint8_t{0});
        }
    }

    double max_error() const noexcept { return max_error_; }

  private:
    struct RoundResult {
        std::size_t candidates = 0, collapses = 0;
    };

    RoundResult round(double share) {
        ++round_;
        runtime::parallel_blocks(live_.size(), grain, [&](std::size_t begin, std::size_t end) {
            if (stopped_()) return;
            for (std::size_t i = begin; i < end; ++i) update_candidate(live_[i]);
        });
        evaluate_all_ = false;
        if (stopped_()) return {};
        const float threshold = cost_quantile(share);
        std::vector<std::uint32_t> rivals = filter(
            live_, [&](std::uint32_t v) { return candidates_[v].cost <= threshold && candidates_[v].cost < unusable; });
        RoundResult result{rivals.size(), 0};
        for (std::uint64_t contest = 0; contest < contests && mesh_.face_count > target_; ++contest) {
            result.collapses += collapse_winners(rivals, contest);
            if (stopped_()) break;
            // Only those remain that touch no vertex of a collapsed star.
            rivals = filter(rivals, [&](std::uint32_t v) {
                return dirty_[v] != round_ && dirty_[candidates_[v].partner] != round_;
            });
        }
        dead_ += result.collapses;
        if (8 * dead_ > live_.size()) {
            live_ = filter(live_, [&](std::uint32_t v) { return !mesh_.dead_vertex(v); });
            dead_ = 0;
        }
        return result;
    }

    // ---- costs

    void update_candidate(std::uint32_t v) {
        if (mesh_.dead_vertex(v)) {
            candidates_[v] = {};
            return;
        }
        if (!evaluate_all_ && dirty_[v] + 1 != round_) return;
        const bool hub = mesh_.valence[v] > max_valence;
        Candidate best = candidates_[v];
        const bool afresh = evaluate_all_ || has_ban_[v] != 0 || is_new(v) || best.partner == none ||
                            mesh_.dead_vertex(best.partner) || is_new(best.partner);
        const bool has_ban = has_ban_[v] != 0;
        if (afresh) {
            best = {};
            has_ban_[v] = 0;
        }
        const bool regular = (mesh_.vertices[v].flags & vertex_irregular) == 0;
        visit_and_clean_corners(mesh_, v, [&](std::uint32_t c) {
            if (hub) return;
            const std::uint32_t f = corner_face(c), k = c - 3 * f;
            const Face& face = mesh_.faces[f];
            consider(v, face[k == 2 ? 0 : k + 1], has_ban && (bans_[c] & ban_next) != 0, afresh, best);
            if (!regular) {
                consider(v, face[k == 0 ? 2 : k - 1], has_ban && (bans_[c] & ban_previous) != 0, afresh, best);
            }
        });
        candidates_[v] = best;
    }

    bool is_new(std::uint32_t v) const { return changed_[v] + 1 == round_; }

    void consider(std::uint32_t v, std::uint32_t w, bool banned, bool afresh, Candidate& best) {
        if (w <= v || !(afresh || is_new(w))) return;
        if (banned) {
            has_ban_[v] = 1;
            return;
        }
        if (mesh_.valence[w] > max_valence || (mesh_.vertices[v].flags & mesh_.vertices[w].flags & vertex_locked) != 0)
            return;
        const auto cost = static_cast<float>(place_collapsed(mesh_, v, w).cost);
        if (cost < best.cost || (cost == best.cost && w < best.partner)) best = {w, cost};
    }

    /// From a sample of every so-manieth vertex.
    float cost_quantile(double share) {
        sample_.clear();
        const std::size_t step = std::max<std::size_t>(1, live_.size() / quantile_samples);
        for (std::size_t i = 0; i < live_.size(); i += step) {
            const float cost = candidates_[live_[i]].cost;
            if (cost < unusable) sample_.push_back(cost);
        }
        if (sample_.empty()) return unusable;
        // Towards the end as few as four rivals for every collapse that is still wanted.
        const double wanted = 2.0 * static_cast<double>(mesh_.face_count - target_) / static_cast<double>(live_.size());
        const double part = std::min(share, std::max(wanted, 16.0 / static_cast<double>(live_.size())));
        const auto rank = static_cast<std::size_t>(part * static_cast<double>(sample_.size()));
        const auto nth = sample_.begin() + static_cast<std::ptrdiff_t>(std::min(rank, sample_.size() - 1));
        std::nth_element(sample_.begin(), nth, sample_.end());
        return *nth;
    }

    // ---- contests

    template <class Visit>
    void for_star_faces(std::uint32_t v, const Visit& visit) const {
        for (const std::uint32_t end : {v, candidates_[v].partner}) {
            for (std::uint32_t c = mesh_.first_corner[end]; c != none; c = mesh_.next_corner[c]) visit(corner_face(c));
        }
    }

    /// Lower wins. Later contests have lower keys, so that claims need no reset; among rivals of one contest the power
    /// of two of the cost decides, then chance: the exact order would leave few local minima in a smooth field of
    /// costs.
    std::uint64_t key(std::uint32_t v, std::uint64_t contest) const {
        const std::uint64_t turn = 0xffffffU - (std::uint64_t{round_} * contests + contest);
        const std::uint64_t magnitude = std::bit_cast<std::uint32_t>(candidates_[v].cost) >> 23;
        return turn << 40 | magnitude << 32 | scramble(v ^ (round_ << 8));
    }

    /// Rivals that are the best at both of their vertices, then of those the best at all faces of their stars.
    std::vector<std::uint32_t> find_winners(const std::vector<std::uint32_t>& rivals, std::uint64_t contest) {
        const auto for_all = [&](const std::vector<std::uint32_t>& list, const auto& body) {
            runtime::parallel_for(list.size(), collapse_grain, [&](std::size_t i) { body(list[i]); });
        };
        for_all(rivals, [&](std::uint32_t v) {
            lower(vertex_claims_[v], key(v, contest));
            lower(vertex_claims_[candidates_[v].partner], key(v, contest));
        });
        const std::vector<std::uint32_t> finalists = filter(rivals, [&](std::uint32_t v) {
            const std::uint64_t own = key(v, contest);
            return vertex_claims_[v] == own && vertex_claims_[candidates_[v].partner] == own;
        });
        for_all(finalists, [&](std::uint32_t v) {
            const std::uint64_t own = key(v, contest);
            for_star_faces(v, [&](std::uint32_t f) { lower(face_claims_[f], own); });
        });
        return filter(finalists, [&](std::uint32_t v) {
            const std::uint64_t own = key(v, contest);
            bool wins = true;
            for_star_faces(v, [&](std::uint32_t f) { wins = wins && face_claims_[f] == own; });
            return wins;
        });
    }

    std::size_t collapse_winners(const std::vector<std::uint32_t>& rivals, std::uint64_t contest) {
        std::vector<std::uint32_t> winners = find_winners(rivals, contest);
        // Not beyond the target: the cheapest only.
        const std::size_t wanted = (mesh_.face_count - target_ + 1) / 2;
        if (winners.size() > wanted) {
            std::sort(winners.begin(), winners.end(), [&](std::uint32_t v, std::uint32_t w) {
                return candidates_[v].cost != candidates_[w].cost ? candidates_[v].cost < candidates_[w].cost : v < w;
            });
            winners.resize(wanted);
        }
        struct Sum {
            std::size_t faces = 0, collapses = 0;
            double error = 0;
        };
        const Sum sum = runtime::reduce_blocks(
            winners.size(), collapse_grain, Sum{},
            [&](std::size_t begin, std::size_t end) {
                Sum part;
                for (std::size_t i = begin; i < end && !stopped_(); ++i) {
                    double error = 0;
                    const std::size_t faces = collapse(winners[i], error);
                    part.faces += faces;
                    part.collapses += faces > 0;
                    part.error = std::max(part.error, error);
                }
                return part;
            },
            [](Sum a, const Sum& b) {
                return Sum{a.faces + b.faces, a.collapses + b.collapses, std::max(a.error, b.error)};
            });
        mesh_.face_count -= sum.faces;
        max_error_ = std::max(max_error_, sum.error);
        return sum.collapses;
    }

    /// Returns the number of faces removed. Writes to the two stars only, and marks around them.
    std::size_t collapse(std::uint32_t v, double& error) {
        const std::uint32_t w = candidates_[v].partner;
        const Placement placement = place_collapsed(mesh_, v, w);
        const std::size_t removed = try_collapse(mesh_, v, w, placement, keep_shape_);
        if (removed == 0) {
            ban(v, w);
            return 0;
        }
        error = placement.area > 0 ? std::sqrt(placement.quadric_error / placement.area) : 0;
        changed_[v] = round_;
        mark(v);
        for (std::uint32_t c = mesh_.first_corner[v]; c != none; c = mesh_.next_corner[c]) {
            const std::uint32_t f = corner_face(c);
            for (std::uint32_t k = 0; k < 3; ++k) {
                bans_[3 * f + k] = 0;
                mark(mesh_.faces[f][k]);
            }
        }
        return removed;
    }

    void mark(std::uint32_t v) { std::atomic_ref<std::uint32_t>(dirty_[v]).store(round_, std::memory_order_relaxed); }

    void ban(std::uint32_t v, std::uint32_t w) {
        for (std::uint32_t c = mesh_.first_corner[v]; c != none; c = mesh_.next_corner[c]) {
            const std::uint32_t f = corner_face(c), k = c - 3 * f;
            if (mesh_.faces[f][(k + 1) % 3] == w) bans_[c] |= ban_next;
            if (mesh_.faces[f][(k + 2) % 3] == w) bans_[c] |= ban_previous;
        }
        has_ban_[v] = 1;
        mark(v);
    }

    CollapseMesh& mesh_;
    std::size_t target_;
    const std::function<bool()>& stopped_;
    std::vector<std::uint32_t> live_;
    std::size_t dead_ = 0;  ///< entries of live_ that are not
    std::vector<Candidate> candidates_;
    std::vector<std::uint32_t> changed_, dirty_;  ///< round in which a vertex, or one next to it, was collapsed into
    std::vector<std::uint8_t> has_ban_, bans_;
    std::vector<std::uint64_t> vertex_claims_, face_claims_;  ///< the lowest key of a rival that wants it
    std::vector<float> sample_;
    std::uint32_t round_ = 0;
    bool evaluate_all_ = true, keep_shape_ = true;
    double max_error_ = 0;
};

Decimated identity(std::span<const Vec3> positions, std::span<const Face> faces) {
    Decimated result;
    result.positions.assign(positions.begin(), positions.end());
    result.faces.assign(faces.begin(), faces.end());
    result.face_map.resize(faces.size());
    for (std::size_t i = 0; i < faces.size(); ++i) result.face_map[i] = static_cast<std::uint32_t>(i);
    return result;
}

/// The live part of the mesh in its old order, and the number of every live face in it.
std::vector<std::uint32_t> extract(const CollapseMesh& mesh, std::span<const Vec3> input, const Frame& frame,
                                   Decimated& result) {
    std::vector<std::uint32_t> face_number(mesh.faces.size(), none), vertex_number(mesh.vertices.size(), none);
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        if (mesh.dead_vertex(static_cast<std::uint32_t>(v)) || mesh.valence[v] == 0) continue;
        vertex_number[v] = static_cast<std::uint32_t>(result.positions.size());
        const std::uint32_t source = mesh.source[v];
        result.positions.push_back(source != none ? input[source] : frame.to_input(mesh.vertices[v].position));
    }
    for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
        if (!mesh.alive(static_cast<std::uint32_t>(i))) continue;
        face_number[i] = static_cast<std::uint32_t>(result.faces.size());
        const Face& f = mesh.faces[i];
        result.faces.push_back({vertex_number[f[0]], vertex_number[f[1]], vertex_number[f[2]]});
    }
    return face_number;
}

/// A face with a repeated vertex lives nowhere: it takes the place of a face at one of its vertices.
void adopt_degenerate_faces(std::span<const Face> faces, std::size_t vertices, std::vector<std::uint32_t>& face_map) {
    std::vector<std::uint32_t> at_vertex;
    for (std::size_t i = 0; i < faces.size(); ++i) {
        if (face_map[i] != none) continue;
        if (at_vertex.empty()) {
            at_vertex.assign(vertices, none);
            for (std::size_t j = faces.size(); j-- > 0;) {
                if (face_map[j] == none) continue;
                for (const std::uint32_t v : faces[j]) at_vertex[v] = face_map[j];
            }
        }
        for (const std::uint32_t v : faces[i]) {
            if (face_map[i] == none) face_map[i] = at_vertex[v];
        }
        if (face_map[i] == none && i > 0) face_map[i] = face_map[i - 1];
    }
    for (std::size_t i = faces.size(); i-- > 1;) {
        if (face_map[i - 1] == none) face_map[i - 1] = face_map[i];
    }
}

}  // namespace

Decimated decimate(std::span<const Vec3> positions, std::span<const Face> faces, const DecimateOptions& options) {
    const std::function<bool()> stopped = [&] { return options.should_stop && options.should_stop(); };
    if (faces.size() <= options.target_faces) return identity(positions, faces);
    CollapseMesh mesh;
    if (!build_collapse_mesh(positions, faces, options.feature_degrees, stopped, mesh)) {
        return identity(positions, faces);
    }
    Decimator decimator(mesh, options.target_faces, stopped);
    decimator.run();

    Decimated result;
    result.max_error = decimator.max_error() / mesh.frame.scale;
    const std::vector<std::uint32_t> face_number = extract(mesh, positions, mesh.frame, result);
    result.face_map = last_heirs(mesh);
    for (std::uint32_t& f : result.face_map) f = f == none ? none : face_number[f];
    if (result.faces.empty()) return identity(positions, faces);
    refine_face_map(positions, faces, result.positions, result.faces, stopped, result.face_map);
    adopt_degenerate_faces(faces, positions.size(), result.face_map);
    return result;
}

}  // namespace quadseg::simplify
