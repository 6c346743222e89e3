// Structs whose first field is their size, so that they can grow without breaking programs made for older headers.
#pragma once

#include <quadseg/quadseg.h>

#include "capi/last_error.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace quadseg::capi {

// Sizes in the first version of the interface: no caller has smaller ones. Never change them; new fields come after.
template <class Struct>
inline constexpr std::size_t first_size = 0;
template <>
inline constexpr std::size_t first_size<quadseg_mesh_view> = 48;
template <>
inline constexpr std::size_t first_size<quadseg_mesh_report> = 184;
template <>
inline constexpr std::size_t first_size<quadseg_options> = 160;
template <>
inline constexpr std::size_t first_size<quadseg_summary> = 168;
template <>
inline constexpr std::size_t first_size<quadseg_region> = 312;
template <>
inline constexpr std::size_t first_size<quadseg_regularity> = 24;

/// A name for messages.
template <class Struct>
quadseg_status wrong_size(const char* name, std::size_t size) noexcept {
    return fail(QUADSEG_INVALID_ARGUMENT, "%s: struct_size must be sizeof(%s), at least %zu, but is %zu", name, name,
                first_size<Struct>, size);
}

/// Reads a caller's struct over the defaults in `ours`. What a newer caller set beyond our fields must be zero.
template <class Struct>
quadseg_status copy_in(const char* name, const Struct& theirs, Struct& ours) noexcept {
    static_assert(first_size<Struct> > 0 && first_size<Struct> <= sizeof(Struct));
    const std::size_t size = theirs.struct_size;
    if (size < first_size<Struct>) return wrong_size<Struct>(name, size);
    const auto* bytes = reinterpret_cast<const unsigned char*>(&theirs);
    const std::size_t known = std::min(size, sizeof(Struct));
    if (std::any_of(bytes + known, bytes + size, [](unsigned char byte) { return byte != 0; })) {
        return fail(QUADSEG_INVALID_ARGUMENT, "%s: has fields set that this version of the library does not know",
                    name);
    }
    std::memcpy(&ours, bytes, known);
    ours.struct_size = static_cast<std::uint32_t>(sizeof(Struct));
    return QUADSEG_OK;
}

/// Writes `ours` into `size` bytes of the caller's: cut for an older caller, filled with zeros for a newer one.
template <class Struct>
void write_bytes(const Struct& ours, void* theirs, std::size_t size) noexcept {
    const std::size_t known = std::min(size, sizeof(Struct));
    std::memcpy(theirs, &ours, known);
    std::memset(static_cast<unsigned char*>(theirs) + known, 0, size - known);
}

/// Fills a caller's struct and keeps its struct_size.
template <class Struct>
quadseg_status copy_out(const char* name, Struct ours, Struct* theirs) noexcept {
    static_assert(first_size<Struct> > 0 && first_size<Struct> <= sizeof(Struct));
    const std::uint32_t size = theirs->struct_size;
    if (size < first_size<Struct>) return wrong_size<Struct>(name, size);
    ours.struct_size = size;
    write_bytes(ours, theirs, size);
    return QUADSEG_OK;
}

}  // namespace quadseg::capi
