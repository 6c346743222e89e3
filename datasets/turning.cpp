#include "datasets/turning.h"

namespace quadseg::datasets {

Loop mirrored(const Loop& loop) {
    const std::size_t n = loop.size();
    Loop result(n);
    for (std::size_t i = 0; i < n; ++i) result[i] = loop[(n + 3 * n / 4 - i) % n];
    return result;
}

// A square inside, a circle at the rim: better triangles than either alone.
Turning::Disc Turning::to_disc(double u, double v) {
    const double rho = std::max(std::abs(u), std::abs(v));
    if (rho == 0) return {0, 0};
    // Position on the square's boundary as an angle, uniform along each side as the loop's vertices are.
    const double quarter = std::numbers::pi / 4;
    double angle = 0;
    if (u == rho) {
        angle = quarter * v / rho;
    } else if (v == rho) {
        angle = quarter * (2 - u / rho);
    } else if (u == -rho) {
        angle = quarter * (4 - v / rho);
    } else {
        angle = quarter * (6 + u / rho);
    }
    const double round = rho * rho;
    const double inner = 0.78 * (1 - round);
    return {inner * u + round * rho * std::cos(angle), inner * v + round * rho * std::sin(angle)};
}

void Turning::start(double r, double z) {
    start(r, z, circle(r, z));
}

void Turning::start(double r, double z, const Loop& loop) {
    loop_ = loop;
    r_ = r;
    z_ = z;
}

void Turning::disc(double r, double z) {
    disc(r, z, builder_.add_surface(plane(frame_.moved({0, 0, z}))));
}

void Turning::disc(double r, double z, std::int32_t surface) {
    dome([r](double rho) { return r * rho; }, [z](double) { return z; }, surface);
}

std::int32_t Turning::sphere_cap(double r, double centre_z, double radius, bool convex) {
    const std::int32_t surface = builder_.add_surface(sphere(frame_.moved({0, 0, centre_z}), std::abs(radius), convex));
    // Equal steps of the polar angle, so that the triangles at the rim of a hemisphere are no longer than at its pole.
    const double polar = std::asin(std::min(1.0, r / std::abs(radius)));
    dome([=](double rho) { return rho == 1 ? r : std::abs(radius) * std::sin(rho * polar); },
         [=](double rho) { return centre_z + radius * std::cos(rho * polar); }, surface);
    return surface;
}

void Turning::cone_tip(double r, double z, double tip_z) {
    const Frame local = frame_.moved({0, 0, tip_z});
    const Frame opening = z > tip_z ? local : local.flipped();
    const std::int32_t surface = builder_.add_surface(cone(opening, std::atan2(r, std::abs(z - tip_z)), z < tip_z));
    dome([r](double rho) { return r * rho; }, [&](double rho) { return tip_z + (z - tip_z) * rho; }, surface);
}

void Turning::line_to(double r, double z, const Loop* end) {
    const double dr = r - r_;
    const double dz = z - z_;
    Surface surface;
    if (dz == 0) {
        const Frame local = frame_.moved({0, 0, z});
        surface = plane(dr > 0 ? local : local.flipped());
    } else if (dr == 0) {
        surface = cylinder(frame_, r, dz < 0);
    } else {
        const double apex = z_ - r_ * dz / dr;
        const Frame local = frame_.moved({0, 0, apex});
        const bool up = (z + z_) / 2 > apex;
        surface = cone(up ? local : local.flipped(), std::atan2(std::abs(dr), std::abs(dz)), dz < 0);
    }
    const double r0 = r_;
    const double z0 = z_;
    curve_to(
        r, z, [=](double t) { return r0 + dr * t; }, [=](double t) { return z0 + dz * t; }, std::hypot(dr, dz),
        builder_.add_surface(surface), 1, end);
}

std::int32_t Turning::arc_to(double r, double z, double centre_r, double centre_z, std::int32_t surface) {
    const double radius = std::hypot(r - centre_r, z - centre_z);
    const double from = std::atan2(z_ - centre_z, r_ - centre_r);
    const double turn = std::remainder(std::atan2(z - centre_z, r - centre_r) - from, 2 * std::numbers::pi);
    // Clockwise in the (r, z) half plane the outer normal points away from the centre.
    const bool convex = turn < 0;
    if (surface < 0) {
        const Frame local = frame_.moved({0, 0, centre_z});
        surface = builder_.add_surface(centre_r == 0 ? sphere(local, radius, convex)
                                                     : torus(local, centre_r, radius, convex));
    }
    curve_to(
        r, z, [=](double t) { return centre_r + radius * std::cos(from + turn * t); },
        [=](double t) { return centre_z + radius * std::sin(from + turn * t); }, radius * std::abs(turn), surface, 2);
    return surface;
}

}  // namespace quadseg::datasets
