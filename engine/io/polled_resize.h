// Large arrays are cleared in steps, so that a call stops in time while it makes them.
#pragma once

#include "runtime/run_control.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace quadseg::io {

template <class T>
void polled_resize(std::vector<T>& values, std::size_t count, const runtime::RunControl& control) {
    constexpr std::size_t step = (std::size_t{8} << 20U) / sizeof(T);
    values.reserve(count);
    while (values.size() < count) {
        control.check();
        values.resize(std::min(count, values.size() + step));
    }
}

}  // namespace quadseg::io
