// CAD-like solids of any size whose true surfaces are known, for tests, benchmarks and demonstrations.
#pragma once

#include <quadseg/context.h>
#include <quadseg/mesh.h>
#include <quadseg/segmentation.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace quadseg::datasets {

/// One edge-connected part of the boundary on one analytic surface: what a perfect segmentation calls a region.
struct TrueSurface {
    Surface surface;  ///< exact; coefficients are set for every type but the torus, |∇f| = 1 somewhere on the surface
    std::int32_t analytic = 0;  ///< equal for parts of one analytic surface that do not touch
    std::size_t triangles = 0;
    double area = 0;  ///< of its triangles without noise
};

struct Generated {
    Mesh mesh;  ///< closed, manifold, outward; every vertex on all surfaces of its triangles (before noise)
    std::vector<std::int32_t> truth;  ///< F indices into surfaces
    std::vector<TrueSurface> surfaces;
    double diagonal = 0;  ///< of the bounding box without noise
};

struct Recipe {
    std::string name = "plate";
    std::size_t faces = 20000;  ///< wanted; the mesh has about as many (within 10 % from 1,000 on)
    double noise = 0;           ///< standard deviation along the vertex normals, relative to the diagonal
    std::uint64_t seed = 1;     ///< of the random dimensions, the irregularity of the triangles, noise and shuffling
    bool shuffle = false;       ///< random order of triangles and vertices
};

/// Names that generate() knows.
std::vector<std::string> generator_names();

/// Deterministic. Throws Error invalid_argument (unknown name, faces outside 500 … 50,000,000, noise outside 0 … 0.1).
Generated generate(const Recipe& recipe);
Generated generate(const std::string& name, std::size_t faces, double noise = 0, std::uint64_t seed = 1);

/// The ground truth as JSON, in the format that the evaluators read (tools/README.md).
std::string ground_truth_json(const Generated& generated, const Recipe& recipe);

}  // namespace quadseg::datasets
