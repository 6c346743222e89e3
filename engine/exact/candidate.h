// A surface that was found on a patch and grown: a claim on faces, to be settled against the others.
#pragma once

#include <quadseg/segmentation.h>

#include "exact/scene.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace quadseg::exact {

struct Candidate {
    Surface surface;
    std::vector<std::uint32_t> faces;  ///< ascending
    std::size_t facets = 0;            ///< different facets among them
    double area = 0;
    double median = 0;  ///< of the |distance| of its vertices
    double gap = 0;     ///< share of the border beyond which the neighbour creeps away
    double step = 0;    ///< 75 % quantile, by area, of the faces' steps, radians
};

inline void append(std::vector<Candidate>& all, std::vector<Candidate>&& more) {
    for (Candidate& candidate : more) all.push_back(std::move(candidate));
}

/// How a face lies to a surface.
struct FaceFit {
    double distance = 0;  ///< largest |distance| of its vertices
    double angle = 0;     ///< of its normal to the surface's, radians; 0 for faces without a normal
    double step = 0;      ///< largest angle between the surface's normals at its vertices, radians
    double allowed = 0;   ///< angle that its size and height explain; infinite for the flattest slivers
    bool within(double tolerance) const noexcept { return distance <= tolerance && angle <= allowed; }
};

}  // namespace quadseg::exact
