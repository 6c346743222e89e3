#include "flow/rulings.h"

#include "math/symmetric3.h"
#include "mesh/connected.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

namespace quadseg::flow {

namespace {

constexpr double degree = std::numbers::pi / 180;
/// Edges deviate from the direction of a ruling by no more than this share of the diagonal: the rounding of a file.
constexpr double parallel_tolerance = 1e-6;
/// Where more edges than these come only so near to it (of the diagonal, and of the edge's length), and they are a good
/// share of all, rows of edges are off as the vertices are, and what misses the direction is no sign of a face's
/// inside.
constexpr double rough_tolerance = 1e-4, rough_share = 2e-3, least_rows = 0.05;
/// A part turns about its direction at least so much (RMS).
constexpr double least_turn = 1 * degree, least_turn_to_tilt = 4;
/// Its facets tilt from it where rims are divided differently, and less than they fold: RMS by RMS. If they do not,
/// every row of edges is a ruling.
constexpr double most_tilt_to_fold = 0.4, least_tilt_to_fold = 0.1;
/// Candidates for the direction are sought so near to what the facets tell.
constexpr double rough_angle = 5 * degree;
constexpr std::size_t most_directions = 16, fewest_faces = 4;
/// Rim against rim, as a share of the length of a rim's edge: the arrow of an arc of 24°.
constexpr double largest_arrow = 0.06;
constexpr std::size_t most_comparisons = 4000000;
/// A kink turns by so many times as much as the rows on both sides of it.
constexpr double kink_ratio = 1.3;
constexpr double flat_angle = 1e-4;

struct Edge {
    std::uint32_t from, to;  ///< vertices, ascending
    std::uint32_t face, slot;
    std::int32_t other;  ///< the face beyond; −1: none
};

/// One smooth part of the free faces.
class Part {
  public:
    Part(const mesh::WorkMesh& mesh, std::vector<std::uint32_t> faces)
        : mesh_(mesh), faces_(std::move(faces)), tolerance_(parallel_tolerance * mesh.frame.diagonal) {}

    /// Marks borders and faces. Parts that are no general cylinders stay as they are.
    void mark(const std::vector<std::int32_t>& part, const mesh::FeatureEdges& creases, Rulings& result) {
        if (faces_.size() < fewest_faces || !may_have_direction()) return;
        collect_edges(part, creases);
        if (tilt_ > most_tilt_to_fold * mean_fold() + flat_angle) return;
        find_direction();
        if (rows_are_rough() || !is_general_cylinder()) return;
        find_rungs();
        find_columns();
        std::vector<std::uint8_t> border(rungs_, 1);
        bool all_known = true;
        if (mostly_flat_columns() || tilt_ < least_tilt_to_fold * mean_fold()) {
            // Flat columns with vertices inside are facets of a coarser tessellation (flow/faceted.h).
            if (rung_of_.size() > rungs_) return;
            border = kinks();
            all_known = false;
        }
        for (const auto& [edge, rung] : rung_of_) {
            if (border[rung] != 0) set_border(inner_[edge], result.borders);
        }
        for (const std::uint32_t f : faces_) result.ruled[f] = all_known ? 1 : 0;
    }

  private:
    void collect_edges(const std::vector<std::int32_t>& part, const mesh::FeatureEdges& creases) {
        for (const std::uint32_t f : faces_) {
            for (std::uint32_t k = 0; k < 3; ++k) {
                const std::int32_t g = mesh_.neighbors[f][k];
                const std::uint32_t a = mesh_.faces[f][k], b = mesh_.faces[f][(k + 1) % 3];
                const bool inside =
                    g >= 0 && part[static_cast<std::size_t>(g)] == part[f] && (creases[f] >> k & 1) == 0;
                const Edge edge{std::min(a, b), std::max(a, b), f, k, g};
                if (!inside) {
                    rims_.push_back(edge);
                } else if (g > static_cast<std::int32_t>(f)) {
                    inner_.push_back(edge);
                }
            }
        }
        for (const Edge& e : rims_) rim_vertices_.insert(rim_vertices_.end(), {e.from, e.to});
        std::sort(rim_vertices_.begin(), rim_vertices_.end());
    }

