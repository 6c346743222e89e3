#include "datasets/body.h"

#include "datasets/turning.h"

#include <array>

namespace quadseg::datasets {
namespace {

constexpr double pi = std::numbers::pi;

/// The outline as a rectangle of arc centres plus a turning offset, so that any inset of it is exact. Vertex 0 is the
/// middle of the lower left corner.
class Outline {
  public:
    Outline(const BodyShape& shape, std::uint32_t n) : radius_(shape.corner_radius) {
        const double half_arc = radius_ * pi / 4;
        const double straight = shape.cell - radius_;
        const auto arc_steps =
            std::clamp(static_cast<std::uint32_t>(std::lround(n * half_arc / (half_arc + straight))), 1U, n - 1);
        const double width = shape.cell * shape.nx;
        const double depth = shape.cell * shape.ny;
        const std::array<Vec3, 5> corner{Vec3{radius_, radius_, 0}, Vec3{width - radius_, radius_, 0},
                                         Vec3{width - radius_, depth - radius_, 0}, Vec3{radius_, depth - radius_, 0},
                                         Vec3{radius_, radius_, 0}};
        for (std::uint32_t side = 0; side < 4; ++side) {
            const double middle = pi * (1.5 + 0.5 * side);
            const std::uint32_t cells = side % 2 == 0 ? shape.nx : shape.ny;
            const std::uint32_t steps = cells * n;
            const double length = cells * shape.cell - 2 * radius_;
            for (std::uint32_t k = 0; k < steps; ++k) {
                double along = 0;
                double turn = 0;
                if (k < arc_steps) {
                    turn = -pi / 4 * (1 - static_cast<double>(k) / arc_steps);
                } else if (k <= n) {
                    along = straight * (k - arc_steps) / (n - arc_steps);
                } else if (k < steps - n) {
                    along = shape.cell * k / n - radius_;
                } else if (k <= steps - arc_steps) {
                    along = length - straight * (steps - arc_steps - k) / (n - arc_steps);
                } else {
                    along = length;
                    turn = pi / 4 * (1 - static_cast<double>(steps - k) / arc_steps);
                }
                const Vec3 direction = normalized(corner[side + 1] - corner[side]);
                core_.push_back(corner[side] + direction * along);
                angle_.push_back(middle + turn);
                piece_.push_back(k < arc_steps ? 2 * side : k < steps - arc_steps ? 2 * side + 1 : (2 * side + 2) % 8);
            }
        }
        core_.push_back(core_.front());
        angle_.push_back(angle_.front() + 2 * pi);
    }

    std::size_t size() const { return piece_.size(); }
    Vec3 at(double s, double inset, double z) const {
        const auto count = static_cast<double>(size());
        if (s < 0) s += count;
        const double whole = std::min(std::floor(s), count - 1);
        const auto i = static_cast<std::size_t>(whole);
        const double t = s - whole;
        const Vec3 b = core_[i] + (core_[i + 1] - core_[i]) * t;
        const double angle = angle_[i] + (angle_[i + 1] - angle_[i]) * t;
        const double out = radius_ - inset;
        return {b.x + out * exact_cos(angle), b.y + out * exact_sin(angle), z};
    }
    /// 0, 2, 4, 6: corners from the lower left; 1, 3, 5, 7: sides from the lower one.
    std::uint32_t piece(std::size_t column) const { return piece_[column]; }
    Loop loop(Builder& builder, double inset, double z) const {
        return builder.add_loop(size(), [&](double s) { return at(s, inset, z); });
    }
    Vec3 corner(std::uint32_t piece) const { return core_[first(piece)]; }
    Vec3 normal(std::uint32_t piece) const {
        const double angle = pi * (1.5 + 0.5 * (piece / 2));
        return {exact_cos(angle), exact_sin(angle), 0};
    }

  private:
    // Sides must not tilt by the rounding of cos(π/2).
    static double exact_cos(double a) {
        const double c = std::cos(a);
        return std::abs(c) < 1e-15 ? 0 : c;
    }
    static double exact_sin(double a) {
        const double s = std::sin(a);
        return std::abs(s) < 1e-15 ? 0 : s;
    }
    std::size_t first(std::uint32_t piece) const {
        if (piece == 0) return 0;
        return static_cast<std::size_t>(std::find(piece_.begin(), piece_.end(), piece) - piece_.begin());
    }

