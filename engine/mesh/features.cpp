// Creases against facets. A tessellated cylinder, cone or fillet turns by equal steps over strips of similar width
// between nearly parallel rulings; a crease stands alone. So from a sharp edge we walk over the flat facet on either
// side to the next fold, twice: where three folds in a row are alike, the edge belongs to a smooth surface.
#include "mesh/features.h"

#include "runtime/parallel.h"

#include <algorithm>
#include <cmath>

namespace quadseg::mesh {

namespace {

constexpr std::size_t block = 8192;
constexpr double degree = M_PI / 180;
/// Above this turning angle an edge is a crease whatever is beside it: seven facets make no cylinder, a hexagon is a
/// nut.
constexpr double largest_facet_angle = 50 * degree;
/// A fold below this share of the angle in question is flat ground to walk over.
constexpr double flat_share = 0.3;
constexpr double similar_angle = 1.3;  ///< ratio
constexpr double similar_width = 1.5;  ///< ratio
/// A tessellated fillet meets its tangent planes by half a step: such a fold ends a run.
constexpr double half_low = 0.38, half_high = 0.65;
/// Rulings of coarse cones: up to 31° between neighbours at eight facets.
constexpr double largest_ruling_angle = 36 * degree;
constexpr int longest_walk = 200;  ///< faces over one facet

struct Edge {
    std::size_t face;
    std::size_t k;
};

struct Fold {
    Edge from;     ///< the fold seen from the facet that was walked over
    double width;  ///< length of the walk
};

class FeatureTest {
  public:
    FeatureTest(const WorkMesh& mesh, double degrees, const runtime::RunControl& control)
        : mesh_(mesh), least_cosine_(std::cos(std::min(degrees, 180.0) * degree)) {
        find_normals(control);
    }

    bool is_feature(const Edge& e) const {
        const auto g = static_cast<std::size_t>(mesh_.neighbors[e.face][e.k]);
        const Vec3 &n = normal(e.face), &m = normal(g);
        if (dot(n, m) > least_cosine_ || n == Vec3{} || m == Vec3{}) return false;
        const double angle = turning_angle(e);
        return std::abs(angle) > largest_facet_angle || !in_smooth_run(e, angle);
    }

  private:
    const Vec3& normal(std::size_t f) const { return own_normals_.empty() ? mesh_.normals[f] : own_normals_[f]; }
    Vec3 start(const Edge& e) const { return mesh_.positions[mesh_.faces[e.face][e.k]]; }
    Vec3 end(const Edge& e) const { return mesh_.positions[mesh_.faces[e.face][(e.k + 1) % 3]]; }
    Edge across(const Edge& e) const {
        const auto g = static_cast<std::size_t>(mesh_.neighbors[e.face][e.k]);
        return {g, matching_edge(mesh_, e.face, e.k)};
    }

    /// A face without area takes the normal from across its longest edge: its middle corner lies on that edge, so the
    /// faces at the two short edges are those on the other side.
    void find_normals(const runtime::RunControl& control) {
        if (std::none_of(mesh_.areas.begin(), mesh_.areas.end(), [](double a) { return a == 0; })) return;
        own_normals_ = mesh_.normals;
        std::vector<std::uint32_t> open;
        for (std::size_t f = 0; f < mesh_.face_count(); ++f) {
            if (mesh_.areas[f] == 0) open.push_back(static_cast<std::uint32_t>(f));
        }
        for (int sweep = 0; sweep < 16 && !open.empty(); ++sweep) {
            control.check();
            std::vector<std::pair<std::uint32_t, Vec3>> found;
            std::vector<std::uint32_t> rest;
            for (const std::uint32_t f : open) {
                Vec3 best;
                double best_length = -1;
                for (std::size_t k = 0; k < 3; ++k) {
                    const std::int32_t g = mesh_.neighbors[f][k];
                    if (g < 0 || own_normals_[static_cast<std::size_t>(g)] == Vec3{}) continue;
                    const double length = squared_norm(end({f, k}) - start({f, k}));
                    if (length > best_length) {
                        best_length = length;
                        best = own_normals_[static_cast<std::size_t>(g)];
                    }
                }
                if (best_length >= 0) {
                    found.emplace_back(f, best);
                } else {
                    rest.push_back(f);
                }
            }
            for (const auto& [f, n] : found) own_normals_[f] = n;
            open = std::move(rest);
        }
    }

