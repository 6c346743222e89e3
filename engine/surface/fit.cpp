#include "surface/fit.h"

#include "surface/evaluate.h"
#include "surface/fit_starts.h"
#include "surface/levenberg_marquardt.h"
#include "surface/local_points.h"
#include "surface/shape_frame.h"
#include "surface/surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace quadseg::surface {

namespace {

constexpr double largest_radius = 1e4;  ///< in extents of the points
// A first start this good (in extents) needs no second one.
constexpr double exact_fit = 1e-10;

bool is_direct(SurfaceType type) {
    return type <= SurfaceType::torus;
}

/// `outward` (plane: the axis) after the normals, if there are any.
void orient(Surface& s, const PointSet& p) {
    if (p.normals.size() != p.points.size()) return;
    Surface outside = s;
    outside.outward = true;
    double vote = 0;
    SurfaceEvaluator(outside).visit([&](const auto& e) {
        for (std::size_t i = 0; i < p.points.size(); ++i) vote += dot(e.normal(p.points[i]), p.normals[i]);
    });
    if (s.type != SurfaceType::plane)
        s.outward = vote >= 0;
    else if (vote < 0)
        s.axis = {-s.axis[0], -s.axis[1], -s.axis[2]};
}

SurfaceFit failed(SurfaceType type) {
    SurfaceFit f;
    f.surface.type = type;
    f.rms = f.median = f.q90 = f.q97 = f.max = std::numeric_limits<double>::infinity();
    return f;
}

struct Attempt {
    Adjustment adjusted;
    Surface surface;  ///< local
    bool ok = false;
    double median = std::numeric_limits<double>::infinity();
};

Attempt attempt(const Surface& start, SurfaceType type, LocalPoints& points, const FitOptions& options) {
    Attempt a;
    ShapeFrame frame;
    if (!frame_of(start, anchor(start, points), type, frame)) return a;
    a.adjusted = adjust(frame, points, options);
    if (!a.adjusted.finite) return a;
    a.median = a.adjusted.median;
    a.ok = a.adjusted.determined && surface_of(a.adjusted.frame, largest_radius, a.surface);
    return a;
}

bool better(const Attempt& a, const Attempt& b) {
    return a.ok != b.ok ? a.ok : a.median < b.median;
}

SurfaceFit finished(const Attempt& a, SurfaceType type, bool start_outward, const LocalPoints& points,
                    const PointSet& p) {
    if (!a.ok) return failed(type);
    Surface s = points.to_world(a.surface);
    if (p.normals.size() == p.points.size())
        orient(s, p);
    else
        s.outward = start_outward;
    SurfaceFit f = measure(s, p);
    f.ok = std::isfinite(f.rms);
    f.surface.coefficients = to_coefficients(f.surface);
    return f;
}

}  // namespace

int degrees_of_freedom(SurfaceType type) noexcept {
    switch (type) {
        case SurfaceType::plane:
            return 3;
        case SurfaceType::sphere:
            return 4;
        case SurfaceType::cylinder:
            return 5;
        case SurfaceType::cone:
            return 6;
        case SurfaceType::torus:
            return 7;
        default:
            return 9;
    }
}

SurfaceFit measure(const Surface& s, const PointSet& p) {
    SurfaceFit f;
    f.surface = s;
    const std::size_t n = p.points.size();
    if (n == 0) return f;
    constexpr std::size_t in_place = 256;
    double small[in_place];
    std::vector<double> large(n > in_place ? n : 0);
    double* d = n > in_place ? large.data() : small;
    double sum = 0;
    bool finite = true;
    SurfaceEvaluator(s).visit([&](const auto& e) {
        for (std::size_t i = 0; i < n; ++i) {
            d[i] = std::abs(e.distance(p.points[i]));
            sum += d[i] * d[i];
            finite = finite && std::isfinite(d[i]);
        }
    });
    if (!finite) return failed(s.type);
    f.rms = std::sqrt(sum / double(n));
    auto quantile = [&](double q, std::size_t from) {
        const std::size_t k = std::min(std::size_t(q * double(n)), n - 1);
        if (k >= from) std::nth_element(d + from, d + k, d + n);
        return k;
    };
    const std::size_t k50 = quantile(0.5, 0), k90 = quantile(0.9, k50 + 1), k97 = quantile(0.97, k90 + 1);
    f.median = d[k50];
    f.q90 = d[k90];
    f.q97 = d[k97];
    f.max = *std::max_element(d + k97, d + n);
    f.ok = true;
    return f;
}

