// The project's own random numbers: the same on every platform, unlike the distributions of the standard library.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace quadseg::datasets {

/// PCG-XSH-RR 64/32 (O'Neill 2014).
class Pcg {
  public:
    explicit Pcg(std::uint64_t seed, std::uint64_t stream = 1) : increment_((stream << 1U) | 1U) {
        next();
        state_ += seed;
        next();
    }

    std::uint32_t next() noexcept {
        const std::uint64_t old = state_;
        state_ = old * 6364136223846793005ULL + increment_;
        const auto shifted = static_cast<std::uint32_t>(((old >> 18U) ^ old) >> 27U);
        const auto rotation = static_cast<std::uint32_t>(old >> 59U);
        return (shifted >> rotation) | (shifted << ((32U - rotation) & 31U));
    }
    /// In [0, 1).
    double uniform() noexcept { return next() * 0x1p-32; }
    double uniform(double low, double high) noexcept { return low + (high - low) * uniform(); }
    /// In [0, bound), bound > 0.
    std::uint32_t below(std::uint32_t bound) noexcept {
        return static_cast<std::uint32_t>((static_cast<std::uint64_t>(next()) * bound) >> 32U);
    }
    /// Standard normal, by Box and Muller.
    double gaussian() noexcept {
        const double radius = std::sqrt(-2 * std::log(1 - uniform()));
        return radius * std::cos(2 * std::numbers::pi * uniform());
    }

  private:
    std::uint64_t state_ = 0;
    std::uint64_t increment_;
};

}  // namespace quadseg::datasets
