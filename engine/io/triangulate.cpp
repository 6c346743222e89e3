#include "io/faces.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace quadseg::io {
namespace {

using Point = Triangulator::Point;

/// Twice the signed area of a triangle.
double turn(const Point& a, const Point& b, const Point& c) noexcept {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Ears are searched in quadratic time; beyond this size a fan must do.
constexpr std::size_t largest_clipped_polygon = 4096;
/// Turns below this share of the polygon's area count as straight.
constexpr double straightness = 1e-12;

void fan(std::span<const std::uint32_t> polygon, std::uint32_t* out) noexcept {
    for (std::size_t i = 2; i < polygon.size(); ++i) {
        *out++ = polygon[0];
        *out++ = polygon[i - 1];
        *out++ = polygon[i];
    }
}

}  // namespace

void Triangulator::cut(std::span<const std::uint32_t> polygon, std::uint32_t* triangles) {
    double area = 0;
    if (polygon.size() == 3 || polygon.size() > largest_clipped_polygon || !project(polygon, area) ||
        strictly_convex(straightness * area)) {
        fan(polygon, triangles);
    } else {
        cut_ears(polygon, straightness * area, triangles);
    }
}

/// Along the largest component of the Newell normal, so that the outline turns to the left; false if it has no area.
bool Triangulator::project(std::span<const std::uint32_t> polygon, double& area) {
    const auto position = [&](std::uint32_t v) { return positions_.data() + 3 * std::size_t{v}; };
    const double* origin = position(polygon[0]);
    double normal[3] = {0, 0, 0};
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const double* p = position(polygon[i]);
        const double* q = position(polygon[i + 1 < polygon.size() ? i + 1 : 0]);
        for (int k = 0; k < 3; ++k) {
            const int u = (k + 1) % 3, v = (k + 2) % 3;
            normal[k] += (p[u] - origin[u]) * (q[v] - origin[v]) - (p[v] - origin[v]) * (q[u] - origin[u]);
        }
    }
    int axis = 0;
    for (int k = 1; k < 3; ++k) {
        if (std::abs(normal[k]) > std::abs(normal[axis])) axis = k;
    }
    area = std::abs(normal[axis]);
    if (!(area > 0) || !std::isfinite(area)) return false;
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    if (normal[axis] < 0) std::swap(u, v);
    points_.clear();
    for (const std::uint32_t corner : polygon) {
        const double* p = position(corner);
        points_.push_back({p[u] - origin[u], p[v] - origin[v]});
    }
    return true;
}

/// All turns to the left. A star (winding twice) passes too, but neither fan nor ears make sense of that.
bool Triangulator::strictly_convex(double threshold) const noexcept {
    const std::size_t n = points_.size();
    for (std::size_t i = 2; i < n; ++i) {
        if (!(turn(points_[i - 2], points_[i - 1], points_[i]) > threshold)) return false;
    }
    return turn(points_[n - 2], points_[n - 1], points_[0]) > threshold &&
           turn(points_[n - 1], points_[0], points_[1]) > threshold;
}

void Triangulator::cut_ears(std::span<const std::uint32_t> polygon, double threshold, std::uint32_t* triangles) {
    const std::size_t n = polygon.size();
    next_.resize(n);
    previous_.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        next_[i] = (i + 1) % n;
        previous_[i] = (i + n - 1) % n;
    }
    std::size_t tip = 1;
    for (std::size_t left = n; left >= 3; --left) {
        if (left > 3) tip = find_ear(tip, left, threshold);
        const std::size_t before = previous_[tip], after = next_[tip];
        for (const std::size_t corner : {before, tip, after}) *triangles++ = polygon[corner];
        next_[before] = after;
        previous_[after] = before;
        tip = after;
    }
}

/// The first ear from `tip` on; where there is none (crossing edges), the corner that turns left most.
std::size_t Triangulator::find_ear(std::size_t tip, std::size_t left, double threshold) const noexcept {
    std::size_t best = tip;
    double best_turn = -HUGE_VAL;
    for (std::size_t k = 0; k < left; ++k, tip = next_[tip]) {
        const double t = turn(points_[previous_[tip]], points_[tip], points_[next_[tip]]);
        if (t > threshold && is_empty(tip, left)) return tip;
        if (t > best_turn) {
            best_turn = t;
            best = tip;
        }
    }
    return best;
}

/// No other corner lies in the triangle at `tip`.
bool Triangulator::is_empty(std::size_t tip, std::size_t left) const noexcept {
    const Point &a = points_[previous_[tip]], &b = points_[tip], &c = points_[next_[tip]];
    std::size_t other = next_[next_[tip]];
    for (std::size_t k = 3; k < left; ++k, other = next_[other]) {
        const Point& p = points_[other];
        const auto same = [&](const Point& q) { return p.x == q.x && p.y == q.y; };
        if (same(a) || same(b) || same(c)) continue;  // a corner that the outline passes twice blocks nothing
        if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
    }
    return true;
}

}  // namespace quadseg::io
