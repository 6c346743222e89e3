#include "tools/python/native/options.h"

#include <quadseg/error.h>

#include <string>

namespace quadseg::python {

namespace py = pybind11;

namespace {

[[noreturn]] void wrong(const std::string& name, const std::string& problem) {
    throw Error(ErrorCode::invalid_argument, name + ": " + problem);
}

template <class Value>
Value value_of(const std::string& name, const py::handle& value) {
    try {
        return value.cast<Value>();
    } catch (const py::cast_error&) {
        wrong(name, "has the wrong type or is out of range: " + py::repr(value).cast<std::string>());
    }
}

template <class Enum>
Enum name_of(const std::string& name, const py::handle& value) {
    Enum result{};
    if (!from_string(value_of<std::string>(name, value), result)) {
        wrong(name, "there is no " + py::repr(value).cast<std::string>());
    }
    return result;
}

/// Sets the field that the name names; false if there is none.
bool set_paper(PaperOptions& p, const std::string& name, const py::handle& value) {
    const auto set = [&](const char* field, auto& target) {
        if (name != field) return false;
        target = value_of<std::remove_reference_t<decltype(target)>>("paper." + name, value);
        return true;
    };
    return set("lloyd_iterations", p.lloyd_iterations) || set("convergence", p.convergence) ||
           set("plane_tolerance", p.plane_tolerance) || set("merge_tolerance", p.merge_tolerance) ||
           set("initial_regions", p.initial_regions) || set("merging", p.merging) ||
           set("teleportation", p.teleportation) || set("teleportations", p.teleportations) ||
           set("energy_threshold", p.energy_threshold) || set("maximum_regions", p.maximum_regions);
}

bool set_option(Options& o, const std::string& name, const py::handle& value) {
    const auto set = [&](const char* field, auto& target) {
        if (name != field) return false;
        target = value_of<std::remove_reference_t<decltype(target)>>(name, value);
        return true;
    };
    if (name == "preset") {
        o.preset = name_of<Preset>(name, value);
        return true;
    }
    if (name == "method") {
        o.method = name_of<Method>(name, value);
        return true;
    }
    return set("regions", o.regions) || set("tolerance", o.tolerance) || set("detail", o.detail) ||
           set("feature_angle", o.feature_angle) || set("weight", o.weight) || set("seed", o.seed) ||
           set("coarse", o.coarse) || set("smooth", o.smooth) || set("project", o.project) ||
           set("project_joint", o.project_joint) || set("regularities", o.regularities) ||
           set("smoothing_band", o.smoothing.band) || set("smoothing_lambda", o.smoothing.lambda);
}

}  // namespace

Options to_options(const py::dict& given) {
    Options options;
    for (const auto& [key, value] : given) {
        const auto name = key.cast<std::string>();
        if (name == "paper") {
            for (const auto& [paper_key, paper_value] : value_of<py::dict>(name, value)) {
                const auto paper_name = value_of<std::string>("paper", paper_key);
                if (!set_paper(options.paper, paper_name, paper_value)) wrong("paper." + paper_name, "no such option");
            }
        } else if (!set_option(options, name, value)) {
            wrong(name, "no such option");
        }
    }
    return options;
}

}  // namespace quadseg::python
