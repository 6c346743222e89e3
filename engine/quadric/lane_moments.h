// Moments summed lane by lane over packs of triangles.
#pragma once

#include "quadric/moments.h"
#include "quadric/pack.h"

namespace quadseg::quadric {

struct LaneMoments {
    Pack area[35]{};
    Pack normal[12]{};

    /// t: triangle_moments of a pack, n: unit normals.
    void add(const Pack* t, const Pack* n, const Pack& w2, const Pack& w1) noexcept {
        for (std::size_t i = 0; i < 35; ++i) area[i] += w2 * t[i];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Pack w = w1 * n[axis];
            for (std::size_t k = 0; k < 4; ++k) normal[normal_index(axis, k)] += w * t[k];
        }
    }
    /// The same with unit weights.
    void add(const Pack* t, const Pack* n) noexcept {
        for (std::size_t i = 0; i < 35; ++i) area[i] += t[i];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (std::size_t k = 0; k < 4; ++k) normal[normal_index(axis, k)] += n[axis] * t[k];
        }
    }
    void sum(Moments& m) const noexcept {
        for (std::size_t i = 0; i < 35; ++i) m.area[i] = horizontal_sum(area[i]);
        for (std::size_t i = 0; i < 12; ++i) m.normal[i] = horizontal_sum(normal[i]);
    }
};

/// The parts of Moments that weights leave alone: ∫n nᵀ, the area, and the area of faces that have a normal.
struct LaneAreas {
    Pack normal2[6]{};
    Pack total{};

    void add(const Pack& area, const Pack* n) noexcept {
        const Pack x = area * n[0], y = area * n[1];
        normal2[0] += x * n[0];
        normal2[1] += x * n[1];
        normal2[2] += x * n[2];
        normal2[3] += y * n[1];
        normal2[4] += y * n[2];
        normal2[5] += area * n[2] * n[2];
        total += area;
    }
    void sum(Moments& m) const noexcept {
        for (std::size_t i = 0; i < 6; ++i) m.normal2[i] = horizontal_sum(normal2[i]);
        m.total_area = horizontal_sum(total);
        m.normal_area = m.normal2[0] + m.normal2[3] + m.normal2[5];
    }
};

}  // namespace quadseg::quadric
