#include "simplify/collapse_mesh.h"

#include "runtime/parallel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace quadseg::simplify {
namespace {

constexpr std::size_t grain = 1024;
/// A border may give way only for a hundred times the error that a surface may; a crease is held by its faces already.
constexpr double border_weight = 100, crease_weight = 1;
/// Faces may turn by 78° in a collapse.
constexpr double smallest_turn_cosine = 0.2;
/// Twice the area over the square of the longest edge; .87 in an equilateral triangle.
constexpr double sliver_shape = 0.02;

Vec3 finite_or_zero(const Vec3& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z) ? p : Vec3{};
}

Frame box_frame(std::span<const Vec3> positions) {
    if (positions.empty()) return {};
    Vec3 low = finite_or_zero(positions[0]), high = low;
    for (const Vec3& raw : positions) {
        const Vec3 p = finite_or_zero(raw);
        for (int k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], p[k]);
            high[k] = std::max(high[k], p[k]);
        }
    }
    const Vec3 size = high - low;
    const double extent = std::max({size.x, size.y, size.z});
    const double scale = extent > 0 && std::isfinite(1 / extent) && std::isfinite(extent) ? 1 / extent : 1;
    return {low * 0.5 + high * 0.5, scale};
}

/// Vertices of more faces are sorted.
constexpr std::size_t max_regular = 16;

/// What the build needs of one vertex; kept between vertices to spare allocations.
class VertexBuilder {
  public:
    VertexBuilder(CollapseMesh& mesh, std::span<const Vec3> unit_normals, std::span<const double> face_areas,
                  double crease_cosine)
        : mesh_(mesh), normals_(unit_normals), areas_(face_areas), crease_cosine_(crease_cosine) {}

    void build(std::uint32_t v) {
        sides_.clear();
        std::uint32_t corners = 0;
        ErrorQuadric quadric;
        for (std::uint32_t c = mesh_.first_corner[v]; c != none; c = mesh_.next_corner[c], ++corners) {
            const std::uint32_t f = corner_face(c);
            const Face& face = mesh_.faces[f];
            const std::uint32_t k = c - 3 * f;
            sides_.push_back({face[(k + 1) % 3], corners, f, true});
            sides_.push_back({face[(k + 2) % 3], corners, f, false});
            quadric.add_plane(normals_[f], dot(normals_[f], mesh_.vertices[face[0]].position), areas_[f]);
            quadric.area += areas_[f];
        }
        mesh_.vertices[v].valence = corners;
        if (build_regular(quadric, v)) return;
        std::sort(sides_.begin(), sides_.end(), [](const Side& s, const Side& t) {
            return s.neighbor != t.neighbor
                       ? s.neighbor < t.neighbor
                       : 2 * s.corner + (s.outgoing ? 0U : 1U) < 2 * t.corner + (t.outgoing ? 0U : 1U);
        });
        std::uint8_t flags = 0;
        fan_.resize(corners);
        for (std::uint32_t i = 0; i < corners; ++i) fan_[i] = i;
        std::uint32_t fans = corners;
        for (std::size_t i = 0; i < sides_.size();) {
            std::size_t j = i + 1;
            while (j < sides_.size() && sides_[j].neighbor == sides_[i].neighbor) ++j;
            if (j - i == 1) {
                flags |= vertex_border | vertex_irregular;
                hold_edge(quadric, v, sides_[i], border_weight);
            } else if (j - i == 2) {
                const Side &s = sides_[i], &t = sides_[i + 1];
                double cosine = dot(normals_[s.face], normals_[t.face]);
                if (s.outgoing == t.outgoing) {
                    flags |= vertex_irregular;
                    cosine = -cosine;
                }
                hold_crease(quadric, v, s, t, cosine);
                if (join(s.corner, t.corner)) --fans;
            } else {
                flags |= vertex_locked | vertex_irregular;
            }
            i = j;
        }
        if (fans > 1) flags |= vertex_locked | vertex_irregular;
        mesh_.vertices[v].flags = flags;
        mesh_.vertices[v].quadric = quadric;
    }

  private:
    struct Side {
        std::uint32_t neighbor, corner, face;
        bool outgoing;
    };

