#include "surface/quadric_refine.h"

#include "quadric/pack.h"
#include "surface/levenberg_marquardt.h"
#include "surface/median.h"
#include "surface/small_system.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace quadseg::surface {

namespace {

using quadric::Coefficients, quadric::load_part, quadric::Part, quadric::part_size;

constexpr double gradient_floor_share = 0.05;  // of the median |∇f|: apexes and axes must not explode
constexpr double value_weight = 10;            // of f² beside |∇f − n|²: vertices are exact, normals are not

/// The monomials of a family (bits of the ten; `tied`: x² and y² share a coefficient) and the motions of its frame.
struct Shape {
    int modes[most_unknowns];
    int mode_count;
    bool tied;
    int rotations, translations;  ///< about and along the first n axes
};

Shape shape_of(QuadricFamily family) {
    switch (family) {
        case QuadricFamily::cylinder:
            return {{0, 1, 2, 4, 5, 7}, 6, false, 2, 0};
        case QuadricFamily::parabolic_cylinder:
            return {{0, 1, 2, 4}, 4, false, 3, 0};
        case QuadricFamily::paraboloid:
            return {{0, 1, 2, 3, 4, 5, 7}, 7, false, 2, 0};
        case QuadricFamily::cone:
            return {{4, 5, 6, 7, 8, 9}, 6, false, 0, 3};
        case QuadricFamily::revolution:
            return {{0, 3, 4, 9}, 4, true, 2, 2};
        default:
            return {{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}, 10, false, 0, 0};
    }
}

void values(const Vec3& u, double* f) {
    const double all[10] = {1, u.x, u.y, u.z, u.x * u.x, u.x * u.y, u.x * u.z, u.y * u.y, u.y * u.z, u.z * u.z};
    std::copy(all, all + 10, f);
}

Vec3 monomial_gradient(int k, const Vec3& u) {
    switch (k) {
        case 1:
            return {1, 0, 0};
        case 2:
            return {0, 1, 0};
        case 3:
            return {0, 0, 1};
        case 4:
            return {2 * u.x, 0, 0};
        case 5:
            return {u.y, u.x, 0};
        case 6:
            return {u.z, 0, u.x};
        case 7:
            return {0, 2 * u.y, 0};
        case 8:
            return {0, u.z, u.y};
        case 9:
            return {0, 0, 2 * u.z};
        default:
            return {};
    }
}

/// Slopes of the ten monomials at u along d.
void gradients_along(const Vec3& d, const Vec3& u, double* out) {
    const double all[10] = {0,
                            d.x,
                            d.y,
                            d.z,
                            d.x * (2 * u.x),
                            d.x * u.y + d.y * u.x,
                            d.x * u.z + d.z * u.x,
                            d.y * (2 * u.y),
                            d.y * u.z + d.z * u.y,
                            d.z * (2 * u.z)};
    std::copy(all, all + 10, out);
}

Vec3 hessian_times(const Coefficients& c, const Vec3& v) {
    return {2 * c[4] * v.x + c[5] * v.y + c[6] * v.z, c[5] * v.x + 2 * c[7] * v.y + c[8] * v.z,
            c[6] * v.x + c[8] * v.y + 2 * c[9] * v.z};
}

Vec3 in_frame(const QuadricFrame& f, const Vec3& p) {
    const Vec3 u = p - f.origin;
    return {dot(u, f.axes[0]), dot(u, f.axes[1]), dot(u, f.axes[2])};
}

/// Some of the points in the frame's coordinates.
struct PartInFrame {
    Part x, y, z;

