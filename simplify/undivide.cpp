#include "simplify/undivide.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

namespace quadseg::simplify {

namespace {

using Face = std::array<std::uint32_t, 3>;
constexpr std::uint32_t none = 0xffffffffU;
/// What one round leaves over, the next may take: an edge that stood in the way may be gone.
constexpr int most_rounds = 8;
constexpr std::size_t poll_interval = 1024;
/// Stars of more faces stay: cutting them anew takes the cube of it.
constexpr std::size_t most_faces = 64;
/// Nor do stars with a neighbour of more faces: each change looks through all of these.
constexpr std::size_t most_faces_of_neighbour = 2048;
/// Twice the area over the square of the longest edge: less is no triangle.
constexpr double least_shape = 1e-7;

struct Point2 {
    double x, y;
};
double turn(const Point2& a, const Point2& b, const Point2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}
double squared_length(const Point2& a, const Point2& b) {
    return (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y);
}

class Undivider {
  public:
    Undivider(std::span<const Vec3> positions, std::span<const Face> faces, std::span<const std::int32_t> facet,
              const UndivideOptions& options)
        : positions_(positions), faces_(faces.begin(), faces.end()), facet_(facet), options_(options) {
        star_.resize(positions.size());
        for (std::uint32_t f = 0; f < faces_.size(); ++f) {
            const Face& face = faces_[f];
            if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0]) continue;
            for (const std::uint32_t v : face) star_[v].push_back(f);
        }
    }

    void run() {
        for (int round = 0; round < most_rounds; ++round) {
            std::size_t removed = 0;
            for (std::uint32_t v = 0; v < star_.size(); ++v) {
                if (v % poll_interval == 0) options_.check();
                if (remove(v)) ++removed;
            }
            if (removed == 0) return;
        }
    }

    const std::vector<Face>& faces() const noexcept { return faces_; }
    bool alive(std::uint32_t f) const noexcept { return faces_[f][0] != none; }

  private:
    /// The faces of a star one after another around it: face i has the vertices ring[i] and ring[i + 1].
    bool gather_ring(std::uint32_t v) {
        const std::vector<std::uint32_t>& star = star_[v];
        if (star.empty() || star.size() > most_faces) return false;
        const auto corner = [&](std::uint32_t f) {
            return static_cast<std::size_t>(std::find(faces_[f].begin(), faces_[f].end(), v) - faces_[f].begin());
        };
        const auto next = [&](std::uint32_t f) { return faces_[f][(corner(f) + 1) % 3]; };
        const auto previous = [&](std::uint32_t f) { return faces_[f][(corner(f) + 2) % 3]; };
        const auto count_if = [&](const auto& end, std::uint32_t w) {
            return std::count_if(star.begin(), star.end(), [&](std::uint32_t f) { return end(f) == w; });
        };
        std::uint32_t at = star[0];
        closed_ = true;
        for (const std::uint32_t f : star) {
            if (count_if(next, next(f)) != 1 || count_if(previous, previous(f)) != 1) return false;
            if (count_if(previous, next(f)) != 0) continue;
            if (!closed_) return false;  // two fans
            closed_ = false;
            at = f;
        }
        // Begins where a facet does.
        for (const std::uint32_t f : star) {
            if (!closed_) break;
            const auto before =
                std::find_if(star.begin(), star.end(), [&](std::uint32_t g) { return previous(g) == next(f); });
            if (facet_[*before] != facet_[f]) {
                at = f;
                break;
            }
        }
        around_.clear();
        ring_.assign(1, next(at));
        while (around_.size() < star.size()) {
            around_.push_back(at);
            ring_.push_back(previous(at));
            const auto after =
                std::find_if(star.begin(), star.end(), [&](std::uint32_t g) { return next(g) == ring_.back(); });
            if (after == star.end() || *after == around_.front()) break;
            at = *after;
        }
        return around_.size() == star.size();
    }

    bool remove(std::uint32_t v) {
        if (!gather_ring(v)) return false;
        for (const std::uint32_t w : ring_) {
            if (star_[w].size() > most_faces_of_neighbour) return false;
        }
        const std::size_t n = around_.size();
        // Where the second facet begins.
        std::size_t second = 0;
        for (std::size_t i = 1; i < n; ++i) {
            if (facet_[around_[i]] == facet_[around_[i - 1]]) continue;
            if (second != 0) return false;
            second = i;
        }
        if (!closed_ && (second != 0 || !is_straight(v, ring_.front(), ring_.back()))) return false;
        added_.clear();
        if (closed_ && second == 0) {
            if (!cut(0, n)) return false;
        } else if (closed_) {
            if (has_edge(ring_[0], ring_[second], v) || !cut(0, second + 1) || !cut(second, n + 1)) return false;
        } else if (has_edge(ring_.front(), ring_.back(), v) || !cut(0, n + 1)) {
            return false;
        }
        replace(v);
        return true;
    }

    bool is_straight(std::uint32_t v, std::uint32_t a, std::uint32_t b) const {
        const Vec3 along = positions_[b] - positions_[a], to = positions_[v] - positions_[a];
        const double squared = squared_norm(along), at = dot(along, to);
        return at > 0 && at < squared && norm(cross(along, to)) <= options_.straight * std::sqrt(squared);
    }

    /// Is there such an edge away from the star of v?
    bool has_edge(std::uint32_t a, std::uint32_t b, std::uint32_t v) const {
        return std::any_of(star_[a].begin(), star_[a].end(), [&](std::uint32_t f) {
            const Face& face = faces_[f];
            return std::find(face.begin(), face.end(), b) != face.end() &&
                   std::find(face.begin(), face.end(), v) == face.end();
        });
    }

