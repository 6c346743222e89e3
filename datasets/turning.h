// Solids and features of revolution (also elliptic ones): a profile that is turned around the z axis of a frame.
#pragma once

#include "datasets/builder.h"
#include "datasets/surfaces.h"

#include <cmath>
#include <cstdint>
#include <numbers>

namespace quadseg::datasets {

/// The loop of 4n vertices as it is seen in Frame::flipped(), where it would start at the same local angle.
Loop mirrored(const Loop& loop);

/// A chain of rings from the axis outwards (see Builder). Every loop has `count` = 4n vertices and starts at −135°, the
/// lower left corner of the square cells in which features stand.
class Turning {
  public:
    /// scale_x, scale_y: of the radius, for elliptic shapes.
    Turning(Builder& builder, const Frame& frame, std::uint32_t count, double scale_x = 1, double scale_y = 1)
        : builder_(builder), frame_(frame), count_(count), scale_x_(scale_x), scale_y_(scale_y) {}

    const Loop& loop() const noexcept { return loop_; }

    /// Begins at an edge: a new loop, or a given one.
    void start(double r, double z);
    void start(double r, double z, const Loop& loop);
    /// Begins with a flat disc.
    void disc(double r, double z);
    void disc(double r, double z, std::int32_t surface);
    /// Begins with a cap over the axis: radius(ρ) and height(ρ), ρ from 0 on the axis to 1 at the edge.
    template <class Radius, class Height>
    void dome(const Radius& radius, const Height& height, std::int32_t surface) {
        start(radius(1.0), height(1.0));
        builder_.cap(
            loop_, count_ / 4,
            [&](double u, double v) {
                const auto [x, y] = to_disc(u, v);
                const double rho = std::hypot(x, y);
                const double stretch = rho > 0 ? radius(rho) / rho : 0;
                return frame_.at(stretch * scale_x_ * x, stretch * scale_y_ * y, height(rho));
            },
            [&](std::size_t, std::size_t) { return surface; });
    }
    /// Part of a sphere around (0, centre_z) on the axis, from its pole (above the centre if `radius` > 0) to the
    /// radius r. Returns its surface.
    std::int32_t sphere_cap(double r, double centre_z, double radius, bool convex);
    /// Begins with the tip of a cone.
    void cone_tip(double r, double z, double tip_z);

    /// A straight piece: plane, cylinder or cone. With `end`, the chain ends on that loop.
    void line_to(double r, double z, const Loop* end = nullptr);
    /// An arc around (centre_r, centre_z), the shorter way: torus, or sphere where the centre is on the axis.
    /// `surface`: continues that one. Returns its surface.
    std::int32_t arc_to(double r, double z, double centre_r, double centre_z, std::int32_t surface = -1);
    /// Any other piece: radius(t), height(t), t in 0 … 1.
    template <class Radius, class Height>
    void curve_to(double r, double z, const Radius& radius, const Height& height, double length, std::int32_t surface,
                  std::uint32_t minimum_rows = 1, const Loop* end = nullptr) {
        const Loop outer = end != nullptr ? *end : circle(r, z);
        builder_.ring(
            loop_, outer, builder_.rows(length, minimum_rows),
            [&](double s, double t) { return at(s, radius(t), height(t)); }, [&](std::size_t) { return surface; });
        loop_ = outer;
        r_ = r;
        z_ = z;
    }

  private:
    struct Disc {
        double x, y;
    };
    static Disc to_disc(double u, double v);
    Vec3 at(double s, double r, double z) const {
        const double angle = std::numbers::pi * (2 * s / count_ - 0.75);
        return frame_.at(r * scale_x_ * std::cos(angle), r * scale_y_ * std::sin(angle), z);
    }
    Loop circle(double r, double z) {
        return builder_.add_loop(count_, [&](double s) { return at(s, r, z); });
    }

    Builder& builder_;
    Frame frame_;
    std::uint32_t count_;
    double scale_x_, scale_y_;
    Loop loop_;
    double r_ = 0, z_ = 0;
};

}  // namespace quadseg::datasets