    PartInFrame(const QuadricFrame& f, const LocalPoints& p, std::size_t first) {
        const Part px = load_part(p.x + first) - f.origin.x, py = load_part(p.y + first) - f.origin.y,
                   pz = load_part(p.z + first) - f.origin.z;
        const auto along = [&](const Vec3& a, Part& out) { out = px * a.x + py * a.y + pz * a.z; };
        along(f.axes[0], x);
        along(f.axes[1], y);
        along(f.axes[2], z);
    }
    void value(const Coefficients& c, Part& out) const {
        out = c[0] + x * (c[1] + c[4] * x + c[5] * y + c[6] * z) + y * (c[2] + c[7] * y + c[8] * z) +
              z * (c[3] + c[9] * z);
    }
    /// |∇f|
    void steepness(const Coefficients& c, Part& out) const {
        const Part gx = c[1] + 2 * c[4] * x + c[5] * y + c[6] * z, gy = c[2] + c[5] * x + 2 * c[7] * y + c[8] * z,
                   gz = c[3] + c[6] * x + c[8] * y + 2 * c[9] * z;
        quadric::square_root(gx * gx + gy * gy + gz * gz, out);
    }
};

Vec3 direction_in_frame(const QuadricFrame& f, const Vec3& v) {
    return {dot(v, f.axes[0]), dot(v, f.axes[1]), dot(v, f.axes[2])};
}

/// The linear substitution u → origin + Σ u_i axes_i in f.
Coefficients substituted(const Coefficients& c, const Vec3& origin, const Vec3 (&axes)[3]) {
    const Vec3 g = quadric::gradient(c, origin),
               h[3] = {hessian_times(c, axes[0]), hessian_times(c, axes[1]), hessian_times(c, axes[2])};
    return {quadric::value(c, origin), dot(g, axes[0]),         dot(g, axes[1]),    dot(g, axes[2]),
            0.5 * dot(axes[0], h[0]),  dot(axes[0], h[1]),      dot(axes[0], h[2]), 0.5 * dot(axes[1], h[1]),
            dot(axes[1], h[2]),        0.5 * dot(axes[2], h[2])};
}

QuadricFrame moved(const QuadricFrame& f, const Shape& shape, const double* step) {
    QuadricFrame next = f;
    for (int i = 0; i < shape.mode_count; ++i) {
        next.c[std::size_t(shape.modes[i])] += step[i];
        if (shape.tied && shape.modes[i] == 4) next.c[7] += step[i];
    }
    Vec3 turn;
    for (int i = 0; i < shape.rotations; ++i) turn += step[shape.mode_count + i] * f.axes[i];
    for (int i = 0; i < shape.translations; ++i)
        next.origin += step[shape.mode_count + shape.rotations + i] * f.axes[i];
    const double angle = norm(turn);
    if (angle > 0) {
        const Vec3 k = turn / angle;
        for (Vec3& a : next.axes) a = a + std::sin(angle) * cross(k, a) + (1 - std::cos(angle)) * cross(k, cross(k, a));
        next.axes[2] = normalized(next.axes[2]);
        next.axes[0] = normalized(next.axes[0] - dot(next.axes[0], next.axes[2]) * next.axes[2]);
        next.axes[1] = cross(next.axes[2], next.axes[0]);
    }
    return next;
}

double gradient_floor(const QuadricFrame& f, LocalPoints& points) {
    for (std::size_t first = 0; first < points.padded(); first += part_size) {
        const PartInFrame u(f, points, first);
        Part steepness;
        u.steepness(f.c, steepness);
        quadric::store_part(points.trial + first, steepness);
    }
    return gradient_floor_share * median_magnitude(points.trial, points.size(), points.sorted);
}

/// f / |∇f|, the gradient floored.
void residuals(const QuadricFrame& f, double floor, LocalPoints& points, double* out) {
    for (std::size_t first = 0; first < points.padded(); first += part_size) {
        const PartInFrame u(f, points, first);
        Part value, steepness;
        u.value(f.c, value);
        u.steepness(f.c, steepness);
        quadric::maximum(Part{} + floor, steepness, steepness);
        quadric::store_part(out + first, value / steepness);
    }
}

double robust_cost(const LocalPoints& points, const double* d, double scale) {
    double sum = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
        sum += points.weight[i] * (scale > 0 ? scale * scale * std::log1p(d[i] * d[i] / (scale * scale)) : d[i] * d[i]);
    return sum;
}

}  // namespace

