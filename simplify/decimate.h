// Quadric-error decimation to a target count, with a map from every input face to a face of the result. Knows only
// arrays.
#pragma once

#include "math/vec3.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace quadseg::simplify {

struct Decimated {
    std::vector<Vec3> positions;
    std::vector<std::array<std::uint32_t, 3>> faces;
    /// For every input face the face of the result that stands for it: nearest, with a similar normal.
    std::vector<std::uint32_t> face_map;
    double max_error = 0;  ///< largest root of a collapse's quadric error, input unit
};

struct DecimateOptions {
    std::size_t target_faces = 0;
    double feature_degrees = 30;  ///< edges sharper than this, and borders, are kept in place by constraint quadrics
    /// Polled, from any thread; true: stops early with what is done (valid mesh). What it throws leaves decimate().
    std::function<bool()> should_stop;
};

/// Parallel and deterministic: the same result at any thread count. Faces must index positions; non-manifold edges and
/// borders are kept. Runs in the caller's TBB arena. Source: Garland and Heckbert 1997.
Decimated decimate(std::span<const Vec3> positions, std::span<const std::array<std::uint32_t, 3>> faces,
                   const DecimateOptions& options);

}  // namespace quadseg::simplify