    Vec3 along(const Edge& e) const { return mesh_.positions[e.to] - mesh_.positions[e.from]; }
    bool on_rim(std::uint32_t v) const { return std::binary_search(rim_vertices_.begin(), rim_vertices_.end(), v); }

    bool is_parallel(const Edge& e, const Vec3& direction) const {
        const Vec3 d = along(e);
        const double length = dot(d, direction);
        return std::abs(length) > 10 * tolerance_ && norm(d - direction * length) <= tolerance_;
    }

    std::size_t parallel_edges(const Vec3& direction) const {
        const auto parallel = [&](const Edge& e) { return is_parallel(e, direction); };
        return static_cast<std::size_t>(std::count_if(inner_.begin(), inner_.end(), parallel) +
                                        std::count_if(rims_.begin(), rims_.end(), parallel));
    }

    /// Vertices were moved since the part was divided: rows of edges miss the direction by more than a file rounds.
    bool rows_are_rough() const {
        std::size_t exact = 0, rough = 0;
        for (const Edge& e : inner_) {
            const Vec3 d = along(e);
            const double length = dot(d, direction_), off = norm(d - direction_ * length);
            if (off > rough_share * std::abs(length) || off > rough_tolerance * mesh_.frame.diagonal) continue;
            if (std::abs(length) <= 10 * rough_tolerance * mesh_.frame.diagonal) continue;
            ++(off <= tolerance_ ? exact : rough);
        }
        return rough > exact && static_cast<double>(rough) > least_rows * static_cast<double>(inner_.size());
    }