    /// The common case, without sorting: the faces go once around v.
    bool build_regular(ErrorQuadric& quadric, std::uint32_t v) {
        const std::size_t corners = sides_.size() / 2;
        if (corners < 3 || corners > max_regular) return false;
        const auto outgoing = [&](std::size_t i) -> const Side& { return sides_[2 * i]; };
        const auto incoming = [&](std::size_t i) -> const Side& { return sides_[2 * i + 1]; };
        std::size_t at = 0;
        ErrorQuadric held = quadric;
        for (std::size_t step = 1; step <= corners; ++step) {
            // The face that goes on where this one ends, and no second one that ends there too.
            std::size_t next = corners, others = 0;
            for (std::size_t j = 0; j < corners; ++j) {
                if (incoming(j).neighbor == outgoing(at).neighbor) next = j, ++others;
                if (outgoing(j).neighbor == outgoing(at).neighbor) ++others;
            }
            if (next == corners || others != 2 || (next == 0) != (step == corners)) return false;
            const Side &s = outgoing(at), &t = incoming(next);
            hold_crease(held, v, s, t, dot(normals_[s.face], normals_[t.face]));
            at = next;
        }
        mesh_.vertices[v].flags = 0;
        mesh_.vertices[v].quadric = held;
        return true;
    }

    void hold_crease(ErrorQuadric& quadric, std::uint32_t v, const Side& s, const Side& t, double cosine) const {
        if (cosine < crease_cosine_ && areas_[s.face] > 0 && areas_[t.face] > 0) {
            hold_edge(quadric, v, s, crease_weight);
            hold_edge(quadric, v, t, crease_weight);
        }
    }

    void hold_edge(ErrorQuadric& quadric, std::uint32_t v, const Side& side, double weight) const {
        const Vec3 edge = mesh_.vertices[side.neighbor].position - mesh_.vertices[v].position;
        const Vec3 across = normalized(cross(normals_[side.face], edge));
        quadric.add_plane(across, dot(across, mesh_.vertices[v].position), weight * squared_norm(edge));
    }
    std::uint32_t fan_of(std::uint32_t corner) {
        while (fan_[corner] != corner) corner = fan_[corner] = fan_[fan_[corner]];
        return corner;
    }
    bool join(std::uint32_t i, std::uint32_t j) {
        i = fan_of(i);
        j = fan_of(j);
        if (i == j) return false;
        fan_[std::max(i, j)] = std::min(i, j);
        return true;
    }

    CollapseMesh& mesh_;
    std::span<const Vec3> normals_;
    std::span<const double> areas_;
    double crease_cosine_;
    std::vector<Side> sides_;
    std::vector<std::uint32_t> fan_;
};

/// The star of a vertex: its faces with the two other vertices of each.
struct Star {
    std::size_t size = 0;
    std::array<std::uint32_t, max_valence> corner, next, previous;

    /// Corners of faces that are gone leave the list of v.
    bool gather(CollapseMesh& mesh, std::uint32_t v) {
        size = 0;
        std::uint32_t* link = &mesh.first_corner[v];
        while (*link != none) {
            const std::uint32_t c = *link, f = corner_face(c), k = c - 3 * f;
            const Face& face = mesh.faces[f];
            if (face[0] == none) {
                *link = mesh.next_corner[c];
                continue;
            }
            if (size == max_valence) return false;
            link = &mesh.next_corner[c];
            corner[size] = c;
            next[size] = face[k == 2 ? 0 : k + 1];
            previous[size] = face[k == 0 ? 2 : k - 1];
            ++size;
        }
        return true;
    }
    std::size_t faces_with(std::uint32_t neighbor) const {
        std::size_t count = 0;
        for (std::size_t i = 0; i < size; ++i) count += next[i] == neighbor || previous[i] == neighbor;
        return count;
    }
    bool has_face(std::uint32_t p, std::uint32_t q) const {
        for (std::size_t i = 0; i < size; ++i) {
            if ((next[i] == p && previous[i] == q) || (next[i] == q && previous[i] == p)) return true;
        }
        return false;
    }
};

/// The faces of edge (v, w), and the vertices opposite.
struct EdgeFaces {
    std::size_t count = 0;
    std::array<std::uint32_t, 2> face{}, apex{};
};

bool gather_edge_faces(const Star& star, std::uint32_t w, EdgeFaces& edge) {
    for (std::size_t i = 0; i < star.size; ++i) {
        if (star.next[i] != w && star.previous[i] != w) continue;
        if (edge.count == 2) return false;
        edge.face[edge.count] = corner_face(star.corner[i]);
        edge.apex[edge.count] = star.next[i] == w ? star.previous[i] : star.next[i];
        ++edge.count;
    }
    return edge.count == 1 || (edge.count == 2 && edge.apex[0] != edge.apex[1]);
}

