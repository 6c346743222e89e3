// Regions as rows of a NumPy structured array.
#pragma once

#include <quadseg/segmentation.h>

#include <cstdint>
#include <pybind11/numpy.h>
#include <vector>

namespace quadseg::python {

struct RegionRecord {
    std::int32_t id, type, surface_id;
    bool valid, outward;
    std::uint64_t faces;
    double area, rms, max, energy;
    double coefficients[10];
    double point[3], axis[3];
    double radius, minor_radius, half_angle;
    double axes[9], semi_axes[3];
};

std::vector<RegionRecord> to_records(const std::vector<Region>& regions);
/// To be called once, when the module is loaded.
void register_records();

}  // namespace quadseg::python