    double radius_;
    std::vector<Vec3> core_;
    std::vector<double> angle_;
    std::vector<std::uint32_t> piece_;
};

struct Face {
    Frame frame;  ///< z up is outside
    std::uint32_t nx, ny, n;
    double cell;
    std::int32_t surface;
};

void build_face(Builder& builder, const Face& face, const Loop& outline, const std::vector<Feature>& features,
                bool flipped) {
    const std::size_t n = face.n;
    const std::size_t nx = face.nx;
    const std::size_t ny = face.ny;
    // Vertices along the lines of the lattice of cells.
    std::vector<Loop> rows(ny + 1, Loop(nx * n + 1));
    std::vector<Loop> columns(nx + 1, Loop(ny * n + 1));
    for (std::size_t k = 0; k <= nx * n; ++k) {
        rows[0][k] = outline[k];
        rows[ny][k] = outline[(2 * nx + ny) * n - k];
    }
    for (std::size_t k = 0; k <= ny * n; ++k) {
        columns[nx][k] = outline[nx * n + k];
        columns[0][k] = outline[((2 * nx + 2 * ny) * n - k) % outline.size()];
    }
    const auto between = [&](std::uint32_t a, std::uint32_t b, std::size_t k) {
        const Vec3 p = builder.position(a);
        return builder.add_vertex(p + (builder.position(b) - p) * (static_cast<double>(k) / static_cast<double>(n)));
    };
    for (std::size_t j = 1; j < ny; ++j) {
        rows[j][0] = columns[0][j * n];
        rows[j][nx * n] = columns[nx][j * n];
        for (std::size_t i = 1; i < nx; ++i) {
            rows[j][i * n] = builder.add_vertex(
                face.frame.at(face.cell * static_cast<double>(i), face.cell * static_cast<double>(j), 0));
        }
        for (std::size_t k = 0; k < nx * n; ++k) {
            if (k % n != 0) rows[j][k] = between(rows[j][k - k % n], rows[j][k - k % n + n], k % n);
        }
    }
    for (std::size_t i = 1; i < nx; ++i) {
        for (std::size_t j = 0; j <= ny; ++j) columns[i][j * n] = rows[j][i * n];
        for (std::size_t k = 0; k < ny * n; ++k) {
            if (k % n != 0) columns[i][k] = between(columns[i][k - k % n], columns[i][k - k % n + n], k % n);
        }
    }
    const auto count = static_cast<std::uint32_t>(4 * n);
    for (std::size_t j = 0; j < ny; ++j) {
        for (std::size_t i = 0; i < nx; ++i) {
            const Frame centre = face.frame.moved(
                {face.cell * (static_cast<double>(i) + 0.5), face.cell * (static_cast<double>(j) + 0.5), 0});
            const std::size_t index = i + nx * (flipped ? ny - 1 - j : j);
            Loop inner;
            if (index < features.size() && features[index]) {
                inner = features[index](builder, centre, count, face.surface);
            } else {
                Turning flat(builder, centre, count);
                flat.disc(0.3 * face.cell, 0, face.surface);
                inner = flat.loop();
            }
            Loop path;
            for (std::size_t k = 0; k < n; ++k) path.push_back(rows[j][i * n + k]);
            for (std::size_t k = 0; k < n; ++k) path.push_back(columns[i + 1][j * n + k]);
            for (std::size_t k = 0; k < n; ++k) path.push_back(rows[j + 1][(i + 1) * n - k]);
            for (std::size_t k = 0; k < n; ++k) path.push_back(columns[i][(j + 1) * n - k]);
            // From a typical feature to the sides and corners of its cell.
            builder.flat_ring(inner, path, builder.rows(0.25 * face.cell), face.surface);
        }
    }
}

}  // namespace

void build_body(Builder& builder, const BodyShape& shape, const std::vector<Feature>& top,
                const std::vector<Feature>& bottom) {
    const std::uint32_t n = builder.steps(shape.cell, 2);
    const Outline outline(shape, n);
    const double z_top = shape.height;
    const double r = shape.corner_radius;

    std::array<std::int32_t, 8> surface{};
    const auto add_pieces = [&](const auto& side, const auto& corner) {
        for (std::uint32_t p = 0; p < 8; ++p) {
            surface[p] = builder.add_surface(p % 2 == 1 ? side(p) : corner(p));
        }
    };
    const auto side_frame = [&](std::uint32_t p, double inset, double z) {
        const Vec3 m = outline.normal(p);
        Vec3 origin = outline.corner(p) + m * (r - inset);
        origin.z = z;
        const Vec3 along = cross({0, 0, 1}, m);
        return Frame{origin, {0, 0, 1}, m, along};  // z along the side
    };
    const auto corner_frame = [&](std::uint32_t p, double z) {
        Frame frame;
        frame.origin = outline.corner(p);
        frame.origin.z = z;
        return frame;
    };
    const auto column_surface = [&](std::size_t i) { return surface[outline.piece(i)]; };

    Loop upper = outline.loop(builder, shape.fillet, z_top);
    const Loop top_loop = upper;
    if (shape.fillet > 0) {
        const double q = shape.fillet;
        add_pieces([&](std::uint32_t p) { return cylinder(side_frame(p, q, z_top - q), q, true); },
                   [&](std::uint32_t p) { return torus(corner_frame(p, z_top - q), r - q, q, true); });
        const Loop lower = outline.loop(builder, 0, z_top - q);
        builder.ring(
            upper, lower, builder.rows(q * pi / 2, 2),
            [&](double s, double t) {
                return outline.at(s, q - q * std::sin(t * pi / 2), z_top - q + q * std::cos(t * pi / 2));
            },
            column_surface);
        upper = lower;
    }
    {
        add_pieces(
            [&](std::uint32_t p) {
                const Frame f = side_frame(p, 0, 0);
                return plane({f.origin, f.z, {0, 0, 1}, f.y});
            },
            [&](std::uint32_t p) { return cylinder(corner_frame(p, 0), r, true); });
        const double z0 = z_top - shape.fillet;
        const double z1 = shape.chamfer;
        const Loop lower = outline.loop(builder, 0, z1);
        builder.ring(
            upper, lower, builder.rows(z0 - z1),
            [&](double s, double t) { return outline.at(s, 0, z0 + (z1 - z0) * t); }, column_surface);
        upper = lower;
    }
    if (shape.chamfer > 0) {
        const double c = shape.chamfer;
        add_pieces(
            [&](std::uint32_t p) {
                const Frame f = side_frame(p, 0, c);
                const Vec3 normal = normalized(f.y - Vec3{0, 0, 1});
                return plane({f.origin, f.z, cross(normal, f.z), normal});
            },
            [&](std::uint32_t p) { return cone(corner_frame(p, c - r), pi / 4, true); });
        const Loop lower = outline.loop(builder, c, 0);
        builder.ring(
            upper, lower, builder.rows(c * std::numbers::sqrt2),
            [&](double s, double t) { return outline.at(s, c * t, c * (1 - t)); }, column_surface);
        upper = lower;
    }

    // The bottom seen from below starts at the upper left corner and runs backwards.
    const std::size_t size = upper.size();
    const std::size_t start = std::size_t{n} * (2 * shape.nx + shape.ny);
    Loop bottom_loop(size);
    for (std::size_t k = 0; k < size; ++k) bottom_loop[k] = upper[(start + size - k) % size];
    const Frame below = Frame{{0, shape.cell * shape.ny, 0}}.flipped();
    const Face bottom_face{below, shape.nx, shape.ny, n, shape.cell, builder.add_surface(plane(below))};
    build_face(builder, bottom_face, bottom_loop, bottom, true);

    const Frame above{{0, 0, z_top}};
    const Face top_face{above, shape.nx, shape.ny, n, shape.cell, builder.add_surface(plane(above))};
    build_face(builder, top_face, top_loop, top, false);
}

}  // namespace quadseg::datasets
