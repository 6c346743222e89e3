// The stepwise Segmenter as a Python class.
#pragma once

#include <quadseg/segmentation.h>

#include <pybind11/pybind11.h>

namespace quadseg::python {

/// `to_python`: what segment() returns a result as.
void register_segmenter(pybind11::module_& module, pybind11::dict (*to_python)(Segmentation&&));

}  // namespace quadseg::python
