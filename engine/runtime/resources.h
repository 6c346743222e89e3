// What a call has taken of the machine: time and memory. No state, so that the programs measure likewise.
#pragma once

#include <chrono>
#include <cstddef>
#include <sys/resource.h>

namespace quadseg::runtime {

inline double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Of the whole process, from its beginning.
inline std::size_t peak_resident_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

}  // namespace quadseg::runtime
