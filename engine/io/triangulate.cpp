#include "io/faces.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace quadseg::io {
namespace {

struct Point2 {
    double x, y;
};

/// Twice the signed area of a triangle.
double turn(const Point2& a, const Point2& b, const Point2& c) noexcept {
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

/// The polygon along the largest component of its Newell normal, counter-clockwise; false if it has no area.
bool project(std::span<const double> positions, std::span<const std::uint32_t> polygon, std::vector<Point2>& points,
             double& area) {
    const auto position = [&](std::uint32_t v) { return positions.data() + 3 * std::size_t{v}; };
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
    points.clear();
    for (const std::uint32_t corner : polygon) {
        const double* p = position(corner);
        points.push_back({p[u] - origin[u], p[v] - origin[v]});
    }
    return true;
}

/// All turns to the left. A star (winding twice) passes too, but no fan or ear makes sense of that.
bool strictly_convex(const std::vector<Point2>& points, double threshold) noexcept {
    const std::size_t n = points.size();
    for (std::size_t i = 0; i < n; ++i) {
        if (!(turn(points[i], points[(i + 1) % n], points[(i + 2) % n]) > threshold)) return false;
    }
    return true;
}

/// A ring of the corners that are not cut off yet.
class EarClipper {
  public:
    EarClipper(const std::vector<Point2>& points, std::span<const std::uint32_t> polygon, double threshold)
        : points_(points), polygon_(polygon), threshold_(threshold), next_(points.size()), previous_(points.size()) {
        const std::size_t n = points.size();
        for (std::size_t i = 0; i < n; ++i) {
            next_[i] = (i + 1) % n;
            previous_[i] = (i + n - 1) % n;
        }
    }

    void clip(std::uint32_t* out) {
        std::size_t tip = 1;
        for (std::size_t left = points_.size(); left > 3; --left) {
            tip = find_ear(tip, left);
            out = cut(tip, out);
            const std::size_t after = next_[tip];
            next_[previous_[tip]] = after;
            previous_[after] = previous_[tip];
            tip = after;
        }
        cut(tip, out);
    }

  private:
    std::uint32_t* cut(std::size_t tip, std::uint32_t* out) const noexcept {
        *out++ = polygon_[previous_[tip]];
        *out++ = polygon_[tip];
        *out++ = polygon_[next_[tip]];
        return out;
    }

    /// The first ear from `tip` on; where there is none (crossing edges), the corner that turns left most.
    std::size_t find_ear(std::size_t tip, std::size_t left) const noexcept {
        std::size_t best = tip;
        double best_turn = -HUGE_VAL;
        for (std::size_t k = 0; k < left; ++k, tip = next_[tip]) {
            const double t = turn(points_[previous_[tip]], points_[tip], points_[next_[tip]]);
            if (t > threshold_ && is_empty(tip, left)) return tip;
            if (t > best_turn) {
                best_turn = t;
                best = tip;
            }
        }
        return best;
    }

    bool is_empty(std::size_t tip, std::size_t left) const noexcept {
        const Point2 &a = points_[previous_[tip]], &b = points_[tip], &c = points_[next_[tip]];
        std::size_t other = next_[next_[tip]];
        for (std::size_t k = 3; k < left; ++k, other = next_[other]) {
            const Point2& p = points_[other];
            const auto same = [&](const Point2& q) { return p.x == q.x && p.y == q.y; };
            if (same(a) || same(b) || same(c)) continue;  // a corner that the outline passes twice blocks nothing
            if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
        }
        return true;
    }

    const std::vector<Point2>& points_;
    std::span<const std::uint32_t> polygon_;
    double threshold_;
    std::vector<std::size_t> next_, previous_;
};

}  // namespace

void triangulate(std::span<const double> positions, std::span<const std::uint32_t> polygon, std::uint32_t* triangles) {
    if (polygon.size() == 3) {
        std::copy(polygon.begin(), polygon.end(), triangles);
        return;
    }
    std::vector<Point2> points;
    double area = 0;
    if (polygon.size() > largest_clipped_polygon || !project(positions, polygon, points, area) ||
        strictly_convex(points, straightness * area)) {
        fan(polygon, triangles);
    } else {
        EarClipper(points, polygon, straightness * area).clip(triangles);
    }
}

}  // namespace quadseg::io
