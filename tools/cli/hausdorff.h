// Distances between two surfaces, measured as Metro does (Cignoni, Rocchini, Scopigno: Metro: measuring error on
// simplified surfaces, 1998): from samples on each to the nearest point of the other.
#pragma once

#include <quadseg/context.h>
#include <quadseg/mesh.h>

#include <array>
#include <cstddef>
#include <vector>

namespace quadseg::cli {

/// From samples on one mesh to the surface of the other, input unit.
struct OneSidedDistance {
    double max = 0;                    ///< over surface samples and vertices
    std::array<double, 3> farthest{};  ///< the sample of the largest distance (the first one)
    double mean = 0, rms = 0;          ///< over the surface samples: each stands for the same area
    std::size_t surface_samples = 0, vertex_samples = 0;
    double area = 0;  ///< of the sampled mesh
};

struct MeshDistance {
    OneSidedDistance forward, backward;  ///< A to B, B to A
    double max = 0;                      ///< the larger of both: the Hausdorff distance
    double mean = 0, rms = 0;            ///< over both surfaces together, by area
    double diagonal = 0;                 ///< of A's bounding box
};

/// About `samples` surface samples a mesh, spread evenly over the area by a fixed rule, and every vertex of a face.
/// Nearest points come from Embree's hierarchy over boxes; each distance is computed in double. Both meshes must have
/// been checked (inspect()). Deterministic at any thread count. Throws Error (invalid_mesh, cancelled).
MeshDistance measure_mesh_distance(const MeshView& a, const MeshView& b, std::size_t samples, const Context& context);

/// Distance of every vertex of A from the surface of B, input unit; as exact as measure_mesh_distance().
std::vector<double> vertex_distances(const MeshView& a, const MeshView& b, const Context& context);

/// Nearest point of the triangle to p.
std::array<double, 3> nearest_on_triangle(const std::array<double, 3>& p, const std::array<double, 3>& a,
                                          const std::array<double, 3>& b, const std::array<double, 3>& c);

}  // namespace quadseg::cli
