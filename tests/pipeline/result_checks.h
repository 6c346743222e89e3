// What every result of segment() must fulfil, and its bytes for comparisons.
#pragma once

#include <quadseg/segmentation.h>

#include "mesh/work_mesh.h"
#include "partition/leaves.h"
#include "runtime/run_control.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

namespace quadseg::test {

/// Everything in a result but what was measured of the machine: times, threads, memory.
class ResultBytes {
  public:
    static std::string of(const Segmentation& s) {
        ResultBytes b;
        b.list(s.labels);
        b.list(s.unlabelled);
        for (const Region& r : s.regions) b.region(r);
        b.all(s.energy.total, s.energy.distance, s.energy.normal, s.rms, s.max, s.stop, s.partial, s.noise);
        for (const MergeStep& step : s.history) b.all(step.regions, step.energy);
        b.list(s.energies);
        for (const Regularity& r : s.regularities) {
            b.all(r.kind, r.snapped);
            b.list(r.regions);
        }
        b.list(s.projected);
        b.all(s.borders_before.length, s.borders_before.zigzag, s.borders_after.length, s.borders_after.zigzag);
        b.all(s.input.components, s.input.stitched_edges, s.input.flipped_faces, s.input.area, s.input.diagonal);
        return b.bytes_;
    }

  private:
    template <class T>
    void add(const T& value) {
        static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>, "no padding");
        char raw[sizeof value];
        std::memcpy(raw, &value, sizeof value);
        bytes_.append(raw, sizeof value);
    }
    template <class... T>
    void all(const T&... values) {
        (add(values), ...);
    }
    template <class List>
    void list(const List& values) {
        add(values.size());
        for (const auto& v : values) add(v);
    }
    void region(const Region& r) {
        all(r.id, r.surface.type, r.surface.radius, r.surface.minor_radius, r.surface.half_angle, r.surface.outward);
        list(r.surface.coefficients);
        list(r.surface.point);
        list(r.surface.axis);
        list(r.surface.axes);
        list(r.surface.semi_axes);
        all(r.faces, r.area, r.rms, r.max, r.energy, r.surface_id, r.valid);
    }

    std::string bytes_;
};

/// First violated rule, or empty. A sentence instead of gtest's macros, so that fuzz targets share it.
inline std::string broken_rule(const MeshView& input, const Segmentation& s) {
    std::ostringstream wrong;
    const auto finite = [&](double v, const char* what) {
        if (!std::isfinite(v)) wrong << what << " is not finite; ";
    };
    const auto in_order = [&](double rms, double max, const char* what) {
        if (!(rms >= 0 && max >= 0 && rms <= max * (1 + 1e-9) + 1e-300)) {
            wrong << what << ": rms " << rms << " exceeds max " << max << "; ";
        }
    };
    if (s.labels.size() != input.face_count()) return "not one label a face";
    if (s.regions.empty()) return "no regions";
    const auto count = static_cast<std::int32_t>(s.regions.size());
    std::vector<std::size_t> faces(s.regions.size(), 0);
    std::vector<std::uint32_t> unlabelled;
    for (std::size_t f = 0; f < s.labels.size(); ++f) {
        if (s.labels[f] < -1 || s.labels[f] >= count) return "label " + std::to_string(s.labels[f]) + " has no region";
        if (s.labels[f] < 0) {
            unlabelled.push_back(static_cast<std::uint32_t>(f));
        } else {
            ++faces[static_cast<std::size_t>(s.labels[f])];
        }
    }
    if (unlabelled != s.unlabelled) return "the faces without a label are not those listed";
    for (std::size_t r = 0; r < s.regions.size() && wrong.tellp() < 400; ++r) {
        const Region& region = s.regions[r];
        if (region.id != static_cast<std::int32_t>(r)) wrong << "region " << r << " has id " << region.id << "; ";
        if (region.faces != faces[r]) {
            wrong << "region " << r << " says " << region.faces << " faces, " << faces[r] << " are labelled so; ";
        }
        if (region.surface_id < 0 || region.surface_id >= count) wrong << "surface id out of range; ";
        finite(region.area, "area");
        finite(region.rms, "rms");
        finite(region.max, "max");
        finite(region.energy, "energy");
        in_order(region.rms, region.max, "region");
        for (const double v : region.surface.coefficients) finite(v, "coefficient");
        for (const double v : region.surface.point) finite(v, "point");
        for (const double v : region.surface.axis) finite(v, "axis");
        for (const double v : region.surface.axes) finite(v, "principal axis");
        for (const double v : region.surface.semi_axes) finite(v, "semi-axis");
        finite(region.surface.radius, "radius");
        finite(region.surface.minor_radius, "minor radius");
        finite(region.surface.half_angle, "half angle");
    }
    finite(s.rms, "rms of all");
    finite(s.max, "max of all");
    finite(s.energy.total, "energy of all");
    finite(s.noise, "noise");
    in_order(s.rms, s.max, "all");
    for (const double v : s.energies) finite(v, "energy of an iteration");
    std::vector<std::uint8_t> used(input.vertex_count(), 0);
    for (const std::uint32_t v : input.triangles) used[v] = 1;
    for (std::size_t i = 0; i < s.projected.size(); ++i) {
        if (used[i / 3]) finite(s.projected[i], "projected position");
    }
    if (!s.projected.empty() && s.projected.size() != input.positions.size()) wrong << "not 3V projected positions; ";

    // A run stopped before there was an adjacency has one region of everything. Polygons bind faces across edges.
    const bool before_any = s.partial && s.input.components == 0;
    if (!before_any && input.polygons.empty()) {
        const mesh::WorkMesh mesh = mesh::build_work_mesh(input, runtime::RunControl(nullptr));
        partition::Labels parts = mesh::labels_from_input(mesh, s.labels);
        for (const std::int32_t label : parts) {
            if (label < 0) return "a sound face has no label";
        }
        const std::size_t pieces = partition::connected_parts({&mesh, nullptr, {}}, parts);
        if (pieces != s.regions.size()) {
            wrong << s.regions.size() << " regions have " << pieces << " edge-connected pieces; ";
        }
    }
    return wrong.str();
}

/// Share of the area on which two partitions agree, each region of `a` matched with the region of `b` it overlaps most.
inline double area_agreement(const MeshView& mesh, const std::vector<std::int32_t>& a,
                             const std::vector<std::int32_t>& b) {
    std::map<std::pair<std::int32_t, std::int32_t>, double> overlap;
    double total = 0;
    for (std::size_t f = 0; f < a.size(); ++f) {
        const auto corner = [&](std::size_t k) {
            const double* p = &mesh.positions[3 * std::size_t{mesh.triangles[3 * f + k]}];
            return Vec3{p[0], p[1], p[2]};
        };
        const double area = norm(cross(corner(1) - corner(0), corner(2) - corner(0)));
        overlap[{a[f], b[f]}] += area;
        total += area;
    }
    std::map<std::int32_t, double> best_of_a, best_of_b;
    for (const auto& [pair, area] : overlap) {
        best_of_a[pair.first] = std::max(best_of_a[pair.first], area);
        best_of_b[pair.second] = std::max(best_of_b[pair.second], area);
    }
    double by_a = 0, by_b = 0;
    for (const auto& entry : best_of_a) by_a += entry.second;
    for (const auto& entry : best_of_b) by_b += entry.second;
    return total > 0 ? std::min(by_a, by_b) / total : 1;
}

}  // namespace quadseg::test