/// Lk(v) ∩ Lk(w) = Lk(vw), borders closed by an imaginary vertex.
bool link_condition(const CollapseMesh& mesh, std::uint32_t v, std::uint32_t w, const Star& sv, const Star& sw,
                    const EdgeFaces& edge) {
    const std::uint8_t fv = mesh.vertices[v].flags, fw = mesh.vertices[w].flags;
    if ((fv & fw & vertex_locked) != 0) return false;
    constexpr std::uint8_t edged = vertex_border | vertex_locked;
    if ((fv & edged) != 0 && (fw & edged) != 0 && edge.count == 2) return false;
    for (std::size_t i = 0; i < sv.size; ++i) {
        for (const std::uint32_t n : {sv.next[i], sv.previous[i]}) {
            if (n == w || n == edge.apex[0] || (edge.count == 2 && n == edge.apex[1])) continue;
            for (std::size_t j = 0; j < sw.size; ++j) {
                if (sw.next[j] == n || sw.previous[j] == n) return false;
            }
            if (mesh.vertices[v].flags == 0) break;  // in a regular fan the successors name every neighbour
        }
    }
    if (edge.count == 2) return !(sv.has_face(edge.apex[0], edge.apex[1]) && sw.has_face(edge.apex[0], edge.apex[1]));
    return sv.faces_with(edge.apex[0]) > 1 || sw.faces_with(edge.apex[0]) > 1;  // else the triangle stands alone
}

double longest_squared(const Vec3& p, const Vec3& q, const Vec3& r) {
    return std::max({squared_norm(q - p), squared_norm(r - q), squared_norm(p - r)});
}

double shape(double squared_doubled_area, double longest_squared) {
    return longest_squared > 0 ? std::sqrt(squared_doubled_area) / longest_squared : 0;
}

/// May the faces of `star` that stay follow their vertex from `from` to `to`?
bool faces_follow(const CollapseMesh& mesh, const Star& star, std::uint32_t other, const Vec3& from, const Vec3& to,
                  bool keep_shape) {
    for (std::size_t i = 0; i < star.size; ++i) {
        if (star.next[i] == other || star.previous[i] == other) continue;
        const Vec3 &q = mesh.vertices[star.next[i]].position, &r = mesh.vertices[star.previous[i]].position;
        const Vec3 before = cross(q - from, r - from), after = cross(q - to, r - to);
        const double b2 = squared_norm(before), a2 = squared_norm(after);
        const double d = dot(before, after);
        if (b2 > 0 && !(d > 0 && d * d > smallest_turn_cosine * smallest_turn_cosine * a2 * b2)) return false;
        if (keep_shape) {
            const double longest = longest_squared(to, q, r);
            if (!(a2 >= sliver_shape * sliver_shape * longest * longest) &&
                !(shape(a2, longest) >= 0.5 * shape(b2, longest_squared(from, q, r)))) {
                return false;
            }
        }
    }
    return true;
}

/// The face of `star` other than `face` that has `neighbor`: across that edge.
std::uint32_t face_across(const Star& star, std::uint32_t face, std::uint32_t neighbor) {
    for (std::size_t i = 0; i < star.size; ++i) {
        if ((star.next[i] == neighbor || star.previous[i] == neighbor) && corner_face(star.corner[i]) != face) {
            return corner_face(star.corner[i]);
        }
    }
    return none;
}

}  // namespace

bool build_collapse_mesh(std::span<const Vec3> positions, std::span<const Face> faces, double feature_degrees,
                         const std::function<bool()>& stopped, CollapseMesh& mesh) {
    const std::size_t vertices = positions.size(), n = faces.size();
    mesh.frame = box_frame(positions);
    // A million of them are 128 MB, of which the system clears every page first.
    constexpr std::size_t step = 65536;
    mesh.vertices.reserve(vertices);
    while (mesh.vertices.size() < vertices) {
        if (stopped()) return false;
        mesh.vertices.resize(std::min(vertices, mesh.vertices.size() + step));
    }
    mesh.first_corner.assign(vertices, none);
    mesh.next_corner.assign(3 * n, none);
    mesh.faces.assign(faces.begin(), faces.end());
    runtime::parallel_blocks(vertices, grain, [&](std::size_t begin, std::size_t end) {
        if (stopped()) return;
        for (std::size_t v = begin; v < end; ++v) {
            mesh.vertices[v].position = mesh.frame.to_unit(finite_or_zero(positions[v]));
            mesh.vertices[v].source = static_cast<std::uint32_t>(v);
        }
    });
    if (stopped()) return false;
    std::vector<Vec3> normals(n);
    std::vector<double> areas(n);
    runtime::parallel_blocks(n, grain, [&](std::size_t begin, std::size_t end) {
        if (stopped()) return;
        for (std::size_t i = begin; i < end; ++i) {
            Face& f = mesh.faces[i];
            if (f[0] == f[1] || f[1] == f[2] || f[2] == f[0]) {
                f = {none, none, none};
                continue;
            }
            const Vec3 doubled = mesh.area_vector(f);
            areas[i] = 0.5 * norm(doubled);
            normals[i] = normalized(doubled);
        }
    });
    mesh.face_count = 0;
    for (std::size_t i = n; i-- > 0;) {  // from the last to the first: the lists come out ascending
        if ((i & 0xffffU) == 0 && stopped()) return false;
        if (mesh.faces[i][0] == none) continue;
        ++mesh.face_count;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t v = mesh.faces[i][k];
            mesh.next_corner[3 * i + k] = mesh.first_corner[v];
            mesh.first_corner[v] = static_cast<std::uint32_t>(3 * i + k);
        }
    }
    const double crease_cosine = std::cos(feature_degrees * std::numbers::pi / 180);
    runtime::parallel_blocks(vertices, grain, [&](std::size_t begin, std::size_t end) {
        if (stopped()) return;
        VertexBuilder builder(mesh, normals, areas, crease_cosine);
        for (std::size_t v = begin; v < end; ++v) builder.build(static_cast<std::uint32_t>(v));
    });
    return !stopped();
}