    double mean_fold() const {
        double sum = 0;
        for (const Edge& e : inner_) {
            const Vec3 apart = mesh_.normals[e.face] - mesh_.normals[static_cast<std::size_t>(e.other)];
            sum += squared_norm(apart);
        }
        return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, inner_.size())));
    }

    /// What the facets tell: roughly perpendicular to one direction, and not all alike.
    bool may_have_direction() {
        Symmetric3 spread;
        double area = 0;
        for (const std::uint32_t f : faces_) {
            spread.add_outer(mesh_.normals[f], mesh_.areas[f]);
            area += mesh_.areas[f];
        }
        if (!(area > 0)) return false;
        const EigenSystem eigen = eigen_decomposition(spread);
        rough_ = eigen.vectors[0];
        tilt_ = std::sqrt(std::max(0.0, eigen.values[0]) / area);
        const double turn = std::sqrt(std::max(0.0, eigen.values[1]) / area);
        return turn >= least_turn && turn >= least_turn_to_tilt * tilt_;
    }

    /// Exactly it is that of the edges at the ends, or of the planes in which the rims lie.
    void find_direction() {
        std::vector<Vec3> directions{rough_};
        const auto consider = [&](const Vec3& d) {
            const double cosine = dot(d, rough_);
            if (std::abs(cosine) < std::cos(rough_angle) || directions.size() >= most_directions) return;
            const Vec3 same_way = cosine < 0 ? -d : d;
            for (const Vec3& known : directions) {
                if (norm(known - same_way) < 1e-9) return;
            }
            directions.push_back(same_way);
        };
        for (const Edge& e : rims_) {
            consider(normalized(along(e)));
            if (e.other >= 0) consider(mesh_.normals[static_cast<std::size_t>(e.other)]);
        }
        // Where no edge tells, better an exact plane's normal than the rough one.
        direction_ = directions[std::min<std::size_t>(1, directions.size() - 1)];
        std::size_t most = parallel_edges(direction_);
        for (const Vec3& d : directions) {
            const std::size_t count = parallel_edges(d);
            if (count <= most) continue;
            most = count;
            direction_ = d;
        }
    }

    /// Seen along the direction, all vertices lie on the line of the rims.
    bool is_general_cylinder() const {
        std::vector<std::uint32_t> vertices;
        for (const std::uint32_t f : faces_) {
            vertices.insert(vertices.end(), mesh_.faces[f].begin(), mesh_.faces[f].end());
        }
        std::sort(vertices.begin(), vertices.end());
        vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
        if (vertices.size() * rims_.size() > most_comparisons) return false;
        const auto seen = [&](std::uint32_t v) {
            const Vec3& p = mesh_.positions[v];
            return p - direction_ * dot(direction_, p);
        };
        std::size_t apart = 0;
        for (const std::uint32_t v : vertices) {
            const Vec3 p = seen(v);
            bool found = false;
            for (const Edge& e : rims_) {
                if (e.from == v || e.to == v) continue;
                const Vec3 a = seen(e.from), ab = seen(e.to) - a;
                const double square = squared_norm(ab);
                if (!(square > tolerance_ * tolerance_)) continue;
                const double t = std::clamp(dot(p - a, ab) / square, 0.0, 1.0);
                const Vec3 off = p - a - ab * t;
                const double allowed = largest_arrow * std::sqrt(square) + tolerance_;
                if (squared_norm(off) <= allowed * allowed) {
                    found = true;
                    break;
                }
            }
            apart += found ? 0 : 1;
        }
        return 20 * apart <= vertices.size();
    }

    /// Rows of parallel edges from rim to rim.
    void find_rungs() {
        std::map<std::uint32_t, std::vector<std::size_t>> at;  // parallel edges at a vertex
        for (std::size_t i = 0; i < inner_.size(); ++i) {
            if (!is_parallel(inner_[i], direction_)) continue;
            at[inner_[i].from].push_back(i);
            at[inner_[i].to].push_back(i);
        }
        for (const auto& [start, edges] : at) {
            if (!on_rim(start)) continue;
            for (const std::size_t first : edges) {
                if (rung_of_.count(first) != 0) continue;
                std::vector<std::size_t> row{first};
                std::uint32_t v = inner_[first].from == start ? inner_[first].to : inner_[first].from;
                while (!on_rim(v)) {
                    const std::vector<std::size_t>& here = at[v];
                    if (here.size() != 2 || row.size() > inner_.size()) break;
                    row.push_back(here[0] == row.back() ? here[1] : here[0]);
                    v = inner_[row.back()].from == v ? inner_[row.back()].to : inner_[row.back()].from;
                }
                if (!on_rim(v)) continue;
                for (const std::size_t edge : row) rung_of_[edge] = rungs_;
                ++rungs_;
            }
        }
    }

    /// Faces between rungs, and which of them every rung divides.
    void find_columns() {
        std::map<std::uint32_t, std::vector<std::uint32_t>> across;
        for (std::size_t i = 0; i < inner_.size(); ++i) {
            if (rung_of_.count(i) != 0) continue;
            const auto other = static_cast<std::uint32_t>(inner_[i].other);
            across[inner_[i].face].push_back(other);
            across[other].push_back(inner_[i].face);
        }
        for (const std::uint32_t seed : faces_) {
            if (column_of_.count(seed) != 0) continue;
            const std::size_t column = columns_.size();
            columns_.push_back({seed});
            column_of_[seed] = column;
            for (std::size_t i = 0; i < columns_[column].size(); ++i) {
                for (const std::uint32_t g : across[columns_[column][i]]) {
                    if (column_of_.try_emplace(g, column).second) columns_[column].push_back(g);
                }
            }
        }
        sides_.resize(rungs_);
        beside_.resize(columns_.size());
        for (const auto& [edge, rung] : rung_of_) {
            sides_[rung] = {column_of_[inner_[edge].face], column_of_[static_cast<std::uint32_t>(inner_[edge].other)]};
        }
        for (std::size_t r = 0; r < rungs_; ++r) {
            for (const std::size_t column : sides_[r]) beside_[column].push_back(r);
        }
    }

    bool is_flat(const std::vector<std::uint32_t>& column) const {
        const Vec3& n = mesh_.normals[column.front()];
        return std::all_of(column.begin(), column.end(),
                           [&](std::uint32_t f) { return norm(mesh_.normals[f] - n) <= flat_angle; });
    }

    bool mostly_flat_columns() const {
        const auto flat = std::count_if(columns_.begin(), columns_.end(),
                                        [&](const std::vector<std::uint32_t>& column) { return is_flat(column); });
        return 2 * static_cast<std::size_t>(flat) > columns_.size();
    }

    double turn_at(std::size_t rung) const {
        return angle_between(mesh_.normals[columns_[sides_[rung][0]].front()],
                             mesh_.normals[columns_[sides_[rung][1]].front()]);
    }

    /// Where the profile turns more than on both sides.
    std::vector<std::uint8_t> kinks() const {
        std::vector<std::uint8_t> kink(rungs_, 0);
        for (std::size_t r = 0; r < rungs_; ++r) {
            double beside = 0;
            bool known = true;
            for (const std::size_t column : sides_[r]) {
                known = known && beside_[column].size() > 1 && is_flat(columns_[column]);
                for (const std::size_t other : beside_[column]) {
                    if (other != r) beside = std::max(beside, turn_at(other));
                }
            }
            kink[r] = known && turn_at(r) > kink_ratio * beside ? 1 : 0;
        }
        return kink;
    }

    void set_border(const Edge& e, mesh::FeatureEdges& borders) const {
        borders[e.face] = static_cast<std::uint8_t>(borders[e.face] | 1U << e.slot);
        const auto other = static_cast<std::size_t>(e.other);
        for (std::size_t k = 0; k < 3; ++k) {
            if (mesh_.neighbors[other][k] == static_cast<std::int32_t>(e.face))
                borders[other] = static_cast<std::uint8_t>(borders[other] | 1U << k);
        }
    }

    const mesh::WorkMesh& mesh_;
    std::vector<std::uint32_t> faces_;
    double tolerance_;
    std::vector<Edge> inner_, rims_;
    std::vector<std::uint32_t> rim_vertices_;
    Vec3 rough_, direction_;
    double tilt_ = 0;                             ///< of the facets from the rough direction, RMS
    std::map<std::size_t, std::size_t> rung_of_;  ///< by inner edge
    std::size_t rungs_ = 0;
    std::map<std::uint32_t, std::size_t> column_of_;  ///< by face
    std::vector<std::vector<std::uint32_t>> columns_;
    std::vector<std::array<std::size_t, 2>> sides_;  ///< columns of a rung
    std::vector<std::vector<std::size_t>> beside_;   ///< rungs of a column
};

}  // namespace

Rulings find_rulings(const mesh::WorkMesh& mesh, const mesh::FeatureEdges& creases, std::span<const std::uint8_t> free,
                     const runtime::RunControl& control) {
    std::vector<std::int32_t> part;
    const std::size_t parts = mesh::connected_faces(
        mesh, [&](std::size_t f) { return free[f] != 0; },
        [&](std::size_t f, std::size_t k, std::size_t) { return (creases[f] >> k & 1) == 0; }, [&] { control.check(); },
        part);
    std::vector<std::vector<std::uint32_t>> faces(parts);
    for (std::size_t f = 0; f < part.size(); ++f) {
        if (part[f] >= 0) faces[static_cast<std::size_t>(part[f])].push_back(static_cast<std::uint32_t>(f));
    }
    Rulings result;
    result.borders = creases;
    result.ruled.assign(mesh.face_count(), 0);
    for (std::vector<std::uint32_t>& list : faces) {
        control.check();
        Part(mesh, std::move(list)).mark(part, creases, result);
    }
    return result;
}

}  // namespace quadseg::flow
