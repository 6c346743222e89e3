// Moments summed lane by lane over packs of triangles.
#pragma once

#include "quadric/moments.h"
#include "quadric/pack.h"

namespace quadseg::quadric {

class LaneMoments {
  public:
    /// t: triangle_moments of a pack, n: unit normals.
    void add(const Pack* t, const Pack* n, const Pack& w2, const Pack& w1) noexcept {
        any_ ? put<false>(t, n, w2, w1) : put<true>(t, n, w2, w1);
        any_ = true;
    }
    /// Of some lanes: of the parts of a pack, one after the other.
    void add(std::size_t part, const Part* t, const Parts& n, const Part& w2, const Part& w1) noexcept {
        any_ ? put<false>(part, t, n, w2, w1) : put<true>(part, t, n, w2, w1);
        any_ = any_ || part + 1 == parts;
    }
    void add(std::size_t part, const Part* t, const Parts& n) noexcept {
        any_ ? put<false>(part, t, n) : put<true>(part, t, n);
        any_ = any_ || part + 1 == parts;
    }
    /// The same with unit weights.
    void add(const Pack* t, const Pack* n) noexcept {
        any_ ? put<false>(t, n) : put<true>(t, n);
        any_ = true;
    }
    void sum(Moments& m) const noexcept {
        for (std::size_t i = 0; i < 35; ++i) m.area[i] = any_ ? horizontal_sum(area_[i]) : 0;
        for (std::size_t i = 0; i < 12; ++i) m.normal[i] = any_ ? horizontal_sum(normal_[i]) : 0;
    }

  private:
    /// Most regions are so small that zeros to add the first pack to would cost as much as the sums.
    template <bool first>
    static void put(Pack& sum, const Pack& value) noexcept {
        sum = (first ? Pack{} : sum) + value;
    }
    template <bool first>
    void put(const Pack* t, const Pack* n, const Pack& w2, const Pack& w1) noexcept {
        for (std::size_t i = 0; i < 35; ++i) put<first>(area_[i], w2 * t[i]);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Pack w = w1 * n[axis];
            for (std::size_t k = 0; k < 4; ++k) put<first>(normal_[normal_index(axis, k)], w * t[k]);
        }
    }
    template <bool first>
    void put(const Pack* t, const Pack* n) noexcept {
        for (std::size_t i = 0; i < 35; ++i) put<first>(area_[i], t[i]);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (std::size_t k = 0; k < 4; ++k) put<first>(normal_[normal_index(axis, k)], n[axis] * t[k]);
        }
    }

    template <bool first>
    static void put(std::size_t part, Pack& sum, const Part& value) noexcept {
        Part& some = part_of(sum, part);
        some = (first ? Part{} : some) + value;
    }
    template <bool first>
    void put(std::size_t part, const Part* t, const Parts& n, const Part& w2, const Part& w1) noexcept {
        for (std::size_t i = 0; i < 35; ++i) put<first>(part, area_[i], w2 * t[i]);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Part w = w1 * n[axis];
            for (std::size_t k = 0; k < 4; ++k) put<first>(part, normal_[normal_index(axis, k)], w * t[k]);
        }
    }
    template <bool first>
    void put(std::size_t part, const Part* t, const Parts& n) noexcept {
        for (std::size_t i = 0; i < 35; ++i) put<first>(part, area_[i], t[i]);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (std::size_t k = 0; k < 4; ++k) put<first>(part, normal_[normal_index(axis, k)], n[axis] * t[k]);
        }
    }

    Pack area_[35], normal_[12];  ///< once there are any
    bool any_ = false;
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
