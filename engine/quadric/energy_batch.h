// Energies of many pairs of a triangle and a proxy at once, where relaxation compares them: a pair a lane.
#pragma once

#include "math/vec3.h"
#include "quadric/pack_energy.h"
#include "quadric/region_fit.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace quadseg::quadric {

/// Pairs are added, evaluated together, and read by the number that add() gave. Values are those of triangle_energy()
/// but for rounding, and depend on the pair alone. Not thread-safe; no memory is allocated.
class EnergyBatch {
  public:
    static constexpr std::size_t capacity = 128;

    explicit EnergyBatch(double weight) noexcept : weight_(weight) {}

    void clear() noexcept { size_ = quadrics_ = 0; }
    /// At most `capacity` pairs between two clear().
    std::size_t add(const Proxy& proxy, const Vec3& v0, const Vec3& v1, const Vec3& v2, const Vec3& n,
                    double area) noexcept;
    void evaluate() noexcept;
    /// E_d + ω E_n.
    double hybrid(std::size_t pair) const noexcept { return hybrid_[pair]; }

  private:
    struct Slot {
        FacePack face;
        Pack c[10];
        Pack floor;
    };
    double weight_;
    std::size_t size_ = 0, quadrics_ = 0;
    std::array<double, capacity> hybrid_;
    std::array<std::uint8_t, capacity> pair_of_;  ///< of the quadrics; planes are evaluated at once
    std::array<Slot, capacity / lanes> slots_;
};

}  // namespace quadseg::quadric