    /// Signed: positive where the surface is convex.
    double turning_angle(const Edge& e) const {
        const Edge other = across(e);
        const Vec3 &n = normal(e.face), &m = normal(other.face);
        const Vec3 direction = end(e) - start(e);
        const double angle = angle_between(n, m);
        return dot(cross(n, m), direction) >= 0 ? angle : -angle;
    }

    bool is_flat(const Edge& e, double angle) const {
        const auto g = static_cast<std::size_t>(mesh_.neighbors[e.face][e.k]);
        return angle_between(normal(e.face), normal(g)) < flat_share * std::abs(angle);
    }

    /// From a point of face e.face near edge e straight on over flat edges. False at a border or after too long a way.
    bool walk(const Edge& e, Vec3 point, Vec3 direction, double angle, Fold& fold) const {
        std::size_t f = e.face, entry = e.k;
        double width = 0;
        for (int step = 0; step < longest_walk; ++step) {
            const Vec3& n = normal(f);
            direction = direction - n * dot(direction, n);
            const double length = norm(direction);
            if (!(length > 0)) return false;
            direction = direction / length;
            const Vec3 side = cross(n, direction);  // the exit edge has its ends on either side of the way
            double nearest = -1;
            std::size_t exit = entry;
            for (const std::size_t k : {(entry + 1) % 3, (entry + 2) % 3}) {
                const Vec3 a = start({f, k}) - point, b = end({f, k}) - point;
                const double sa = dot(a, side), sb = dot(b, side);
                if (!(sa <= 0 && sb >= 0 && sb > sa)) continue;  // counter-clockwise: the way leaves from right to left
                const double t = -sa / (sb - sa);
                const double distance = dot(a * (1 - t) + b * t, direction);
                if (distance > nearest) {
                    nearest = distance;
                    exit = k;
                }
            }
            if (exit == entry || mesh_.neighbors[f][exit] == no_face) return false;
            width += std::max(0.0, nearest);
            const Edge out{f, exit};
            if (!is_flat(out, angle)) {
                fold = {out, width};
                return true;
            }
            point += direction * std::max(0.0, nearest);
            const Edge in = across(out);
            f = in.face;
            entry = in.k;
        }
        return false;
    }

    /// Centre of the facet that e.face belongs to, as far as it has few faces.
    Vec3 facet_centre(const Edge& e, double angle) const {
        constexpr std::size_t most = 24;
        std::array<std::size_t, most> faces{};
        std::size_t count = 0;
        faces[count++] = e.face;
        Vec3 sum;
        double area = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t f = faces[i];
            sum += mesh_.centroid(f) * mesh_.areas[f];
            area += mesh_.areas[f];
            for (std::size_t k = 0; k < 3 && count < most; ++k) {
                if (mesh_.neighbors[f][k] == no_face || !is_flat({f, k}, angle)) continue;
                const auto g = static_cast<std::size_t>(mesh_.neighbors[f][k]);
                const auto last = faces.begin() + static_cast<std::ptrdiff_t>(count);
                if (std::find(faces.begin(), last, g) == last) faces[count++] = g;
            }
        }
        return area > 0 ? sum / area : mesh_.centroid(e.face);
    }

    /// The next fold over the facet of e.face whose line runs nearly along that of e.
    bool next_fold(const Edge& e, double angle, Fold& fold) const {
        const Vec3 a = start(e), b = end(e);
        const Vec3 ruling = normalized(b - a);
        const Vec3 inward = cross(normal(e.face), ruling);
        const auto along = [&] {
            const Vec3 other = end(fold.from) - start(fold.from);
            return norm(cross(ruling, other)) <= std::sin(largest_ruling_angle) * norm(other);
        };
        for (const double t : {0.5, 0.25, 0.75}) {
            if (walk(e, a * (1 - t) + b * t, inward, angle, fold) && along()) return true;
        }
        // Short facets of cones: the perpendicular may leave by the rim.
        const Vec3 middle = (a + b) * 0.5;
        return walk(e, middle, facet_centre(e, angle) - middle, angle, fold) && along();
    }

