#include "exact/facets.h"

#include "math/symmetric3.h"
#include "runtime/parallel.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <span>

namespace quadseg::exact {

namespace {

constexpr std::size_t block = 16384;  ///< faces of a task
constexpr std::size_t facet_grain = 256;
/// Of vertices, unit frame, as the normals see it.
constexpr double rounding = 1e-13;

/// Faces by falling height, to a factor of 2, then by index: slivers, whose normals say little, come last.
std::vector<std::uint32_t> order_by_height(const std::vector<float>& heights) {
    constexpr std::size_t buckets = 64;
    const auto bucket = [](float h) {
        return static_cast<std::size_t>(h > 0 ? std::clamp(-std::ilogb(h), 0, 62) : 63);
    };
    // A counting sort: where the faces of each bucket start, for each block of faces.
    const std::size_t blocks = (heights.size() + block - 1) / block;
    std::vector<std::uint32_t> start(buckets * blocks, 0);
    runtime::parallel_blocks(heights.size(), block, [&](std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f) ++start[bucket(heights[f]) * blocks + begin / block];
    });
    runtime::exclusive_scan(start);
    std::vector<std::uint32_t> order(heights.size());
    runtime::parallel_blocks(heights.size(), block, [&](std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f) {
            order[start[bucket(heights[f]) * blocks + begin / block]++] = static_cast<std::uint32_t>(f);
        }
    });
    return order;
}

/// Flag a vertex: all its faces are of one facet and none of its edges is a border.
std::vector<std::uint8_t> interior_vertices(const mesh::WorkMesh& mesh, const std::vector<std::int32_t>& facet_of) {
    // Any of the facets at a vertex may stay: where there are two, one of them differs from it.
    std::vector<std::int32_t> facet_at(mesh.vertex_count(), -1);
    runtime::parallel_for(mesh.face_count(), block, [&](std::size_t f) {
        for (const std::uint32_t v : mesh.faces[f]) {
            std::atomic_ref<std::int32_t>(facet_at[v]).store(facet_of[f], std::memory_order_relaxed);
        }
    });
    std::vector<std::uint8_t> interior(mesh.vertex_count(), 1);
    runtime::parallel_for(mesh.face_count(), block, [&](std::size_t f) {
        const auto exclude = [&](std::uint32_t v) {
            std::atomic_ref<std::uint8_t>(interior[v]).store(0, std::memory_order_relaxed);
        };
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t v = mesh.faces[f][k];
            if (facet_at[v] != facet_of[f]) exclude(v);
            if (mesh.neighbors[f][k] != mesh::no_face) continue;
            exclude(v);
            exclude(mesh.faces[f][(k + 1) % 3]);
        }
    });
    return interior;
}

struct Point2 {
    double x, y;
};

