#include "tools/python/native/records.h"

#include <algorithm>

namespace quadseg::python {

std::vector<RegionRecord> to_records(const std::vector<Region>& regions) {
    std::vector<RegionRecord> records(regions.size());
    std::transform(regions.begin(), regions.end(), records.begin(), [](const Region& region) {
        const Surface& s = region.surface;
        RegionRecord r{};
        r.id = region.id;
        r.type = static_cast<std::int32_t>(s.type);
        r.surface_id = region.surface_id;
        r.valid = region.valid;
        r.outward = s.outward;
        r.faces = region.faces;
        r.area = region.area;
        r.rms = region.rms;
        r.max = region.max;
        r.energy = region.energy;
        std::copy(s.coefficients.begin(), s.coefficients.end(), r.coefficients);
        std::copy(s.point.begin(), s.point.end(), r.point);
        std::copy(s.axis.begin(), s.axis.end(), r.axis);
        r.radius = s.radius;
        r.minor_radius = s.minor_radius;
        r.half_angle = s.half_angle;
        std::copy(s.axes.begin(), s.axes.end(), r.axes);
        std::copy(s.semi_axes.begin(), s.semi_axes.end(), r.semi_axes);
        return r;
    });
    return records;
}

void register_records() {
    PYBIND11_NUMPY_DTYPE(RegionRecord, id, type, surface_id, valid, outward, faces, area, rms, max, energy,
                         coefficients, point, axis, radius, minor_radius, half_angle, axes, semi_axes);
}

}  // namespace quadseg::python
