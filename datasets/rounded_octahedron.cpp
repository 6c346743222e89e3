// An octahedron offset by a radius (a ball rolled over it): planes, cylinders, spheres.
#include "datasets/shapes.h"
#include "datasets/surfaces.h"

#include <array>
#include <map>
#include <numbers>

namespace quadseg::datasets {
namespace {

/// Faces are numbered by the signs of their normals (bits x, y, z set where negative), corners by axis and sign.
class RoundedOctahedron {
  public:
    RoundedOctahedron(Builder& builder, double size, double radius)
        : builder_(builder),
          size_(size),
          radius_(radius),
          m_(builder.steps(size * std::numbers::sqrt2)),
          // Between the normals of neighbouring faces.
          k_(builder.rows(radius * std::acos(1.0 / 3), 2)) {}

    void build() {
        for (int face = 0; face < 8; ++face) add_face(face);
        for (int axis = 0; axis < 3; ++axis) {
            for (const bool negative : {false, true}) add_corner(axis, negative);
        }
        for (int a = 0; a < 3; ++a) {
            for (int signs = 0; signs < 4; ++signs) add_edge(a, (a + 1) % 3, (signs & 1) != 0, (signs & 2) != 0);
        }
    }

  private:
    struct CornerOfFace {
        int face;
        int axis;
        bool operator<(const CornerOfFace& b) const { return face != b.face ? face < b.face : axis < b.axis; }
    };

    static bool negative(int face, int axis) { return (face >> axis & 1) != 0; }
    static Vec3 normal(int face) {
        Vec3 n;
        for (int a = 0; a < 3; ++a) n[a] = (negative(face, a) ? -1 : 1) / std::numbers::sqrt3;
        return n;
    }
    Vec3 tip(int axis, bool minus) const {
        Vec3 p;
        p[axis] = minus ? -size_ : size_;
        return p;
    }
    std::uint32_t corner(int face, int axis) {
        const auto [it, fresh] = corners_.try_emplace({face, axis}, 0U);
        if (fresh) it->second = builder_.add_vertex(tip(axis, negative(face, axis)) + normal(face) * radius_);
        return it->second;
    }
    /// The line on a face from its corner on axis a to that on axis b, m + 1 vertices; a < b.
    const Loop& line(int face, int a, int b) {
        Loop& loop = lines_[{face, 3 * a + b}];
        if (loop.empty()) {
            loop.push_back(corner(face, a));
            const Vec3 p = tip(a, negative(face, a)) + normal(face) * radius_;
            const Vec3 q = tip(b, negative(face, b)) + normal(face) * radius_;
            for (std::uint32_t i = 1; i < m_; ++i) {
                loop.push_back(builder_.add_vertex(p + (q - p) * (static_cast<double>(i) / m_)));
            }
            loop.push_back(corner(face, b));
        }
        return loop;
    }
    /// The arc around the corner on `axis` from face f to its neighbour g, k + 1 vertices; f < g.
    const Loop& arc(int f, int g, int axis) {
        Loop& loop = arcs_[{8 * f + g, axis}];
        if (loop.empty()) {
            loop.push_back(corner(f, axis));
            for (std::uint32_t i = 1; i < k_; ++i) {
                loop.push_back(
                    builder_.add_vertex(tip(axis, negative(f, axis)) +
                                        between(normal(f), normal(g), static_cast<double>(i) / k_) * radius_));
            }
            loop.push_back(corner(g, axis));
        }
        return loop;
    }
    static Vec3 between(const Vec3& a, const Vec3& b, double t) {
        const double angle = angle_between(a, b);
        return (a * std::sin((1 - t) * angle) + b * std::sin(t * angle)) / std::sin(angle);
    }
    void oriented_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, const Vec3& outer, std::int32_t surface) {
        const Vec3 pa = builder_.position(a);
        const bool outwards = dot(cross(builder_.position(b) - pa, builder_.position(c) - pa), outer) >= 0;
        builder_.add_triangle(a, outwards ? b : c, outwards ? c : b, surface);
    }

