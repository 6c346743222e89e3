// Options from Python keywords.
#pragma once

#include <quadseg/options.h>

#include <pybind11/pybind11.h>

namespace quadseg::python {

/// Names are those of the fields of Options; "paper" is a dict of those of PaperOptions. Throws Error invalid_argument
/// for unknown names and wrong types; ranges are checked by the call.
Options to_options(const pybind11::dict& given);

}  // namespace quadseg::python
