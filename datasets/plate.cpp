// A plate with holes, counterbores, countersinks, bosses, cones, domes and tangent fillets.
#include "datasets/body.h"
#include "datasets/shapes.h"
#include "datasets/turning.h"

#include <algorithm>
#include <cmath>

namespace quadseg::datasets {
namespace {

constexpr double cell = 10;
constexpr std::uint32_t columns = 4;
constexpr std::uint32_t rows = 3;

/// A hole is begun from below; its lower edge waits here for the feature above.
struct ThroughHoles {
    std::vector<Loop> edges = std::vector<Loop>(std::size_t{columns} * rows);
    std::vector<Feature> top = std::vector<Feature>(edges.size());
    std::vector<Feature> bottom = std::vector<Feature>(edges.size());

    /// `finish` continues the chain from the lower edge (radius r, z = −height) to the top face.
    template <class Finish>
    void add(std::size_t where, double r, double height, const Finish& finish) {
        bottom[where] = [this, where, r](Builder& builder, const Frame& frame, std::uint32_t count, std::int32_t) {
            Turning edge(builder, frame, count);
            edge.start(r, 0);
            edges[where] = mirrored(edge.loop());
            return edge.loop();
        };
        top[where] = [this, where, r, height, finish](Builder& builder, const Frame& frame, std::uint32_t count,
                                                      std::int32_t) {
            Turning hole(builder, frame, count);
            hole.start(r, -height, edges[where]);
            finish(hole);
            return hole.loop();
        };
    }
};

template <class Chain>
Feature turned(const Chain& chain) {
    return [chain](Builder& builder, const Frame& frame, std::uint32_t count, std::int32_t) {
        Turning turning(builder, frame, count);
        chain(turning);
        return turning.loop();
    };
}

Feature ellipsoid_bump(double a, double b, double c) {
    return [=](Builder& builder, const Frame& frame, std::uint32_t count, std::int32_t) {
        // The centre lies below the face, so that the edge is a crease.
        const double sink = 0.35 * c;
        const Frame centre = frame.moved({0, 0, -sink});
        const Surface surface =
            general(SurfaceType::ellipsoid, centre, {{1 / (a * a), 1 / (b * b), 1 / (c * c)}, {}, -1}, {a, b, c},
                    {0, 0, c}, {0, 0, 1});
        const double rim = std::sqrt(1 - sink * sink / (c * c));
        Turning bump(builder, frame, count, a, b);
        const double polar = std::asin(rim);
        bump.dome([=](double rho) { return std::sin(rho * polar); },
                  [=](double rho) { return -sink + c * std::cos(rho * polar); }, builder.add_surface(surface));
        return bump.loop();
    };
}

}  // namespace

void make_plate(Builder& builder, Pcg random) {
    const auto vary = [&](double value) { return value * random.uniform(0.9, 1.1); };
    BodyShape shape;
    shape.cell = cell;
    shape.nx = columns;
    shape.ny = rows;
    shape.height = vary(8);
    shape.corner_radius = vary(4);
    shape.fillet = vary(1.2);
    shape.chamfer = vary(0.8);
    const double height = shape.height;

    ThroughHoles holes;
    const auto at = [](std::size_t column, std::size_t row) { return column + columns * row; };

    const double bore = vary(1.5);
    const double wide = vary(2.6);
    const double depth = vary(3);
    for (const std::size_t where : {at(0, 0), at(3, 2)}) {  // counterbores
        holes.add(where, bore, height, [=](Turning& t) {
            t.line_to(bore, -depth);
            t.line_to(wide, -depth);
            t.line_to(wide, 0);
        });
    }
    const double sunk = vary(1.4);
    const double head = vary(2.6);
    for (const std::size_t where : {at(3, 0), at(0, 2)}) {  // countersinks
        holes.add(where, sunk, height, [=](Turning& t) {
            t.line_to(sunk, -(head - sunk));
            t.line_to(head, 0);
        });
    }
    const double plain = vary(2.6);
    holes.add(at(1, 1), plain, height, [=](Turning& t) { t.line_to(plain, 0); });

    const double boss = vary(2.2);
    const double rise = vary(6);
    const double foot = vary(1.2);
    holes.top[at(2, 1)] = turned([=](Turning& t) {  // boss with a rounded top edge and a fillet at its foot
        const double edge = 0.5 * foot;
        t.disc(boss - edge, rise);
        t.arc_to(boss, rise - edge, boss - edge, rise - edge);
        t.line_to(boss, foot);
        t.arc_to(boss + foot, 0, boss + foot, foot);
    });
    const double frustum = vary(3.2);
    const double frustum_top = vary(1.6);
    const double frustum_rise = vary(4);
    holes.top[at(1, 0)] = turned([=](Turning& t) {
        t.disc(frustum_top, frustum_rise);
        t.line_to(frustum, 0);
    });
    const double dome = vary(3.6);
    const double dome_edge = std::min(vary(3), dome);  // at most half a sphere
    holes.top[at(2, 0)] = turned(
        [=](Turning& t) { t.sphere_cap(dome_edge, -std::sqrt(dome * dome - dome_edge * dome_edge), dome, true); });
    // Drawn one by one: compilers evaluate the arguments of a call in different orders.
    const double c = vary(2.6), b = vary(2.3), a = vary(3.4);
    holes.top[at(1, 2)] = ellipsoid_bump(a, b, c);
    const double pin = vary(1.9);
    const double pin_rise = vary(3);
    holes.top[at(2, 2)] = turned([=](Turning& t) {  // pin with a spherical end
        t.sphere_cap(pin, pin_rise, pin, true);
        t.line_to(pin, 0);
    });
    const double pocket = vary(2.4);
    const double pocket_depth = vary(3);
    holes.top[at(0, 1)] = turned([=](Turning& t) {  // blind hole with a rounded floor
        const double q = 0.3 * pocket;
        t.disc(pocket - q, -pocket_depth);
        t.arc_to(pocket, -pocket_depth + q, pocket - q, -pocket_depth + q);
        t.line_to(pocket, 0);
    });
    const double drill = vary(1.7);
    holes.top[at(3, 1)] = turned([=](Turning& t) {  // drilled blind hole
        t.cone_tip(drill, -0.45 * height, -0.45 * height - 0.6 * drill);
        t.line_to(drill, 0);
    });
    // √(1 + 0.6²), written out: gcc rounds a constant std::hypot otherwise than the library that others call does.
    constexpr double slant = 1.1661903789690602;
    const double dimple = vary(2);
    for (const std::size_t where : {at(1, 2), at(2, 0)}) {  // spherical dimples below
        holes.bottom[where] = turned([=](Turning& t) { t.sphere_cap(dimple, 0.6 * dimple, -slant * dimple, false); });
    }
    build_body(builder, shape, holes.top, holes.bottom);
}

}  // namespace quadseg::datasets