int degrees_of_freedom(QuadricFamily family) noexcept {
    const Shape s = shape_of(family);
    return s.mode_count - 1 + s.rotations + s.translations;
}

Coefficients to_frame(const Coefficients& c, const QuadricFrame& frame) noexcept {
    return substituted(c, frame.origin, frame.axes);
}

Coefficients from_frame(const QuadricFrame& f) noexcept {
    const Vec3 back[3] = {{f.axes[0].x, f.axes[1].x, f.axes[2].x},
                          {f.axes[0].y, f.axes[1].y, f.axes[2].y},
                          {f.axes[0].z, f.axes[1].z, f.axes[2].z}};
    return substituted(f.c, in_frame(f, {}), back);
}

bool start_quadric(QuadricFamily family, const LocalPoints& points, QuadricFrame& frame) {
    if (points.normals.empty()) return false;
    const Shape shape = shape_of(family);
    const int n = shape.mode_count;
    SmallSystem system(n);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3 u = in_frame(frame, points.point(i)), normal = direction_in_frame(frame, points.normals[i]);
        double all[10], f[most_unknowns];
        Vec3 g[most_unknowns];
        values(u, all);
        for (int k = 0; k < n; ++k) {
            f[k] = all[shape.modes[k]];
            g[k] = monomial_gradient(shape.modes[k], u);
            if (shape.tied && shape.modes[k] == 4) {
                f[k] += all[7];
                g[k] += monomial_gradient(7, u);
            }
        }
        for (int r = 0; r < n; ++r) {
            for (int c = 0; c <= r; ++c)
                system.h[r][c] += points.weight[i] * (value_weight * f[r] * f[c] + dot(g[r], g[c]));
            system.g[r] += points.weight[i] * dot(g[r], normal);
        }
    }
    double c[most_unknowns], largest = 0;
    if (!system.solve(0, 1e-12, 1, c)) return false;
    for (int k = 0; k < n; ++k) largest = std::max(largest, std::abs(c[k]));
    if (!(largest > 0)) return false;
    frame.c = {};
    for (int k = 0; k < n; ++k) {
        frame.c[std::size_t(shape.modes[k])] = c[k];
        if (shape.tied && shape.modes[k] == 4) frame.c[7] = c[k];
    }
    return true;
}

