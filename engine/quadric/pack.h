// Eight doubles handled as one value, a triangle a lane: the loops over a region's faces are written on packs.
//
// The width is part of the result (sums are made lane by lane, then across in a fixed order), so it is the same for
// every instruction set; a compiler splits a pack into the registers that it has.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>

namespace quadseg::quadric {

inline constexpr std::size_t lanes = 8;

#if defined(__GNUC__)
using Pack = double __attribute__((vector_size(lanes * sizeof(double))));

/// What is computed at once: as much of a pack as leaves its temporaries in registers. What the lanes hold does not
/// depend on it.
#if defined(__AVX512F__)
inline constexpr std::size_t parts = 1;
using Part = Pack;
#else
inline constexpr std::size_t parts = 2;
using Part = double __attribute__((vector_size(lanes / parts * sizeof(double)), may_alias));
#endif

template <class Lanes>
void maximum(const Lanes& a, const Lanes& b, Lanes& out) noexcept {
    out = a > b ? a : b;
}
template <class Lanes>
void minimum(const Lanes& a, const Lanes& b, Lanes& out) noexcept {
    out = a < b ? a : b;
}
/// Adds one to the lanes of `count` where a < b.
template <class Lanes>
void count_below(const Lanes& a, const Lanes& b, Lanes& count) noexcept {
    count += a < b ? Lanes{} + 1.0 : Lanes{};
}
/// value where test > 0, else 0.
template <class Lanes>
void where_positive(const Lanes& test, const Lanes& value, Lanes& out) noexcept {
    out = test > Lanes{} ? value : Lanes{};
}
#else
struct Pack {
    alignas(64) double lane[lanes] = {};
    double& operator[](std::size_t i) noexcept { return lane[i]; }
    double operator[](std::size_t i) const noexcept { return lane[i]; }
};
#define QUADSEG_PACK_OPERATOR(op)                                    \
    inline Pack operator op(const Pack& a, const Pack& b) noexcept { \
        Pack r;                                                      \
        for (std::size_t i = 0; i < lanes; ++i) r[i] = a[i] op b[i]; \
        return r;                                                    \
    }                                                                \
    inline Pack operator op(const Pack& a, double b) noexcept {      \
        Pack r;                                                      \
        for (std::size_t i = 0; i < lanes; ++i) r[i] = a[i] op b;    \
        return r;                                                    \
    }                                                                \
    inline Pack operator op(double a, const Pack& b) noexcept {      \
        Pack r;                                                      \
        for (std::size_t i = 0; i < lanes; ++i) r[i] = a op b[i];    \
        return r;                                                    \
    }
QUADSEG_PACK_OPERATOR(+)
QUADSEG_PACK_OPERATOR(-)
QUADSEG_PACK_OPERATOR(*)
QUADSEG_PACK_OPERATOR(/)
#undef QUADSEG_PACK_OPERATOR
inline constexpr std::size_t parts = 1;
using Part = Pack;
inline Pack& operator+=(Pack& a, const Pack& b) noexcept {
    return a = a + b;
}
inline void maximum(const Pack& a, const Pack& b, Pack& out) noexcept {
    for (std::size_t i = 0; i < lanes; ++i) out[i] = a[i] > b[i] ? a[i] : b[i];
}
inline void minimum(const Pack& a, const Pack& b, Pack& out) noexcept {
    for (std::size_t i = 0; i < lanes; ++i) out[i] = a[i] < b[i] ? a[i] : b[i];
}
inline void count_below(const Pack& a, const Pack& b, Pack& count) noexcept {
    for (std::size_t i = 0; i < lanes; ++i) count[i] += a[i] < b[i] ? 1 : 0;
}
inline void where_positive(const Pack& test, const Pack& value, Pack& out) noexcept {
    for (std::size_t i = 0; i < lanes; ++i) out[i] = test[i] > 0 ? value[i] : 0;
}
#endif

/// Two doubles as one value, where two things go the same way.
#if defined(__GNUC__)
using Pair = double __attribute__((vector_size(2 * sizeof(double))));
#else
struct Pair {
    double lane[2] = {};
    double operator[](std::size_t i) const noexcept { return lane[i]; }
};
inline Pair operator+(const Pair& a, const Pair& b) noexcept {
    return {{a[0] + b[0], a[1] + b[1]}};
}
inline Pair operator*(const Pair& a, const Pair& b) noexcept {
    return {{a[0] * b[0], a[1] * b[1]}};
}
#endif

template <class Lanes>
void square_root(const Lanes& a, Lanes& out) noexcept {
    for (std::size_t i = 0; i < sizeof(Lanes) / sizeof(double); ++i) out[i] = std::sqrt(a[i]);
}

inline const Part& part_of(const Pack& pack, std::size_t part) noexcept {
    return reinterpret_cast<const Part*>(&pack)[part];
}
inline Part& part_of(Pack& pack, std::size_t part) noexcept {
    return reinterpret_cast<Part*>(&pack)[part];
}

inline constexpr std::size_t part_size = lanes / parts;

/// Of consecutive doubles, wherever they lie.
inline Part load_part(const double* from) noexcept {
    Part part;
    std::memcpy(&part, from, sizeof part);
    return part;
}
inline void store_part(double* to, const Part& part) noexcept {
    std::memcpy(to, &part, sizeof part);
}

/// One part of consecutive packs.
class Parts {
  public:
    Parts(const Pack* packs, std::size_t part) noexcept : first_(&part_of(packs[0], part)) {}
    const Part& operator[](std::size_t i) const noexcept { return first_[parts * i]; }

  private:
    const Part* first_;
};

/// The lanes' sum, in an order that does not depend on the compiler.
inline double horizontal_sum(const Pack& a) noexcept {
    return ((a[0] + a[1]) + (a[2] + a[3])) + ((a[4] + a[5]) + (a[6] + a[7]));
}

}  // namespace quadseg::quadric
