#include "simplify/face_map.h"

#include "runtime/parallel.h"

#include <algorithm>
#include <cmath>

namespace quadseg::simplify {
namespace {

constexpr std::size_t grain = 2048;
/// A turned normal counts as much as this share of the simplified face's size (squared: of its area).
constexpr double normal_weight = 0.5;
constexpr int longest_walk = 32, longest_short_cut = 6;

double squared_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    // Ericson, Real-Time Collision Detection, section 5.1.5: by Voronoi regions.
    const Vec3 ab = b - a, ac = c - a, ap = p - a;
    const double d1 = dot(ab, ap), d2 = dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return squared_norm(ap);
    const Vec3 bp = p - b;
    const double d3 = dot(ab, bp), d4 = dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return squared_norm(bp);
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return squared_norm(ap - ab * (d1 > d3 ? d1 / (d1 - d3) : 0));
    const Vec3 cp = p - c;
    const double d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return squared_norm(cp);
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return squared_norm(ap - ac * (d2 > d6 ? d2 / (d2 - d6) : 0));
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        const double t = d4 - d3, u = d5 - d6;
        return squared_norm(bp - (c - b) * (t + u > 0 ? t / (t + u) : 0));
    }
    const double sum = va + vb + vc;
    if (!(sum > 0)) return squared_norm(ap);
    return squared_norm(ap - ab * (vb / sum) - ac * (vc / sum));
}

/// The simplified mesh with, for every face, the faces across its edges and around its corners.
class Target {
  public:
    Target(std::span<const Vec3> positions, std::span<const Face> faces)
        : positions_(positions),
          faces_(faces),
          begin_(positions.size() + 1, 0),
          around_(3 * faces.size()),
          across_(faces.size(), Face{none, none, none}),
          prisms_(faces.size()) {
        for (const Face& f : faces) {
            for (const std::uint32_t v : f) ++begin_[v + 1];
        }
        for (std::size_t v = 0; v < positions.size(); ++v) begin_[v + 1] += begin_[v];
        std::vector<std::uint32_t> fill(begin_.begin(), begin_.end() - 1);
        for (std::size_t i = 0; i < faces.size(); ++i) {
            for (const std::uint32_t v : faces[i]) around_[fill[v]++] = static_cast<std::uint32_t>(i);
        }
        runtime::parallel_for(faces.size(), grain, [&](std::size_t i) {
            const Face& f = faces[i];
            const Vec3 doubled = cross(positions[f[1]] - positions[f[0]], positions[f[2]] - positions[f[0]]);
            prisms_[i] = prism(f, doubled);
            for (std::size_t k = 0; k < 3; ++k) {
                for_faces_around(f[k], [&](std::uint32_t g) {
                    const Face& other = faces[g];
                    const std::uint32_t w = f[(k + 1) % 3];
                    if (g != i && (other[0] == w || other[1] == w || other[2] == w)) across_[i][k] = g;
                });
            }
        });
    }

    /// The face that the walk from f ends at: no neighbour has a smaller misfit.
    std::uint32_t nearest(const Vec3& point, const Vec3& normal, std::uint32_t f) const {
        // Most faces are there already, or a step or two away over the edge that the point lies beyond.
        std::uint32_t at = f;
        for (int step = 0; step < longest_short_cut && at != none; ++step) {
            const int edge = edge_crossed(point, normal, at);
            if (edge == inside) return at;
            if (edge == turned) break;
            at = across_[at][static_cast<std::size_t>(edge)];
        }
        double best = misfit(point, normal, f);
        for (int step = 0; step < longest_walk; ++step) {
            std::uint32_t next = f;
            const auto try_face = [&](std::uint32_t g) {
                if (g == f || least_misfit(point, normal, g) > best) return;
                const double m = misfit(point, normal, g);
                if (m < best || (m == best && g < next)) {
                    best = m;
                    next = g;
                }
            };
            for (const std::uint32_t g : across_[f]) {
                if (g != none) try_face(g);
            }
            // Neither over the face nor better across an edge: the right one may touch at a corner only.
            if (next == f && edge_crossed(point, normal, f) != inside) {
                for (const std::uint32_t v : faces_[f]) for_faces_around(v, try_face);
            }
            if (next == f) break;
            f = next;
        }
        return f;
    }