    /// Triangles of the polygon ring[begin] … ring[end − 1], the best ear first; false: there are none.
    bool cut(std::size_t begin, std::size_t end) {
        if (end - begin < 3) return false;
        project(begin, end);
        std::vector<std::size_t>& left = polygon_;
        left.clear();
        for (std::size_t i = begin; i < end; ++i) left.push_back(i);
        while (left.size() > 3) {
            std::size_t best = left.size();
            double best_shape = least_shape;
            for (std::size_t j = 0; j < left.size(); ++j) {
                const double shape = ear_shape(j, begin);
                if (shape > best_shape) {
                    best_shape = shape;
                    best = j;
                }
            }
            if (best == left.size()) return false;
            const std::size_t before = left[(best + left.size() - 1) % left.size()],
                              after = left[(best + 1) % left.size()];
            added_.push_back({Face{ring_[before], ring_[left[best]], ring_[after]}, around_[begin]});
            left.erase(left.begin() + static_cast<std::ptrdiff_t>(best));
        }
        if (!(shape(left[0] - begin, left[1] - begin, left[2] - begin) > least_shape)) return false;
        added_.push_back({Face{ring_[left[0]], ring_[left[1]], ring_[left[2]]}, around_[begin]});
        return true;
    }

    void project(std::size_t begin, std::size_t end) {
        Vec3 normal{};
        for (std::size_t i = begin; i < end && i < around_.size(); ++i) {
            const Face& f = faces_[around_[i]];
            if (facet_[around_[i]] == facet_[around_[begin]])
                normal += cross(positions_[f[1]] - positions_[f[0]], positions_[f[2]] - positions_[f[0]]);
        }
        normal = normalized(normal);
        const Vec3 helper = std::abs(normal.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
        const Vec3 u = normalized(cross(helper, normal)), w = cross(normal, u);
        point_.clear();
        for (std::size_t i = begin; i < end; ++i) {
            const Vec3 d = positions_[ring_[i]] - positions_[ring_[begin]];
            point_.push_back({dot(u, d), dot(w, d)});
        }
    }

    /// 0 or less: not counter-clockwise.
    double shape(std::size_t a, std::size_t b, std::size_t c) const {
        const Point2 &p = point_[a], &q = point_[b], &r = point_[c];
        const double longest = std::max({squared_length(p, q), squared_length(q, r), squared_length(r, p)});
        return longest > 0 ? turn(p, q, r) / longest : 0;
    }
    double ear_shape(std::size_t j, std::size_t begin) const {
        const std::vector<std::size_t>& left = polygon_;
        const std::size_t a = left[(j + left.size() - 1) % left.size()], b = left[j], c = left[(j + 1) % left.size()];
        const double own = shape(a - begin, b - begin, c - begin);
        if (!(own > least_shape) || has_edge(ring_[a], ring_[c], none)) return 0;
        const Point2 &p = point_[a - begin], &q = point_[b - begin], &r = point_[c - begin];
        for (const std::size_t i : left) {
            if (i == a || i == b || i == c) continue;
            const Point2& x = point_[i - begin];
            if (turn(p, q, x) >= 0 && turn(q, r, x) >= 0 && turn(r, p, x) >= 0) return 0;
        }
        return own;
    }

    void replace(std::uint32_t v) {
        for (const std::uint32_t f : around_) {
            for (const std::uint32_t w : faces_[f]) {
                if (w != v) std::erase(star_[w], f);
            }
        }
        // The first face of a facet stays the one that its triangles are put in place of: there is always one.
        for (std::size_t i = 0; i < around_.size(); ++i) {
            const auto fits = std::find_if(added_.begin(), added_.end(),
                                           [&](const Added& a) { return facet_[a.like] == facet_[around_[i]]; });
            if (fits == added_.end()) {
                faces_[around_[i]] = {none, none, none};
                continue;
            }
            faces_[around_[i]] = fits->face;
            for (const std::uint32_t w : fits->face) star_[w].push_back(around_[i]);
            added_.erase(fits);
        }
        star_[v].clear();
    }

    struct Added {
        Face face;
        std::uint32_t like;  ///< a face of its facet
    };

    std::span<const Vec3> positions_;
    std::vector<Face> faces_;
    std::span<const std::int32_t> facet_;
    const UndivideOptions& options_;
    std::vector<std::vector<std::uint32_t>> star_;  ///< faces of a vertex

    // Of the vertex at hand.
    std::vector<std::uint32_t> ring_, around_;
    bool closed_ = true;
    std::vector<Added> added_;
    std::vector<std::size_t> polygon_;
    std::vector<Point2> point_;
};

}  // namespace

Undivided undivide(std::span<const Vec3> positions, std::span<const Face> faces,
                   std::span<const std::int32_t> facet_of_face, const UndivideOptions& options) {
    Undivider undivider(positions, faces, facet_of_face, options);
    undivider.run();
    Undivided result;
    std::vector<std::uint32_t> number(positions.size(), none);
    for (std::uint32_t f = 0; f < faces.size(); ++f) {
        if (!undivider.alive(f)) continue;
        Face face = undivider.faces()[f];
        for (std::uint32_t& v : face) {
            if (number[v] == none) {
                number[v] = static_cast<std::uint32_t>(result.positions.size());
                result.positions.push_back(positions[v]);
                result.source_vertex.push_back(v);
            }
            v = number[v];
        }
        result.faces.push_back(face);
        result.source_face.push_back(f);
    }
    return result;
}

}  // namespace quadseg::simplify