Placement place_collapsed(const CollapseMesh& mesh, std::uint32_t v, std::uint32_t w) {
    ErrorQuadric q = mesh.vertices[v].quadric;
    q += mesh.vertices[w].quadric;
    const Vec3 &pv = mesh.vertices[v].position, &pw = mesh.vertices[w].position;
    const double length2 = squared_norm(pw - pv);
    Placement placed;
    placed.area = q.area;
    // A vertex that is more bound than the other keeps its place.
    constexpr std::uint8_t bound = vertex_border | vertex_locked;
    const int bv = mesh.vertices[v].flags & bound, bw = mesh.vertices[w].flags & bound;
    if (bv != bw || (bv & vertex_locked) != 0) {
        const std::uint32_t kept = bv > bw ? v : w;
        placed.position = mesh.vertices[kept].position;
        placed.source = mesh.vertices[kept].source;
    } else {
        const Vec3 middle = (pv + pw) * 0.5;
        placed.position = q.minimum_near(middle);
        if (!(squared_norm(placed.position - middle) <= 4 * length2)) placed.position = q(pv) <= q(pw) ? pv : pw;
    }
    placed.quadric_error = q(placed.position);
    placed.cost = placed.quadric_error + length_weight * q.area * length2;
    return placed;
}

std::size_t try_collapse(CollapseMesh& mesh, std::uint32_t v, std::uint32_t w, const Placement& placement,
                         bool keep_shape) {
    Star sv, sw;
    EdgeFaces edge;
    if (!sv.gather(mesh, v) || !sw.gather(mesh, w) || sv.size + sw.size > max_valence + 4) return 0;
    if (!gather_edge_faces(sv, w, edge) || !link_condition(mesh, v, w, sv, sw, edge)) return 0;
    if (!faces_follow(mesh, sv, w, mesh.vertices[v].position, placement.position, keep_shape) ||
        !faces_follow(mesh, sw, v, mesh.vertices[w].position, placement.position, keep_shape)) {
        return 0;
    }
    // A face that goes is stood for by the neighbour, across one of the two edges that become one, that it resembles.
    std::array<std::uint32_t, 2> heir{};
    for (std::size_t i = 0; i < edge.count; ++i) {
        const std::uint32_t left = face_across(sv, edge.face[i], edge.apex[i]);
        const std::uint32_t right = face_across(sw, edge.face[i], edge.apex[i]);
        if (left == none && right == none) return 0;
        heir[i] = left == none ? right : left;
        if (left != none && right != none) {
            const Vec3 n = mesh.area_vector(mesh.faces[edge.face[i]]);
            const Vec3 l = mesh.area_vector(mesh.faces[left]), r = mesh.area_vector(mesh.faces[right]);
            const double nl = dot(n, l), nr = dot(n, r);  // cosines compared by their squares, times those of lengths
            if (nr * std::abs(nr) * squared_norm(l) > nl * std::abs(nl) * squared_norm(r)) heir[i] = right;
        }
    }
    for (std::size_t i = 0; i < edge.count; ++i) {
        mesh.faces[edge.face[i]] = {none, heir[i], none};
        --mesh.vertices[edge.apex[i]].valence;
    }
    std::uint32_t* link = &mesh.first_corner[v];
    std::uint32_t count = 0;
    for (const Star* star : {&sv, &sw}) {
        for (std::size_t i = 0; i < star->size; ++i) {
            const std::uint32_t c = star->corner[i], f = corner_face(c);
            if (!mesh.alive(f)) continue;
            mesh.faces[f][c - 3 * f] = v;
            *link = c;
            link = &mesh.next_corner[c];
            ++count;
        }
    }
    *link = none;
    mesh.face_count -= edge.count;
    mesh.vertices[v].valence = count;
    mesh.vertices[v].position = placement.position;
    mesh.vertices[v].source = placement.source;
    mesh.vertices[v].quadric += mesh.vertices[w].quadric;
    mesh.vertices[v].flags |= mesh.vertices[w].flags;
    mesh.vertices[w].flags |= vertex_dead;
    return edge.count;
}

}  // namespace quadseg::simplify