    void add_face(int face) {
        const Vec3 n = normal(face);
        const Vec3 x = any_perpendicular(n);
        const std::int32_t surface =
            builder_.add_surface(plane({tip(0, negative(face, 0)) + n * radius_, x, cross(n, x), n}));
        // Rows parallel to the line between the corners on x and y, up to the corner on z.
        Loop previous = line(face, 0, 1);
        for (std::uint32_t row = 1; row <= m_; ++row) {
            Loop current(m_ - row + 1);
            current.front() = line(face, 0, 2)[row];
            current.back() = line(face, 1, 2)[row];
            for (std::uint32_t i = 1; i + 1 < current.size(); ++i) {
                const double w2 = static_cast<double>(row) / m_;
                const double w1 = static_cast<double>(i) / m_;
                current[i] =
                    builder_.add_vertex(tip(0, negative(face, 0)) * (1 - w1 - w2) + tip(1, negative(face, 1)) * w1 +
                                        tip(2, negative(face, 2)) * w2 + n * radius_);
            }
            for (std::uint32_t i = 0; i + 1 < previous.size(); ++i) {
                oriented_triangle(previous[i], previous[i + 1], current[i], n, surface);
                if (i + 1 < current.size()) oriented_triangle(previous[i + 1], current[i + 1], current[i], n, surface);
            }
            previous = current;
        }
    }

    /// A patch of quads between four known sides: rows[j] from j = 0 to the last.
    void add_patch(const std::vector<Loop>& rows, const Vec3& outer, std::int32_t surface) {
        for (std::size_t j = 0; j + 1 < rows.size(); ++j) {
            for (std::size_t i = 0; i + 1 < rows[j].size(); ++i) {
                oriented_triangle(rows[j][i], rows[j][i + 1], rows[j + 1][i + 1], outer, surface);
                oriented_triangle(rows[j][i], rows[j + 1][i + 1], rows[j + 1][i], outer, surface);
            }
        }
    }

    /// The edge between the corners on axes a and b; its two faces differ in the sign of the third axis.
    void add_edge(int a, int b, bool minus_a, bool minus_b) {
        const int c = 3 - a - b;
        const int f = (minus_a ? 1 << a : 0) | (minus_b ? 1 << b : 0);
        const int g = f | 1 << c;
        if (a > b) std::swap(a, b);
        const Vec3 p = tip(a, negative(f, a));
        const Vec3 q = tip(b, negative(f, b));
        const Vec3 axis = normalized(q - p);
        const Vec3 x = any_perpendicular(axis);
        const std::int32_t surface = builder_.add_surface(cylinder({p, x, cross(axis, x), axis}, radius_, true));
        std::vector<Loop> rows{line(f, a, b)};
        for (std::uint32_t j = 1; j < k_; ++j) {
            Loop row{arc(f, g, a)[j]};
            const Vec3 n = between(normal(f), normal(g), static_cast<double>(j) / k_) * radius_;
            for (std::uint32_t i = 1; i < m_; ++i)
                row.push_back(builder_.add_vertex(p + (q - p) * (static_cast<double>(i) / m_) + n));
            row.push_back(arc(f, g, b)[j]);
            rows.push_back(row);
        }
        rows.push_back(line(g, a, b));
        add_patch(rows, p + q, surface);
    }

    /// Four faces meet at a corner: f, f|u, f|u|v, f|v with u, v the bits of the other axes.
    void add_corner(int axis, bool minus) {
        const int f = minus ? 1 << axis : 0;
        const int u = 1 << (axis + 1) % 3;
        const int v = 1 << (axis + 2) % 3;
        const Vec3 centre = tip(axis, minus);
        const std::int32_t surface = builder_.add_surface(sphere(Frame{centre}, radius_, true));
        std::vector<Loop> rows{arc(f, f | u, axis)};
        for (std::uint32_t j = 1; j < k_; ++j) {
            const double t = static_cast<double>(j) / k_;
            Loop row{arc(f, f | v, axis)[j]};
            const Vec3 left = between(normal(f), normal(f | v), t);
            const Vec3 right = between(normal(f | u), normal(f | u | v), t);
            for (std::uint32_t i = 1; i < k_; ++i) {
                row.push_back(builder_.add_vertex(
                    centre + normalized(between(left, right, static_cast<double>(i) / k_)) * radius_));
            }
            row.push_back(arc(f | u, f | u | v, axis)[j]);
            rows.push_back(row);
        }
        rows.push_back(arc(f | v, f | u | v, axis));
        add_patch(rows, centre, surface);
    }

    Builder& builder_;
    double size_, radius_;
    std::uint32_t m_, k_;
    std::map<CornerOfFace, std::uint32_t> corners_;
    std::map<std::pair<int, int>, Loop> lines_, arcs_;
};

}  // namespace

void make_rounded_octahedron(Builder& builder, Pcg random) {
    // Drawn one by one: compilers evaluate the arguments of a call in different orders.
    const double radius = random.uniform(3, 6), size = random.uniform(18, 22);
    RoundedOctahedron(builder, size, radius).build();
}

}  // namespace quadseg::datasets
