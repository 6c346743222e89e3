// A block all of whose edges are rounded by a rolling ball: planes, quarter cylinders, eighths of a sphere.
#include "datasets/shapes.h"
#include "datasets/surfaces.h"

#include <array>
#include <numbers>

namespace quadseg::datasets {
namespace {

/// One axis of the lattice: m steps of rounding (half of an edge), the flat part, m steps of rounding.
struct Axis {
    double half = 1;  ///< of the flat part
    std::uint32_t m = 1, flat = 1;
    std::uint32_t size() const { return 2 * m + flat; }
    /// −1, 0, 1: which part the step after k belongs to.
    int part(std::uint32_t k) const { return k < m ? -1 : k < m + flat ? 0 : 1; }
    /// Position in the flat part, and how far the rounding has turned, −1 … 1 of 45 degrees.
    std::pair<double, double> at(double k) const {
        if (k <= m) return {-half, (k - m) / m};
        if (k >= m + flat) return {half, (k - m - flat) / m};
        return {-half + 2 * half * (k - m) / flat, 0};
    }
};

class RoundedBlock {
  public:
    RoundedBlock(Builder& builder, const Vec3& half, double radius) : builder_(builder), radius_(radius) {
        const std::uint32_t m = builder.rows(radius * std::numbers::pi / 4, 2);
        for (int a = 0; a < 3; ++a) {
            axes_[static_cast<std::size_t>(a)] = {half[a], m, builder.steps(2 * half[a])};
        }
        surfaces_.fill(-1);
    }

    void build() {
        const std::uint32_t nx = axes_[0].size();
        const std::uint32_t ny = axes_[1].size();
        const std::uint32_t nz = axes_[2].size();
        const std::size_t perimeter = 2 * (nx + ny);
        // Loops around z, from the lower left corner.
        const auto lattice = [&](double s) -> std::array<double, 2> {
            if (s < 0) s += static_cast<double>(perimeter);
            if (s <= nx) return {s, 0};
            if (s <= nx + ny) return {static_cast<double>(nx), s - nx};
            if (s <= 2 * nx + ny) return {2 * nx + ny - s, static_cast<double>(ny)};
            return {0, static_cast<double>(perimeter) - s};
        };
        const auto side_point = [&](double s, double k) {
            const auto [i, j] = lattice(s);
            return point({i, j, k});
        };
        const Loop top = builder_.add_loop(perimeter, [&](double s) { return side_point(s, nz); });
        const auto cap = [&](const Loop& loop, bool flipped) {
            builder_.cap(
                loop, nx,
                [&](double u, double v) {
                    return point({(u + 1) / 2 * nx, (flipped ? 1 - v : v + 1) / 2 * ny, flipped ? 0.0 : nz});
                },
                [&](std::size_t i, std::size_t j) {
                    const std::size_t row = flipped ? ny - 1 - j : j;
                    return surface(axes_[0].part(static_cast<std::uint32_t>(i)),
                                   axes_[1].part(static_cast<std::uint32_t>(row)), flipped ? -1 : 1);
                },
                false);
        };
        cap(top, false);
        Loop upper = top;
        for (std::uint32_t k = nz; k > 0; --k) {
            const Loop lower = builder_.add_loop(perimeter, [&](double s) { return side_point(s, k - 1.0); });
            builder_.ring(
                upper, lower, 1, [](double, double) { return Vec3{}; },
                [&](std::size_t c) {
                    const int z = axes_[2].part(k - 1);
                    const auto column = static_cast<std::uint32_t>(c);
                    if (column < nx) return surface(axes_[0].part(column), -1, z);
                    if (column < nx + ny) return surface(1, axes_[1].part(column - nx), z);
                    if (column < 2 * nx + ny) return surface(axes_[0].part(2 * nx + ny - 1 - column), 1, z);
                    return surface(-1, axes_[1].part(static_cast<std::uint32_t>(perimeter) - 1 - column), z);
                });
            upper = lower;
        }
        Loop below(perimeter);
        for (std::size_t i = 0; i < perimeter; ++i) {
            below[i] = upper[(2 * nx + ny + perimeter - i) % perimeter];
        }
        cap(below, true);
    }

  private:
    /// The lattice's faces lie at its ends, where the direction is a full axis; off them the ball's surface turns.
    Vec3 point(const std::array<double, 3>& lattice) const {
        Vec3 core;
        Vec3 turn;
        for (int a = 0; a < 3; ++a) {
            const auto i = static_cast<std::size_t>(a);
            const auto [position, angle] = axes_[i].at(lattice[i]);
            core[a] = position;
            turn[a] = std::tan(angle * std::numbers::pi / 4);
        }
        return core + normalized(turn) * radius_;
    }
    /// By the signs of the outer normal's axes: one is a face, two an edge, three a corner.
    std::int32_t surface(int x, int y, int z) {
        std::int32_t& id = surfaces_[static_cast<std::size_t>((x + 1) * 9 + (y + 1) * 3 + z + 1)];
        if (id >= 0) return id;
        const Vec3 sign{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
        Vec3 core;
        for (int a = 0; a < 3; ++a) core[a] = sign[a] * axes_[static_cast<std::size_t>(a)].half;
        const int turned = std::abs(x) + std::abs(y) + std::abs(z);
        Frame frame{core};
        if (turned == 3) {
            id = builder_.add_surface(sphere(frame, radius_, true));
            return id;
        }
        // A face's normal, an edge's direction.
        Vec3 axis = sign;
        if (turned == 2) axis = {x == 0 ? 1.0 : 0.0, y == 0 ? 1.0 : 0.0, z == 0 ? 1.0 : 0.0};
        frame.x = any_perpendicular(axis);
        frame.y = cross(axis, frame.x);
        frame.z = axis;
        if (turned == 1) {
            frame.origin += sign * radius_;
            id = builder_.add_surface(plane(frame));
        } else {
            id = builder_.add_surface(cylinder(frame, radius_, true));
        }
        return id;
    }

    Builder& builder_;
    double radius_;
    std::array<Axis, 3> axes_;
    std::array<std::int32_t, 27> surfaces_{};
};

}  // namespace

void make_fillets(Builder& builder, Pcg random) {
    const Vec3 half{random.uniform(14, 18), random.uniform(9, 12), random.uniform(5, 8)};
    RoundedBlock block(builder, half, random.uniform(2.5, 4));
    block.build();
}

}  // namespace quadseg::datasets