SurfaceFit refine(const Surface& start, const PointSet& p, const FitOptions& options) {
    if (!is_direct(start.type) || p.points.size() < std::size_t(degrees_of_freedom(start.type)))
        return failed(start.type);
    LocalPoints points(p);
    if (!points.usable()) return failed(start.type);
    return finished(attempt(points.to_local(start), start.type, points, options), start.type, start.outward, points, p);
}

SurfaceFit fit(SurfaceType type, const PointSet& p, const FitOptions& options) {
    if (!is_direct(type) || p.points.size() < std::size_t(degrees_of_freedom(type))) return failed(type);
    LocalPoints points(p);
    const bool from_points = type == SurfaceType::plane || type == SurfaceType::sphere;
    if (!points.usable() || (points.normals.empty() && !from_points)) return failed(type);
    Attempt best;
    const double good = std::max(exact_fit, 0.1 * options.wanted / points.extent);
    const bool any_rms = options.robust || !(options.most_rms > 0);
    auto enough = [&] {
        return best.ok && (any_rms ? best.median <= good : best.adjusted.rms * points.extent <= options.most_rms);
    };
    auto attempt_from = [&](const Surface& start) {
        const Attempt next = attempt(start, type, points, options);
        if (better(next, best)) best = next;
        return enough();
    };
    switch (type) {
        case SurfaceType::plane:
            attempt_from(start_plane(points));
            break;
        case SurfaceType::sphere:
            attempt_from(start_sphere(points));
            break;
        case SurfaceType::cylinder:
            if (!attempt_from(start_cylinder(points))) attempt_from(start_cylinder_along(points));
            break;
        case SurfaceType::cone:
            if (!attempt_from(start_cone(points))) attempt_from(start_cone_from(start_cylinder(points), points));
            break;
        default: {
            const TorusAxes axes(points);
            if (attempt_from(axes.start(points, 0)) || attempt_from(axes.start(points, 1))) break;
            const Surface cylinder = start_cylinder(points);
            if (!(options.wanted > 0)) {
                // A cylinder that fits tells a fillet's bend better than one that only starts.
                FitOptions few = options;
                few.iterations = 5;
                const Attempt fitted = attempt(cylinder, SurfaceType::cylinder, points, few);
                if (attempt_from(start_torus_from(fitted.ok ? fitted.surface : cylinder, points))) break;
            }
            if (attempt_from(start_torus_from(cylinder, points))) break;
            attempt_from(axes.start(points, 2));
        }
    }
    return finished(best, type, true, points, p);
}

namespace {

template <class Start>
Surface initial(const PointSet& p, SurfaceType type, Start&& start) {
    const LocalPoints points(p);
    Surface s;
    s.type = type;
    if (!points.usable()) return s;
    s = points.to_world(start(points));
    orient(s, p);
    return s;
}

}  // namespace

Surface initial_plane(const PointSet& p) {
    return initial(p, SurfaceType::plane, start_plane);
}
Surface initial_sphere(const PointSet& p) {
    return initial(p, SurfaceType::sphere, start_sphere);
}
Surface initial_cylinder(const PointSet& p) {
    return initial(p, SurfaceType::cylinder, start_cylinder);
}
Surface initial_cone(const PointSet& p) {
    return initial(p, SurfaceType::cone, start_cone);
}
Surface initial_torus(const PointSet& p) {
    return initial(p, SurfaceType::torus, [](const LocalPoints& points) { return TorusAxes(points).start(points); });
}

}  // namespace quadseg::surface
