#include "surface/curvature_tensor.h"

#include "surface/small_system.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace quadseg::surface {

namespace {

constexpr int terms = 6;  // 1, x, y, x²/2, xy, y²/2
// Weight of "bends little" beside the points' own, as a share of the largest diagonal entry.
constexpr double rest_weight = 1e-4;

struct Quadratic {
    double c[terms] = {};
    double scale = 0;   ///< of x and y
    double misfit = 0;  ///< of heights, in scales
    std::array<double, 5> spread{};
};

/// False: no two directions to tell apart.
bool fit_heights(std::span<const Vec3> points, const Vec3& centre, const Vec3& x_axis, const Vec3& y_axis,
                 const Vec3& normal, Quadratic& result) {
    double square = 0;
    for (const Vec3& p : points) {
        const double x = dot(p - centre, x_axis), y = dot(p - centre, y_axis);
        square += x * x + y * y;
    }
    const double scale = std::sqrt(square / static_cast<double>(points.size()));
    if (!(scale > 0) || !std::isfinite(1 / scale)) return false;
    const auto row_of = [&](const Vec3& p, double* row) {
        const Vec3 d = (p - centre) / scale;
        const double x = dot(d, x_axis), y = dot(d, y_axis), h = dot(d, normal);
        const double flat = x * x + y * y;
        // 2h/|d|² is the curvature of the circle through the point, where 2h/(x² + y²) is that of a parabola.
        const double arc = flat > 0 ? (flat + h * h) / flat : 1;
        row[0] = 1;
        row[1] = x;
        row[2] = y;
        row[3] = 0.5 * arc * x * x;
        row[4] = arc * x * y;
        row[5] = 0.5 * arc * y * y;
        return h;
    };
    SmallSystem system(terms);
    double row[terms];
    for (const Vec3& p : points) {
        const double height = row_of(p, row);
        for (int i = 0; i < terms; ++i) {
            for (int j = 0; j <= i; ++j) system.h[i][j] += row[i] * row[j];
            system.g[i] += row[i] * height;
        }
    }
    if (!system.solve(0, rest_weight, 1, result.c)) return false;
    double rest = 0;
    for (const Vec3& p : points) {
        double height = row_of(p, row);
        for (int i = 0; i < terms; ++i) height -= result.c[i] * row[i];
        rest += height * height;
    }
    for (const Vec3& p : points) {
        const Vec3 d = (p - centre) / scale;
        const double x = dot(d, x_axis), y = dot(d, y_axis);
        const double powers[5] = {x * x * x * x, x * x * x * y, x * x * y * y, x * y * y * y, y * y * y * y};
        for (std::size_t i = 0; i < 5; ++i) result.spread[i] += powers[i] / static_cast<double>(points.size());
    }
    result.scale = scale;
    result.misfit = std::sqrt(rest / std::max(1.0, static_cast<double>(points.size()) - terms));
    return true;
}

}  // namespace

CurvatureTensor fit_curvature(std::span<const Vec3> points, const Vec3& centre, const Vec3& orientation) {
    CurvatureTensor tensor;
    tensor.error = std::numeric_limits<double>::infinity();
    Vec3 normal = normalized(orientation);
    if (squared_norm(normal) == 0 || points.size() < 3) return tensor;
    Quadratic height;
    Vec3 x_axis, y_axis;
    for (int pass = 0; pass < 2; ++pass) {
        x_axis = any_perpendicular(normal);
        y_axis = cross(normal, x_axis);
        height = {};
        if (!fit_heights(points, centre, x_axis, y_axis, normal, height)) return tensor;
        if (pass == 0) normal = normalized(normal - height.c[1] * x_axis - height.c[2] * y_axis);
    }
    tensor.normal = normal;
    tensor.x_axis = x_axis;
    tensor.along_x = height.c[3] / height.scale;
    tensor.mixed = height.c[4] / height.scale;
    tensor.along_y = height.c[5] / height.scale;
    tensor.spread = height.spread;
    // Points that determine everything tell nothing about the error.
    if (points.size() > terms) tensor.error = height.misfit / height.scale;
    return tensor;
}

}  // namespace quadseg::surface
