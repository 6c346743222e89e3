// The partition that the exact stage builds: regions with surfaces, and faces that are still free.
#pragma once

#include <quadseg/segmentation.h>

#include "exact/scene.h"

#include <cstdint>
#include <vector>

namespace quadseg::exact {

struct Explained {
    std::vector<std::int32_t> region;  ///< of a face; −1: free
    std::vector<Surface> surface;      ///< of a region
    /// The regions as separate_parts() left them: where nothing has changed since, there is nothing to separate.
    std::vector<std::int32_t> separate;
    std::size_t separate_count = 0;

    std::int32_t add(const Surface& s) {
        surface.push_back(s);
        return static_cast<std::int32_t>(surface.size() - 1);
    }
};

/// Makes every edge-connected part of a region a region of its own (same surface) and renumbers by first face.
void separate_parts(const Scene& scene, Explained& state);

/// Edge-connected sets of free faces, creases not crossed when `within_creases`: by first face, faces ascending.
std::vector<std::vector<std::uint32_t>> free_components(const Scene& scene, const Explained& state,
                                                        bool within_creases);

}  // namespace quadseg::exact
