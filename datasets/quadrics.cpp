// A plate that carries one example of every quadric.
#include "datasets/body.h"
#include "datasets/shapes.h"
#include "datasets/turning.h"

namespace quadseg::datasets {
namespace {

using Type = SurfaceType;

/// A square block, side 2a, whose top is the graph z = rise + p x² + q y².
Feature block(Type type, double a, double rise, double p, double q) {
    return [=](Builder& builder, const Frame& frame, std::uint32_t count, std::int32_t) {
        const auto height = [=](double x, double y) { return rise + p * x * x + q * y * y; };
        const std::uint32_t n = count / 4;
        const auto side = [=](double s) {
            if (s < 0) s += count;
            const double along = std::fmod(s, n) / n * 2 - 1;
            switch (static_cast<std::uint32_t>(s / n) % 4) {
                case 0:
                    return Vec3{a * along, -a, 0};
                case 1:
                    return Vec3{a, a * along, 0};
                case 2:
                    return Vec3{-a * along, a, 0};
                default:
                    return Vec3{-a, -a * along, 0};
            }
        };
        const auto edge = [&](double s) {
            const Vec3 b = side(s);
            return frame.at(b.x, b.y, height(b.x, b.y));
        };
        const Loop rim = builder.add_loop(count, edge);
        const Frame local = frame.moved({0, 0, rise});
        const std::int32_t top =
            builder.add_surface(general(type, local, {{p, q, 0}, {0, 0, -1}, 0}, {}, {0, 0, 0}, {0, 0, 1}));
        builder.cap(
            rim, n, [&](double u, double v) { return frame.at(a * u, a * v, height(a * u, a * v)); },
            [&](std::size_t, std::size_t) { return top; });
        const Loop foot = builder.add_loop(count, [&](double s) { return frame.at(side(s)); });
        const Vec3 normals[4] = {-frame.y, frame.x, frame.y, -frame.x};
        std::int32_t walls[4];
        for (int k = 0; k < 4; ++k) {
            const Vec3& m = normals[k];
            walls[k] = builder.add_surface(plane({frame.origin + m * a, cross(frame.z, m), frame.z, m}));
        }
        builder.ring(
            rim, foot, builder.rows(rise),
            [&](double s, double t) {
                const Vec3 b = side(s);
                return frame.at(b.x, b.y, height(b.x, b.y) * (1 - t));
            },
            [&](std::size_t i) { return walls[i / n]; });
        return foot;
    };
}

/// A cap over an ellipse with semi-axes a, b times radius(ρ), at height(ρ), on the given local quadric.
template <class Radius, class Height>
Feature cap(Type type, double a, double b, const DiagonalQuadric& quadric, double centre_z, const Vec3& semi_axes,
            const Radius& radius, const Height& height) {
    return [=](Builder& builder, const Frame& frame, std::uint32_t count, std::int32_t) {
        Turning turning(builder, frame, count, a, b);
        const Vec3 pole{0, 0, height(0.0) - centre_z};
        const Vec3 probe = type == Type::elliptic_cone ? Vec3{a, 0, -1} : pole;
        turning.dome(radius, height,
                     builder.add_surface(general(type, frame.moved({0, 0, centre_z}), quadric, semi_axes, probe,
                                                 type == Type::elliptic_cone ? Vec3{1, 0, a} : Vec3{0, 0, 1})));
        return turning.loop();
    };
}

/// A post with a flat top between two levels: radius(z)·(a, b).
template <class Radius>
Feature post(Type type, double a, double b, double rise, const DiagonalQuadric& quadric, double centre_z,
             const Vec3& semi_axes, const Radius& radius) {
    return [=](Builder& builder, const Frame& frame, std::uint32_t count, std::int32_t) {
        Turning turning(builder, frame, count, a, b);
        turning.disc(radius(rise), rise);
        const double x = a * radius(centre_z);
        const std::int32_t surface =
            builder.add_surface(general(type, frame.moved({0, 0, centre_z}), quadric, semi_axes, {x, 0, 0}, {1, 0, 0}));
        turning.curve_to(
            radius(0.0), 0, [=](double t) { return radius(rise * (1 - t)); }, [=](double t) { return rise * (1 - t); },
            rise, surface, 2);
        return turning.loop();
    };
}

}  // namespace

void make_quadrics(Builder& builder, Pcg random) {
    const auto vary = [&](double value) { return value * random.uniform(0.9, 1.1); };
    BodyShape shape;
    shape.cell = 10;
    shape.nx = 4;
    shape.ny = 3;
    shape.height = vary(5);
    shape.corner_radius = vary(4);
    shape.fillet = 0;
    shape.chamfer = 0;
    std::vector<Feature> top;

    {  // sphere and cone of revolution
        const double radius = vary(3.6);
        const double rim = vary(3);
        top.push_back([=](Builder& b, const Frame& frame, std::uint32_t count, std::int32_t) {
            Turning t(b, frame, count);
            const double centre = std::sqrt(radius * radius - rim * rim);
            t.arc_to(rim, 0, 0, centre, t.sphere_cap(rim, centre, radius, true));
            return t.loop();
        });
        const double foot = vary(3.2);
        const double tip = vary(5);
        top.push_back([=](Builder& b, const Frame& frame, std::uint32_t count, std::int32_t) {
            Turning t(b, frame, count);
            t.cone_tip(foot, 0, tip);
            return t.loop();
        });
    }
    {
        const double a = vary(3.5);
        const double b = vary(2.2);
        const double c = vary(3);
        const double sink = 0.3 * c;
        const double polar = std::acos(sink / c);
        top.push_back(cap(
            Type::ellipsoid, a, b, {{1 / (a * a), 1 / (b * b), 1 / (c * c)}, {}, -1}, -sink, {a, b, c},
            [=](double rho) { return std::sin(rho * polar); },
            [=](double rho) { return -sink + c * std::cos(rho * polar); }));
    }
    {
        const double a = vary(3.4);
        const double b = vary(2);
        top.push_back(post(Type::elliptic_cylinder, a, b, vary(4), {{1 / (a * a), 1 / (b * b), 0}, {}, -1}, 0,
                           {a, b, 0}, [](double) { return 1.0; }));
    }
    {  // Drawn one by one: compilers evaluate the arguments of a call in different orders.
        const double q = -vary(0.14), p = vary(0.16), rise = vary(3), a = vary(3.3);
        top.push_back(block(Type::hyperbolic_paraboloid, a, rise, p, q));
    }
    {
        const double a = vary(1.05);
        const double b = vary(0.7);
        const double rise = vary(3.4);
        // z = rise − (x/a)² − (y/b)², cut at z = 0.
        top.push_back(cap(
            Type::elliptic_paraboloid, a * std::sqrt(rise), b * std::sqrt(rise),
            {{1 / (a * a), 1 / (b * b), 0}, {0, 0, 1}, 0}, rise, {}, [](double rho) { return rho; },
            [=](double rho) { return rise * (1 - rho * rho); }));
    }
    {
        const double a = vary(1.8);
        const double b = vary(1.3);
        const double c = vary(2.2);
        const double rise = vary(5);
        const double waist = 0.55 * rise;
        top.push_back(post(Type::hyperboloid_one_sheet, a, b, rise, {{1 / (a * a), 1 / (b * b), -1 / (c * c)}, {}, -1},
                           waist, {a, b, c}, [=](double z) {
                               const double h = (z - waist) / c;
                               return std::sqrt(1 + h * h);
                           }));
    }
    {
        const double a = vary(1.7);
        const double b = vary(1.2);
        const double c = vary(1.6);
        const double rise = vary(2.4);
        // (x/a)² + (y/b)² − (w/c)² = −1, lower sheet, its vertex at z = rise.
        const double rim = std::sqrt((1 + rise / c) * (1 + rise / c) - 1);
        top.push_back(cap(
            Type::hyperboloid_two_sheets, a, b, {{1 / (a * a), 1 / (b * b), -1 / (c * c)}, {}, 1}, rise + c, {a, b, c},
            [=](double rho) { return rim * rho; },
            [=](double rho) { return rise + c - c * std::sqrt(1 + rim * rim * rho * rho); }));
    }
    {
        const double a = vary(0.85);
        const double b = vary(0.55);
        const double tip = vary(4);
        top.push_back(cap(
            Type::elliptic_cone, a, b, {{1 / (a * a), 1 / (b * b), -1}, {}, 0}, tip, {a, b, 0},
            [=](double rho) { return tip * rho; }, [=](double rho) { return tip * (1 - rho); }));
    }
    {
        const double p = -vary(0.25), rise = vary(4), a = vary(3.2);
        top.push_back(block(Type::parabolic_cylinder, a, rise, p, 0));
    }
    {
        const double r = vary(1.6);
        const double major = vary(2.4);
        // A ring that lies on the plate: the outer and upper part of a torus, closed by a dish inside.
        top.push_back([=](Builder& b, const Frame& frame, std::uint32_t count, std::int32_t) {
            Turning t(b, frame, count);
            t.disc(major, r);
            t.arc_to(major + r, 0, major, 0);
            return t.loop();
        });
    }
    {
        const double radius = vary(3);
        const double rise = vary(4.5);
        top.push_back([=](Builder& b, const Frame& frame, std::uint32_t count, std::int32_t) {
            Turning t(b, frame, count);
            t.disc(radius, rise);
            t.line_to(radius, 0);
            return t.loop();
        });
    }
    build_body(builder, shape, top, {});
}

}  // namespace quadseg::datasets