    enum class Likeness { none, half, full };
    static Likeness likeness(double angle, double other) {
        const double ratio = other / angle;  // negative: bends the other way
        if (ratio >= 1 / similar_angle && ratio <= similar_angle) return Likeness::full;
        return ratio >= half_low && ratio <= half_high ? Likeness::half : Likeness::none;
    }

    /// Widths of the strips beyond e on the side of e.face, at most two; 0: there is no like fold.
    std::array<double, 2> strips(Edge e, double angle) const {
        std::array<double, 2> widths{0, 0};
        for (double& width : widths) {
            Fold fold{};
            if (!next_fold(e, angle, fold)) break;
            const Likeness like = likeness(angle, turning_angle(fold.from));
            if (like == Likeness::none) break;
            width = fold.width;
            if (like == Likeness::half) break;
            e = across(fold.from);
        }
        return widths;
    }

    bool in_smooth_run(const Edge& e, double angle) const {
        const auto alike = [](double v, double w) {
            return v > 0 && w > 0 && std::max(v, w) <= similar_width * std::min(v, w);
        };
        const auto near = strips(e, angle);
        if (alike(near[0], near[1])) return true;
        const auto far = strips(across(e), angle);
        return alike(near[0], far[0]) || alike(far[0], far[1]);
    }

    const WorkMesh& mesh_;
    double least_cosine_;
    std::vector<Vec3> own_normals_;  ///< empty: those of the mesh
};

}  // namespace

FeatureEdges find_feature_edges(const WorkMesh& mesh, double degrees, const runtime::RunControl& control) {
    FeatureEdges features(mesh.face_count(), 0);
    if (!(degrees > 0)) return features;
    const FeatureTest test(mesh, degrees, control);
    // Each edge is decided once, at its smaller face, and taken over by the other.
    FeatureEdges decided(mesh.face_count(), 0);
    const auto each_block = [&](const auto& body) {
        runtime::parallel_blocks(mesh.face_count(), block / 4, [&](std::size_t begin, std::size_t end) {
            std::size_t counter = 0;
            for (std::size_t f = begin; f < end; ++f) {
                control.check_often(counter);
                for (std::size_t k = 0; k < 3; ++k) {
                    if (mesh.neighbors[f][k] != no_face) body(f, k, static_cast<std::size_t>(mesh.neighbors[f][k]));
                }
            }
        });
    };
    each_block([&](std::size_t f, std::size_t k, std::size_t g) {
        if (f < g && test.is_feature({f, k})) decided[f] = static_cast<std::uint8_t>(decided[f] | 1U << k);
    });
    each_block([&](std::size_t f, std::size_t k, std::size_t g) {
        const bool set = f < g ? (decided[f] >> k & 1U) != 0
                               : decided[g] != 0 && (decided[g] >> matching_edge(mesh, f, k) & 1U) != 0;
        if (set) features[f] = static_cast<std::uint8_t>(features[f] | 1U << k);
    });
    return features;
}

std::vector<std::int32_t> feature_groups(const WorkMesh& mesh, const FeatureEdges& features, std::size_t& groups) {
    std::vector<std::int32_t> group(mesh.face_count(), -1);
    std::vector<std::uint32_t> stack;
    groups = 0;
    for (std::size_t start = 0; start < mesh.face_count(); ++start) {
        if (group[start] >= 0) continue;
        const auto id = static_cast<std::int32_t>(groups++);
        group[start] = id;
        stack.assign(1, static_cast<std::uint32_t>(start));
        while (!stack.empty()) {
            const std::size_t f = stack.back();
            stack.pop_back();
            for (std::size_t k = 0; k < 3; ++k) {
                const std::int32_t g = mesh.neighbors[f][k];
                if (g == no_face || (features[f] >> k & 1U) != 0 || group[static_cast<std::size_t>(g)] >= 0) continue;
                group[static_cast<std::size_t>(g)] = id;
                stack.push_back(static_cast<std::uint32_t>(g));
            }
        }
    }
    return group;
}

std::size_t count_feature_edges(const FeatureEdges& features) {
    std::size_t sides = 0;
    for (const std::uint8_t bits : features) sides += (bits & 1U) + (bits >> 1 & 1U) + (bits >> 2 & 1U);
    return sides / 2;
}

}  // namespace quadseg::mesh
