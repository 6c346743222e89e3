// Projection of the vertices onto the surfaces of their regions: section 4.4.3.
#pragma once

#include "flow/final_surfaces.h"
#include "flow/flow.h"
#include "surface/evaluate.h"
#include "surface/quadric_projector.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace quadseg::flow {

/// A region's surface prepared for many foot points.
class SurfaceProjector {
  public:
    explicit SurfaceProjector(const FinalSurface& surface);

    /// The nearest point of the surface; of the best quadric for blends and free-form patches.
    Vec3 foot_point(const Vec3& p) const noexcept;
    /// Signed distance, and the unit normal at the foot point.
    double distance(const Vec3& p) const noexcept;
    Vec3 normal(const Vec3& p) const noexcept;

  private:
    surface::SurfaceEvaluator evaluator_;  ///< plane … torus
    Surface closed_;
    surface::QuadricEvaluator quadric_;  ///< the others, about origin_
    Vec3 origin_;
    bool is_closed_;
};

/// The point nearest to p that lies on all surfaces (Gauss–Newton with the smallest correction at every step); false
/// where they have no common point near p.
bool joint_projection(std::span<const SurfaceProjector* const> surfaces, const Vec3& p, Vec3& result);

/// 3V coordinates in the input's frame and vertex order. A vertex of one region goes to its foot point; one of several
/// to the mean of its foot points (the paper), or with Options::project_joint to the nearest point on all of their
/// surfaces, if there is one near. Vertices at one position (stitched borders) stay together. What would leave the
/// bounding box, enlarged by a hundredth of its diagonal, stays where it is. Vertices of no working face are 0: see
/// UnusedVertices. Throws Stopped.
std::vector<double> projected_positions(const FlowInput& input, const partition::Labels& labels,
                                        const std::vector<FinalSurface>& surfaces);

/// Input vertices that the working mesh does not have; they are not projected.
struct UnusedVertices {
    std::vector<std::size_t> vertex;
    std::vector<double> positions;

    UnusedVertices() = default;
    UnusedVertices(const mesh::WorkMesh& mesh, std::span<const double> input_positions);
    void restore(std::vector<double>& projected) const;
};

}  // namespace quadseg::flow