bool refine_quadric(QuadricFamily family, LocalPoints& points, const QuadricFrame& start, const FitOptions& options,
                    Coefficients& coefficients) {
    const Shape shape = shape_of(family);
    const int n = shape.mode_count + shape.rotations + shape.translations;
    if (points.size() < std::size_t(n - 1)) return false;
    QuadricFrame best = start;
    const double least_scale = std::max(options.minimum_scale / points.extent, 4e-16);
    auto scale_of = [&](const double* d) {
        return options.robust ? std::max(3 * median_magnitude(d, points.size(), points.sorted), least_scale) : 0.0;
    };
    double damping = 1e-3, scale = 0, cost = std::numeric_limits<double>::infinity();
    double floor = gradient_floor(best, points);
    if (!(floor > 0)) return false;
    residuals(best, floor, points, points.distance);
    scale = scale_of(points.distance);
    cost = robust_cost(points, points.distance, scale);
    if (!std::isfinite(cost)) return false;
    int plateau = 0, accepted = 0;
    SmallSystem system(n);
    bool fresh = false;
    for (int iteration = 0; iteration < 2 * options.iterations; ++iteration) {
        if (!fresh) {
            system = SmallSystem(n);
            double row[most_unknowns]{}, all[10], along[10];
            for (std::size_t i = 0; i < points.size(); ++i) {
                const Vec3 u = in_frame(best, points.point(i)), gradient = quadric::gradient(best.c, u);
                const double steep = norm(gradient), r = points.distance[i];
                // Below the floor |∇f| counts as constant.
                const double inverse = 1 / std::max(steep, floor);
                const Vec3 unit = steep > floor ? gradient / steep : Vec3{};
                values(u, all);
                gradients_along(unit, u, along);
                for (int k = 0; k < shape.mode_count; ++k) {
                    const int mode = shape.modes[k];
                    const bool tied = shape.tied && mode == 4;
                    const double f = tied ? all[4] + all[7] : all[mode];
                    const double slope = tied ? along[4] + along[7] : along[mode];
                    row[k] = (f - r * slope) * inverse;
                }
                auto moving = [&](const Vec3& du) {
                    return (dot(gradient, du) - r * dot(unit, hessian_times(best.c, du))) * inverse;
                };
                const Vec3 e[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
                for (int k = 0; k < shape.rotations; ++k) row[shape.mode_count + k] = -moving(cross(e[k], u));
                for (int k = 0; k < shape.translations; ++k)
                    row[shape.mode_count + shape.rotations + k] = -moving(e[k]);
                const double w = points.weight[i] / (scale > 0 ? 1 + r * r / (scale * scale) : 1);
                for (int a = 0; a < n; ++a) {
                    // Whole rows, of which the lower triangle counts: a fixed length vectorises.
                    const double weighted = w * row[a];
                    for (int b = 0; b < most_unknowns; ++b) system.h[a][b] += weighted * row[b];
                    system.g[a] += weighted * r;
                }
            }
            // f and its multiples are one surface: no step along c.
            double length = 0, trace = 0;
            for (int k = 0; k < shape.mode_count; ++k) {
                const double c = best.c[std::size_t(shape.modes[k])];
                length += c * c;
            }
            for (int k = 0; k < n; ++k) trace += system.h[k][k];
            const double hold = trace / (n * length);
            for (int a = 0; a < shape.mode_count; ++a)
                for (int b = 0; b <= a; ++b)
                    system.h[a][b] += hold * best.c[std::size_t(shape.modes[a])] * best.c[std::size_t(shape.modes[b])];
            fresh = true;
        }
        double step[most_unknowns];
        if (!system.solve(damping, 1e-15, -1, step)) {
            damping = std::max(10 * damping, 1e-6);
            if (damping > 1e8) break;
            continue;
        }
        double turn = 0;
        for (int k = 0; k < shape.rotations; ++k) turn = std::max(turn, std::abs(step[shape.mode_count + k]));
        if (turn > 0.5)
            for (int k = 0; k < n; ++k) step[k] *= 0.5 / turn;
        QuadricFrame next = moved(best, shape, step);
        residuals(next, floor, points, points.trial);
        const double there = robust_cost(points, points.trial, scale);
        if (!(there <= cost)) {
            if (scale > 0 && scale < 1e-13) break;
            if (there - cost < 1e-11 * cost) break;
            damping = std::max(10 * damping, 1e-6);
            if (damping > 1e8) break;
            continue;
        }
        const double gain = cost - there;
        best = next;
        damping = damping < 1e-10 ? 0 : 0.05 * damping;
        fresh = false;
        floor = gradient_floor(best, points);
        if (!(floor > 0)) return false;
        for (double& v : best.c) v *= gradient_floor_share / floor;
        floor = gradient_floor_share;
        residuals(best, floor, points, points.distance);
        const double scale_there = scale_of(points.distance);
        plateau = gain <= 1e-9 * cost && scale_there > 0.999 * scale ? plateau + 1 : 0;
        scale = scale_there;
        cost = robust_cost(points, points.distance, scale);
        if (plateau >= 2 || !(cost > 0)) break;
        if (options.hopeless > 0 && ++accepted == options.hopeless_after &&
            median_magnitude(points.distance, points.size(), points.sorted) * points.extent > options.hopeless)
            return false;
    }
    coefficients = from_frame(best);
    for (double v : coefficients)
        if (!std::isfinite(v)) return false;
    return true;
}

}  // namespace quadseg::surface