  private:
    template <class Visit>
    void for_faces_around(std::uint32_t v, const Visit& visit) const {
        const std::uint32_t end = std::min<std::uint32_t>(begin_[v + 1], begin_[v] + max_valence);
        for (std::uint32_t i = begin_[v]; i < end; ++i) visit(around_[i]);
    }
    /// No more than misfit(), but for rounding: from the plane of the face.
    double least_misfit(const Vec3& point, const Vec3& normal, std::uint32_t f) const {
        const Prism& p = prisms_[f];
        const double height = dot(p.normal, point - positions_[faces_[f][0]]);
        return (1 - 1e-6) * height * height + normal_weight * p.area * (1 - dot(normal, p.normal));
    }
    double misfit(const Vec3& point, const Vec3& normal, std::uint32_t f) const {
        const Face& face = faces_[f];
        return squared_distance(point, positions_[face[0]], positions_[face[1]], positions_[face[2]]) +
               normal_weight * prisms_[f].area * (1 - dot(normal, prisms_[f].normal));
    }
    static constexpr int inside = -1, turned = -2;
    /// What decides whether a point lies over a face: planes through its edges, upright on it.
    struct Prism {
        Vec3 normal;
        double area = 0;
        std::array<Vec3, 3> inward;  ///< of edge k = (v[k], v[(k+1)%3])
        std::array<double, 3> offset{};
    };
    Prism prism(const Face& f, const Vec3& doubled) const {
        Prism p;
        p.area = 0.5 * norm(doubled);
        p.normal = normalized(doubled);
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 &a = positions_[f[k]], &b = positions_[f[(k + 1) % 3]];
            p.inward[k] = normalized(cross(p.normal, b - a));
            p.offset[k] = dot(p.inward[k], a);
        }
        return p;
    }
    /// `inside`: the point lies over the face and the normals agree, so that no neighbour can do better by more than a
    /// hair. `turned`: they do not agree. Else the edge that it is farthest beyond.
    int edge_crossed(const Vec3& point, const Vec3& normal, std::uint32_t f) const {
        const Prism& p = prisms_[f];
        if (!(dot(normal, p.normal) > 0.9)) return turned;
        int edge = inside;
        double least = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const double d = dot(p.inward[k], point) - p.offset[k];
            if (d < least) {
                least = d;
                edge = static_cast<int>(k);
            }
        }
        return edge;
    }

    std::span<const Vec3> positions_;
    std::span<const Face> faces_;
    std::vector<std::uint32_t> begin_, around_;
    std::vector<Face> across_;  ///< face across edge k = (v[k], v[(k+1)%3]), or none
    std::vector<Prism> prisms_;
};

}  // namespace

std::vector<std::uint32_t> last_heirs(const CollapseMesh& mesh) {
    std::vector<std::uint32_t> heir(mesh.faces.size());
    for (std::size_t i = 0; i < heir.size(); ++i) {
        const auto f = static_cast<std::uint32_t>(i);
        heir[i] = mesh.alive(f) ? f : mesh.faces[i][1];
    }
    for (std::size_t i = 0; i < heir.size(); ++i) {
        std::uint32_t last = heir[i];
        while (last != none && heir[last] != last) last = heir[last];
        for (auto f = static_cast<std::uint32_t>(i); heir[f] != last && heir[f] != f;) {
            const std::uint32_t next = heir[f];
            heir[f] = last;
            if (next == none) break;
            f = next;
        }
    }
    return heir;
}

void refine_face_map(std::span<const Vec3> positions, std::span<const Face> faces,
                     std::span<const Vec3> simplified_positions, std::span<const Face> simplified_faces,
                     const std::function<bool()>& stopped, std::vector<std::uint32_t>& face_map) {
    const Target target(simplified_positions, simplified_faces);
    runtime::parallel_blocks(faces.size(), grain, [&](std::size_t begin, std::size_t end) {
        if (stopped()) return;
        for (std::size_t i = begin; i < end; ++i) {
            if (face_map[i] == none) continue;
            const Vec3 &a = positions[faces[i][0]], &b = positions[faces[i][1]], &c = positions[faces[i][2]];
            const Vec3 centroid = (a + b + c) / 3.0;
            const Vec3 normal = normalized(cross(b - a, c - a));
            face_map[i] = target.nearest(centroid, normal, face_map[i]);
        }
    });
}

}  // namespace quadseg::simplify
