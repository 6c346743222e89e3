// The points of a fit, centred and scaled to RMS radius 1, as arrays in lanes; in place for small sets, one allocation
// for large ones.
#pragma once

#include "math/vec3.h"
#include "quadric/pack.h"
#include "surface/fit.h"

#include <array>
#include <cstddef>
#include <memory>
#include <span>

namespace quadseg::surface {

inline constexpr std::size_t lane_count = quadric::lanes;

class LocalPoints {
  public:
    explicit LocalPoints(const PointSet& p);
    LocalPoints(const LocalPoints&) = delete;
    LocalPoints& operator=(const LocalPoints&) = delete;

    /// False: no finite extent; nothing can be fitted.
    bool usable() const noexcept { return usable_; }
    std::size_t size() const noexcept { return size_; }
    std::size_t padded() const noexcept { return padded_; }
    Vec3 point(std::size_t i) const noexcept { return {x[i], y[i], z[i]}; }
    Vec3 to_world(const Vec3& u) const noexcept { return u * extent + centre; }
    Surface to_world(const Surface& s) const noexcept;
    Surface to_local(const Surface& s) const noexcept;

    Vec3 centre;
    double extent = 0;  ///< RMS distance from the centre
    double *x = nullptr, *y = nullptr, *z = nullptr;
    double* weight = nullptr;    ///< 0 in the padding
    bool unit_weights = true;    ///< weight is 1 but in the padding
    double* distance = nullptr;  ///< scratch
    double* trial = nullptr;     ///< scratch
    double* sorted = nullptr;    ///< scratch
    std::span<const Vec3> normals;

  private:
    static constexpr std::size_t in_place = 128;
    static constexpr std::size_t arrays = 7;
    alignas(64) std::array<double, in_place * arrays> small_;
    std::unique_ptr<double[]> large_;
    std::size_t size_ = 0, padded_ = 0;
    bool usable_ = false;
};

}  // namespace quadseg::surface
