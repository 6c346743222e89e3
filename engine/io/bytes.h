// Numbers in binary files, in either byte order.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace quadseg::io {

template <std::size_t Size>
struct UnsignedOf;
template <>
struct UnsignedOf<1> {
    using Type = std::uint8_t;
};
template <>
struct UnsignedOf<2> {
    using Type = std::uint16_t;
};
template <>
struct UnsignedOf<4> {
    using Type = std::uint32_t;
};
template <>
struct UnsignedOf<8> {
    using Type = std::uint64_t;
};

constexpr std::uint8_t reverse_bytes(std::uint8_t v) noexcept {
    return v;
}
constexpr std::uint16_t reverse_bytes(std::uint16_t v) noexcept {
    return __builtin_bswap16(v);
}
constexpr std::uint32_t reverse_bytes(std::uint32_t v) noexcept {
    return __builtin_bswap32(v);
}
constexpr std::uint64_t reverse_bytes(std::uint64_t v) noexcept {
    return __builtin_bswap64(v);
}

/// A number that lies at p in the byte order of the file.
template <class T, std::endian Order>
T load(const char* p) noexcept {
    typename UnsignedOf<sizeof(T)>::Type bits;
    std::memcpy(&bits, p, sizeof bits);
    if constexpr (Order != std::endian::native) bits = reverse_bytes(bits);
    return std::bit_cast<T>(bits);
}

template <class T>
void store_little_endian(char* p, T value) noexcept {
    auto bits = std::bit_cast<typename UnsignedOf<sizeof(T)>::Type>(value);
    if constexpr (std::endian::native != std::endian::little) bits = reverse_bytes(bits);
    std::memcpy(p, &bits, sizeof bits);
}

}  // namespace quadseg::io
