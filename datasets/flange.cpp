// A flange: a disc with a circle of bolt holes, a conical hub with a fillet, a bore.
#include "datasets/shapes.h"
#include "datasets/turning.h"

namespace quadseg::datasets {
namespace {

/// An annulus in the plane z = 0 of a frame, cut into sectors with a hole in each. Loops run counter-clockwise and
/// start at angle 0 of the frame; every sector has n steps along each of its four sides.
struct HoledAnnulus {
    Frame frame;
    std::uint32_t sectors, n;
    double hole_circle, hole;
    std::int32_t surface;
};

/// Returns the edges of the holes, each a loop that starts at the sector's inner corner of the smaller angle.
std::vector<Loop> build_annulus(Builder& builder, const HoledAnnulus& annulus, const Loop& inner, const Loop& outer,
                                const std::vector<Loop>& given_holes) {
    const std::size_t n = annulus.n;
    std::vector<Loop> spokes(annulus.sectors, Loop(n + 1));
    for (std::size_t k = 0; k < annulus.sectors; ++k) {
        Loop& spoke = spokes[k];
        spoke[0] = inner[k * n];
        spoke[n] = outer[k * n];
        const Vec3 p = builder.position(spoke[0]);
        const Vec3 q = builder.position(spoke[n]);
        for (std::size_t i = 1; i < n; ++i) {
            spoke[i] = builder.add_vertex(p + (q - p) * (static_cast<double>(i) / static_cast<double>(n)));
        }
    }
    std::vector<Loop> holes;
    for (std::size_t k = 0; k < annulus.sectors; ++k) {
        const Loop& right = spokes[k];
        const Loop& left = spokes[(k + 1) % annulus.sectors];
        // Around the sector: out along the right spoke, along the rim, back along the left spoke, along the hub.
        Loop path;
        for (std::size_t i = 0; i < n; ++i) path.push_back(right[i]);
        for (std::size_t i = 0; i < n; ++i) path.push_back(outer[k * n + i]);
        for (std::size_t i = 0; i < n; ++i) path.push_back(left[n - i]);
        for (std::size_t i = 0; i < n; ++i) path.push_back(inner[((k + 1) * n - i) % inner.size()]);
        const double middle = 2 * std::numbers::pi * (static_cast<double>(k) + 0.5) / annulus.sectors;
        const Vec3 direction = annulus.frame.x * std::cos(middle) + annulus.frame.y * std::sin(middle);
        Frame at_hole{annulus.frame.origin + direction * annulus.hole_circle, direction,
                      cross(annulus.frame.z, direction), annulus.frame.z};
        Turning edge(builder, at_hole, static_cast<std::uint32_t>(4 * n));
        if (given_holes.empty()) {
            edge.start(annulus.hole, 0);
        } else {
            edge.start(annulus.hole, 0, given_holes[k]);
        }
        holes.push_back(edge.loop());
        builder.flat_ring(edge.loop(), path, builder.rows(0.8 * annulus.hole), annulus.surface);
    }
    return holes;
}

}  // namespace

void make_flange(Builder& builder, Pcg random) {
    const auto vary = [&](double value) { return value * random.uniform(0.93, 1.07); };
    const std::uint32_t sectors = 6 + 2 * random.below(2);
    const double bore = vary(9);
    const double neck = vary(13);
    const double foot = vary(15.5);
    const double fillet = vary(2.5);
    const double hub = foot + fillet;
    const double rim = vary(38);
    const double thickness = vary(7);
    const double rise = vary(22);
    const double chamfer = vary(1.2);
    const double circle = (hub + rim) / 2;
    const double hole = 0.26 * (rim - hub);

    const std::uint32_t n = builder.steps(2 * std::numbers::pi * circle / sectors, 2);
    const std::uint32_t count = sectors * n;
    // A loop of any length around the z axis, vertex 0 at angle 0.
    const auto point = [&](double s, double r, double z) {
        const double angle = 2 * std::numbers::pi * s / count;
        return Vec3{r * std::cos(angle), r * std::sin(angle), z};
    };
    const auto loop_at = [&](double r, double z) {
        return builder.add_loop(count, [&](double s) { return point(s, r, z); });
    };
    const auto ring_between = [&](const Loop& a, const Loop& b, double r0, double z0, double r1, double z1,
                                  const Surface& surface) {
        const std::int32_t id = builder.add_surface(surface);
        builder.ring(
            a, b, builder.rows(std::hypot(r1 - r0, z1 - z0)),
            [&](double s, double t) { return point(s, r0 + (r1 - r0) * t, z0 + (z1 - z0) * t); },
            [&](std::size_t) { return id; });
    };
    const Frame world{};
    const auto level = [&](double z) { return world.moved({0, 0, z}); };

    // The chain from the bore's lower edge up through the bore, over the hub, down to the disc.
    const Loop bore_low = loop_at(bore, 0);
    const Loop bore_high = loop_at(bore, rise);
    ring_between(bore_low, bore_high, bore, 0, bore, rise, cylinder(world, bore, false));
    const Loop lip = loop_at(neck - chamfer, rise);
    ring_between(bore_high, lip, bore, rise, neck - chamfer, rise, plane(level(rise)));
    const Loop neck_top = loop_at(neck, rise - chamfer);
    const double slope = 1;  // the chamfer's: 45 degrees
    ring_between(lip, neck_top, neck - chamfer, rise, neck, rise - chamfer,
                 cone(level(rise - chamfer + neck / slope).flipped(), std::numbers::pi / 4, true));
    // The hub is a cone whose foot is tangent to the fillet: find the arc from its direction.
    const double lean = std::atan2(foot - neck, rise - chamfer - thickness - fillet);
    const double centre_r = hub;
    const double centre_z = thickness + fillet;
    const double start_r = centre_r - fillet * std::cos(lean);
    const double start_z = centre_z - fillet * std::sin(lean);
    const Loop foot_top = loop_at(start_r, start_z);
    // The line from the neck to the arc's start gives the cone its exact angle.
    const double dr = start_r - neck;
    const double dz = rise - chamfer - start_z;
    const double apex = rise - chamfer + neck * dz / dr;
    ring_between(neck_top, foot_top, neck, rise - chamfer, start_r, start_z,
                 cone(level(apex).flipped(), std::atan2(dr, dz), true));
    const Loop hub_loop = loop_at(hub, thickness);
    const std::int32_t fillet_surface = builder.add_surface(torus(level(centre_z), centre_r, fillet, false));
    const double from = std::numbers::pi + lean;
    const double turn = std::numbers::pi / 2 - lean;
    builder.ring(
        foot_top, hub_loop, builder.rows(fillet * turn, 3),
        [&](double s, double t) {
            const double angle = from + turn * t;
            return point(s, centre_r + fillet * std::cos(angle), centre_z + fillet * std::sin(angle));
        },
        [&](std::size_t) { return fillet_surface; });

    // The bottom is seen from below: loops run the other way round, still from angle 0.
    const auto from_below = [&](const Loop& loop) {
        Loop result(loop.size());
        for (std::size_t i = 0; i < loop.size(); ++i) result[i] = loop[(loop.size() - i) % loop.size()];
        return result;
    };
    const Loop rim_top = loop_at(rim, thickness);
    const Loop rim_chamfer = loop_at(rim, chamfer);
    const Loop rim_low = loop_at(rim - chamfer, 0);
    const Frame below = world.flipped();
    const auto low_holes = build_annulus(builder, {below, sectors, n, circle, hole, builder.add_surface(plane(below))},
                                         from_below(bore_low), from_below(rim_low), {});
    // Sector k from above is sector −1 − k from below, and its hole's edge runs the other way round.
    std::vector<Loop> high_holes;
    for (std::uint32_t k = 0; k < sectors; ++k) {
        const Loop edge = mirrored(low_holes[sectors - 1 - k]);
        const double middle = 2 * std::numbers::pi * (k + 0.5) / sectors;
        const Vec3 direction{std::cos(middle), std::sin(middle), 0};
        const Frame at_hole{direction * circle, direction, cross({0, 0, 1}, direction), {0, 0, 1}};
        Turning wall(builder, at_hole, 4 * n);
        wall.start(hole, 0, edge);
        wall.line_to(hole, thickness);
        high_holes.push_back(wall.loop());
    }
    build_annulus(builder, {level(thickness), sectors, n, circle, hole, builder.add_surface(plane(level(thickness)))},
                  hub_loop, rim_top, high_holes);
    ring_between(rim_top, rim_chamfer, rim, thickness, rim, chamfer, cylinder(world, rim, true));
    ring_between(rim_chamfer, rim_low, rim, chamfer, rim - chamfer, 0,
                 cone(level(chamfer - rim), std::numbers::pi / 4, true));
}

}  // namespace quadseg::datasets