double turn(const Point2& o, const Point2& a, const Point2& b) {
    return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

double distance_to_line(const Point2& a, const Point2& b, const Point2& p) {
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    return length > 0 ? std::abs(turn(a, b, p)) / length : std::hypot(p.x - a.x, p.y - a.y);
}

/// Corners of the convex hull, counter-clockwise, those dropped that lie within `flat` of the line between their
/// neighbours.
std::vector<Point2> hull_corners(std::vector<Point2> points, double flat) {
    std::sort(points.begin(), points.end(),
              [](const Point2& a, const Point2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
    std::vector<Point2> hull;
    for (int half = 0; half < 2; ++half) {
        const std::size_t base = hull.size();
        for (const Point2& p : points) {
            while (hull.size() >= base + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0) hull.pop_back();
            hull.push_back(p);
        }
        hull.pop_back();
        std::reverse(points.begin(), points.end());
    }
    for (bool dropped = true; dropped && hull.size() > 3;) {
        dropped = false;
        for (std::size_t i = 0; i < hull.size() && hull.size() > 3; ++i) {
            const std::size_t n = hull.size();
            if (distance_to_line(hull[(i + n - 1) % n], hull[(i + 1) % n], hull[i]) > flat) continue;
            hull.erase(hull.begin() + static_cast<std::ptrdiff_t>(i));
            dropped = true;
        }
    }
    return hull;
}

/// Whether all points lie on two sides of their convex hull (opposite ones of a quad, any two of a triangle).
bool on_two_sides(const std::vector<Point2>& points) {
    double extent = 0;
    for (const Point2& p : points) extent = std::max(extent, std::hypot(p.x - points[0].x, p.y - points[0].y));
    const double flat = 1e-3 * extent;
    const std::vector<Point2> hull = hull_corners(points, flat);
    if (hull.size() > 4) return false;
    if (hull.size() < 3) return true;
    for (std::size_t side = 0; side < hull.size(); ++side) {
        const std::size_t other = hull.size() == 4 ? (side + 2) % 4 : (side + 1) % 3;
        const auto on_side = [&](const Point2& p) {
            return distance_to_line(hull[side], hull[(side + 1) % hull.size()], p) <= flat ||
                   distance_to_line(hull[other], hull[(other + 1) % hull.size()], p) <= flat;
        };
        if (std::all_of(points.begin(), points.end(), on_side)) return true;
    }
    return false;
}

/// Running sums of the corners of a cluster, about its first corner.
class PlaneSums {
  public:
    explicit PlaneSums(const Vec3& origin) : origin_(origin) {}
    void add(const Vec3& p) {
        const Vec3 u = p - origin_;
        sum_ += u;
        second_.add_outer(u);
        ++count_;
    }
    void fit(Vec3& normal, double& offset) const {
        const double n = static_cast<double>(count_);
        const Vec3 mean = sum_ / n;
        Symmetric3 covariance = second_;
        covariance.add_outer(mean, -n);
        const EigenSystem eigen = eigen_decomposition(covariance);
        const Vec3 fitted = dot(eigen.vectors[0], normal) < 0 ? -eigen.vectors[0] : eigen.vectors[0];
        normal = fitted;
        offset = dot(normal, origin_ + mean);
    }

  private:
    Vec3 origin_, sum_;
    Symmetric3 second_;
    std::size_t count_ = 0;
};

class FacetFinder {
  public:
    FacetFinder(const mesh::WorkMesh& mesh, const Tolerances& t, const std::vector<float>& heights,
                const runtime::RunControl& control)
        : mesh_(mesh), tolerances_(t), control_(control), heights_(heights) {
        result_.of_face.assign(mesh.face_count(), -1);
        members_.reserve(mesh.face_count());
    }

    Facets find() {
        const std::vector<std::uint32_t> order = order_by_height(heights_);
        control_.check();
        find_lonely();
        for (const std::uint32_t seed : order) {
            control_.check_often(polls_);
            if (result_.of_face[seed] < 0) grow(seed);
        }
        lonely_ = {};
        begin_.push_back(static_cast<std::uint32_t>(members_.size()));
        control_.check();
        interior_ = interior_vertices(mesh_, result_.of_face);
        runtime::parallel_blocks(result_.facet.size(), facet_grain, [&](std::size_t begin, std::size_t end) {
            control_.check();
            for (std::size_t id = begin; id < end; ++id) judge(id);
        });
        control_.check();
        index_faces();
        return std::move(result_);
    }

  private:
    Facet facet_of_seed(std::uint32_t f) const {
        return {mesh_.normals[f], dot(mesh_.normals[f], mesh_.corner(f, 0)), 0, false};
    }

    /// Facets grow one after the other, since faces go to the first that reaches them; which faces would take none of
    /// their neighbours, on fine curved meshes nearly all, is found by all threads before.
    void find_lonely() {
        lonely_.resize(mesh_.face_count());
        runtime::parallel_blocks(lonely_.size(), block, [&](std::size_t begin, std::size_t end) {
            control_.check();
            for (std::size_t f = begin; f < end; ++f) {
                const Facet facet = facet_of_seed(static_cast<std::uint32_t>(f));
                const auto joins = [&](std::int32_t g) {
                    return g >= 0 && coplanar(static_cast<std::uint32_t>(g), facet);
                };
                const auto& neighbors = mesh_.neighbors[f];
                const bool grows =
                    squared_norm(facet.normal) > 0 && std::any_of(neighbors.begin(), neighbors.end(), joins);
                lonely_[f] = grows ? 0 : 1;
            }
        });
    }

    void grow(std::uint32_t seed) {
        const auto id = static_cast<std::int32_t>(result_.facet.size());
        Facet facet = facet_of_seed(seed);
        PlaneSums sums(mesh_.corner(seed, 0));
        const std::size_t first = members_.size();
        begin_.push_back(static_cast<std::uint32_t>(first));
        members_.push_back(seed);
        result_.of_face[seed] = id;
        std::size_t next_fit = 4;
        if (lonely_[seed] == 0) {
            for (std::size_t i = first; i < members_.size(); ++i) {
                control_.check_often(polls_);
                const std::uint32_t f = members_[i];
                for (int k = 0; k < 3; ++k) sums.add(mesh_.corner(f, k));
                if (i + 1 - first == next_fit) {
                    sums.fit(facet.normal, facet.offset);
                    next_fit *= 2;
                }
                for (const std::int32_t g : mesh_.neighbors[f]) {
                    if (g < 0 || result_.of_face[static_cast<std::size_t>(g)] >= 0) continue;
                    if (!coplanar(static_cast<std::uint32_t>(g), facet)) continue;
                    result_.of_face[static_cast<std::size_t>(g)] = id;
                    members_.push_back(static_cast<std::uint32_t>(g));
                }
            }
            if (members_.size() - first > 2) sums.fit(facet.normal, facet.offset);
        }
        result_.facet.push_back(facet);
    }

    void judge(std::size_t id) {
        Facet& facet = result_.facet[id];
        const std::span<const std::uint32_t> members(&members_[begin_[id]], begin_[id + 1] - begin_[id]);
        for (const std::uint32_t f : members) facet.area += mesh_.areas[f];
        facet.sure = (has_interior_vertex(members) || !is_strip(members, facet)) &&
                     !creeps_away(static_cast<std::int32_t>(id), members, facet);
    }

    bool coplanar(std::uint32_t f, const Facet& facet) const {
        // No vertex has to be looked at where the normal is off by more than the height of the face allows.
        const double height = static_cast<double>(heights_[f]);
        const double most_tilt = (2.1 * tolerances_.facet + rounding) / height;
        if (squared_norm(cross(facet.normal, mesh_.normals[f])) > most_tilt * most_tilt) return false;
        for (int k = 0; k < 3; ++k) {
            if (!(std::abs(dot(facet.normal, mesh_.corner(f, k)) - facet.offset) <= tolerances_.facet)) return false;
        }
        // The vertices bound the tilt of a face that is high enough; what remains to be seen is whether it is folded
        // over.
        return height < 4 * tolerances_.facet || dot(facet.normal, mesh_.normals[f]) > 0;
    }

    bool has_interior_vertex(std::span<const std::uint32_t> members) const {
        return std::any_of(members.begin(), members.end(), [&](std::uint32_t f) {
            const auto& v = mesh_.faces[f];
            return interior_[v[0]] != 0 || interior_[v[1]] != 0 || interior_[v[2]] != 0;
        });
    }

    /// A facet of a ruled or swept tessellation has its vertices on two lines: two rulings, or two sides of a planar
    /// quad.
    bool is_strip(std::span<const std::uint32_t> members, const Facet& facet) const {
        if (members.size() < 3) return true;
        const Vec3 u = any_perpendicular(facet.normal), v = cross(facet.normal, u);
        const Vec3 origin = mesh_.corner(members.front(), 0);
        std::vector<Point2> outline;
        outline.reserve(3 * members.size());
        for (const std::uint32_t f : members) {
            for (int k = 0; k < 3; ++k) {
                const Vec3 p = mesh_.corner(f, k) - origin;
                outline.push_back({dot(p, u), dot(p, v)});
            }
        }
        return on_two_sides(outline);
    }

    /// A patch of a curved surface that is flat within the tolerance goes on smoothly beyond its border.
    bool creeps_away(std::int32_t id, std::span<const std::uint32_t> members, const Facet& facet) const {
        double border = 0, creeping = 0;
        for (const std::uint32_t f : members) {
            for (int k = 0; k < 3; ++k) {
                const std::int32_t g = mesh_.neighbors[f][static_cast<std::size_t>(k)];
                if (g >= 0 && result_.of_face[static_cast<std::size_t>(g)] == id) continue;
                const double length = norm(mesh_.corner(f, (k + 1) % 3) - mesh_.corner(f, k));
                border += length;
                if (g < 0) continue;
                double d = 0;
                for (int j = 0; j < 3; ++j) {
                    d = std::max(
                        d, std::abs(dot(facet.normal, mesh_.corner(static_cast<std::size_t>(g), j)) - facet.offset));
                }
                if (d < 20 * tolerances_.facet &&
                    dot(facet.normal, mesh_.normals[static_cast<std::size_t>(g)]) > 0.9994) {
                    creeping += length;
                }
            }
        }
        return creeping > 0.5 * border;
    }

    void index_faces() {
        result_.begin = begin_;
        result_.face.resize(result_.of_face.size());
        std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
        for (std::size_t f = 0; f < result_.of_face.size(); ++f) {
            result_.face[next[static_cast<std::size_t>(result_.of_face[f])]++] = static_cast<std::uint32_t>(f);
        }
    }

    const mesh::WorkMesh& mesh_;
    const Tolerances& tolerances_;
    const runtime::RunControl& control_;
    const std::vector<float>& heights_;
    Facets result_;
    std::vector<std::uint32_t> members_;  ///< faces as they joined their facets
    std::vector<std::uint32_t> begin_;    ///< of each facet in members_
    std::vector<std::uint8_t> lonely_;    ///< a flag a face: as a seed it stays alone
    std::vector<std::uint8_t> interior_;
    std::size_t polls_ = 0;
};

}  // namespace

std::vector<float> face_heights(const mesh::WorkMesh& mesh) {
    std::vector<float> heights(mesh.face_count());
    runtime::parallel_for(heights.size(), 16384, [&](std::size_t f) {
        double longest = 0;
        for (int k = 0; k < 3; ++k) {
            longest = std::max(longest, squared_norm(mesh.corner(f, (k + 1) % 3) - mesh.corner(f, k)));
        }
        heights[f] = static_cast<float>(longest > 0 ? 2 * mesh.areas[f] / std::sqrt(longest) : 0);
    });
    return heights;
}

Facets find_facets(const mesh::WorkMesh& mesh, const Tolerances& tolerances, const std::vector<float>& heights,
                   const runtime::RunControl& control) {
    return FacetFinder(mesh, tolerances, heights, control).find();
}

}  // namespace quadseg::exact
