// Distance between two meshes by samples spread evenly over the one and the nearest points on the other: the judge of a
// decimation, independent of it.
#pragma once

#include "math/vec3.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

namespace quadseg::simplify {

using Triangle = std::array<std::uint32_t, 3>;

inline double squared_distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
    const Vec3 ab = b - a;
    const double l2 = squared_norm(ab);
    const double t = l2 > 0 ? std::clamp(dot(p - a, ab) / l2, 0.0, 1.0) : 0.0;
    return squared_norm(p - a - ab * t);
}

inline double squared_distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 n = cross(b - a, c - a);
    const double n2 = squared_norm(n);
    if (n2 > 0 && dot(cross(b - a, p - a), n) >= 0 && dot(cross(c - b, p - b), n) >= 0 &&
        dot(cross(a - c, p - c), n) >= 0) {
        const double d = dot(p - a, n);
        return d * d / n2;
    }
    return std::min({squared_distance_to_segment(p, a, b), squared_distance_to_segment(p, b, c),
                     squared_distance_to_segment(p, c, a)});
}

/// Bounding volume hierarchy over triangles, halved at the median.
class NearestTriangle {
  public:
    NearestTriangle(std::span<const Vec3> positions, std::span<const Triangle> faces)
        : positions_(positions), faces_(faces), order_(faces.size()) {
        std::iota(order_.begin(), order_.end(), 0U);
        if (!faces.empty()) build(0, static_cast<std::uint32_t>(faces.size()));
    }

    double squared_distance(const Vec3& p) const {
        double best = std::numeric_limits<double>::infinity();
        if (!nodes_.empty()) search(0, p, best);
        return best;
    }

  private:
    struct Node {
        Vec3 low, high;
        std::uint32_t begin = 0, end = 0, right = 0;  ///< right 0: leaf; the left child follows its parent
    };

    std::uint32_t build(std::uint32_t begin, std::uint32_t end) {
        const auto index = static_cast<std::uint32_t>(nodes_.size());
        nodes_.emplace_back();
        Node node;
        node.low = node.high = positions_[faces_[order_[begin]][0]];
        for (std::uint32_t i = begin; i < end; ++i) {
            for (const std::uint32_t v : faces_[order_[i]]) {
                for (int k = 0; k < 3; ++k) {
                    node.low[k] = std::min(node.low[k], positions_[v][k]);
                    node.high[k] = std::max(node.high[k], positions_[v][k]);
                }
            }
        }
        node.begin = begin;
        node.end = end;
        if (end - begin > 4) {
            const Vec3 size = node.high - node.low;
            const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
            const std::uint32_t middle = begin + (end - begin) / 2;
            std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                             [&](std::uint32_t f, std::uint32_t g) { return centre(f, axis) < centre(g, axis); });
            build(begin, middle);
            node.right = build(middle, end);
        }
        nodes_[index] = node;
        return index;
    }
    double centre(std::uint32_t f, int axis) const {
        return positions_[faces_[f][0]][axis] + positions_[faces_[f][1]][axis] + positions_[faces_[f][2]][axis];
    }
    static double to_box(const Vec3& p, const Node& node) {
        double d2 = 0;
        for (int k = 0; k < 3; ++k) {
            const double d = std::max({node.low[k] - p[k], p[k] - node.high[k], 0.0});
            d2 += d * d;
        }
        return d2;
    }
    void search(std::uint32_t index, const Vec3& p, double& best) const {
        const Node& node = nodes_[index];
        if (to_box(p, node) >= best) return;
        if (node.right == 0) {
            for (std::uint32_t i = node.begin; i < node.end; ++i) {
                const Triangle& f = faces_[order_[i]];
                best = std::min(best,
                                squared_distance_to_triangle(p, positions_[f[0]], positions_[f[1]], positions_[f[2]]));
            }
            return;
        }
        const std::uint32_t left = index + 1;
        if (to_box(p, nodes_[left]) <= to_box(p, nodes_[node.right])) {
            search(left, p, best);
            search(node.right, p, best);
        } else {
            search(node.right, p, best);
            search(left, p, best);
        }
    }

    std::span<const Vec3> positions_;
    std::span<const Triangle> faces_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

struct MeshDistance {
    double rms = 0, max = 0;
};

/// From `samples` points spread over a (stratified by area, golden-ratio sequence in a triangle) to b.
inline MeshDistance one_sided_distance(std::span<const Vec3> pa, std::span<const Triangle> fa, std::span<const Vec3> pb,
                                       std::span<const Triangle> fb, std::size_t samples) {
    const NearestTriangle nearest(pb, fb);
    std::vector<double> area_before(fa.size() + 1, 0);
    for (std::size_t i = 0; i < fa.size(); ++i) {
        area_before[i + 1] = area_before[i] + norm(cross(pa[fa[i][1]] - pa[fa[i][0]], pa[fa[i][2]] - pa[fa[i][0]]));
    }
    double sum = 0, largest = 0;
    std::size_t f = 0;
    for (std::size_t s = 0; s < samples; ++s) {
        const double at = area_before.back() * (static_cast<double>(s) + 0.5) / static_cast<double>(samples);
        while (f + 1 < fa.size() && area_before[f + 1] < at) ++f;
        double u = std::fmod(0.7548776662466927 * static_cast<double>(s), 1.0);
        double v = std::fmod(0.5698402909980532 * static_cast<double>(s), 1.0);
        if (u + v > 1) {
            u = 1 - u;
            v = 1 - v;
        }
        const Vec3 &a = pa[fa[f][0]], &b = pa[fa[f][1]], &c = pa[fa[f][2]];
        const double d2 = nearest.squared_distance(a + (b - a) * u + (c - a) * v);
        sum += d2;
        largest = std::max(largest, d2);
    }
    return {std::sqrt(sum / static_cast<double>(samples)), std::sqrt(largest)};
}

/// RMS and maximum over both directions, each with the same weight.
inline MeshDistance symmetric_distance(std::span<const Vec3> pa, std::span<const Triangle> fa, std::span<const Vec3> pb,
                                       std::span<const Triangle> fb, std::size_t samples) {
    const MeshDistance there = one_sided_distance(pa, fa, pb, fb, samples);
    const MeshDistance back = one_sided_distance(pb, fb, pa, fa, samples);
    return {std::sqrt(0.5 * (there.rms * there.rms + back.rms * back.rms)), std::max(there.max, back.max)};
}

}  // namespace quadseg::simplify
