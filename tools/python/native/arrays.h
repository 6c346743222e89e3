// NumPy arrays that own C++ buffers, and views of the caller's arrays.
#pragma once

#include <quadseg/mesh.h>

#include <cstdint>
#include <memory>
#include <pybind11/numpy.h>
#include <span>
#include <utility>
#include <vector>

namespace quadseg::python {

// Exactly these: the Python side has converted everything else, with checks.
using DoubleArray = pybind11::array_t<double, pybind11::array::c_style>;
using IndexArray = pybind11::array_t<std::uint32_t, pybind11::array::c_style>;
using LabelArray = pybind11::array_t<std::int32_t, pybind11::array::c_style>;
using ByteArray = pybind11::array_t<std::uint8_t, pybind11::array::c_style>;

/// The vector becomes the buffer of the array; nothing is copied. `columns` 0: one dimension.
template <class Number>
pybind11::array_t<Number> to_numpy(std::vector<Number>&& values, std::size_t columns = 0) {
    auto owned = std::make_unique<std::vector<Number>>(std::move(values));
    auto* const buffer = owned.get();
    const pybind11::capsule owner(owned.release(), [](void* p) { delete static_cast<std::vector<Number>*>(p); });
    std::vector<pybind11::ssize_t> shape{static_cast<pybind11::ssize_t>(buffer->size())};
    if (columns > 0) {
        shape = {static_cast<pybind11::ssize_t>(buffer->size() / columns), static_cast<pybind11::ssize_t>(columns)};
    }
    return pybind11::array_t<Number>(shape, buffer->data(), owner);
}

template <class Array>
std::span<const typename Array::value_type> view_of(const Array& array) {
    return {array.data(), static_cast<std::size_t>(array.size())};
}

}  // namespace quadseg::python
