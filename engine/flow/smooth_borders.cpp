#include "flow/smooth_borders.h"

#include "partition/face_metric.h"
#include "partition/smooth.h"
#include "surface/evaluate.h"

#include <algorithm>
#include <cmath>

namespace quadseg::flow {

namespace {

/// Lengths below this tell nothing, in diagonals: coordinates are rounded.
constexpr double rounding = 1e-9;

/// RMS distance of a face: of its corners where there is a closed form, by the paper's metric for quadrics.
class FaceDistances {
  public:
    FaceDistances(const mesh::WorkMesh& mesh, const std::vector<FinalSurface>& surfaces)
        : mesh_(mesh), surfaces_(surfaces) {
        evaluators_.reserve(surfaces.size());
        for (const FinalSurface& s : surfaces) {
            evaluators_.push_back(closed(s) ? surface::SurfaceEvaluator(s.surface) : surface::SurfaceEvaluator());
        }
    }

    double operator()(std::uint32_t face, std::int32_t region) const {
        const auto r = static_cast<std::size_t>(region);
        if (closed(surfaces_[r])) {
            double sum = 0;
            for (int k = 0; k < 3; ++k) {
                const double d = evaluators_[r].distance(mesh_.corner(face, k));
                sum += d * d;
            }
            return std::sqrt(sum / 3);
        }
        const double area = mesh_.areas[face];
        if (!(area > 0)) return 0;
        return std::sqrt(
            std::max(partition::face_energy(mesh_, face, surfaces_[r].quadric, true).distance / area, 0.0));
    }

  private:
    static bool closed(const FinalSurface& s) { return s.surface.type <= SurfaceType::torus; }

    const mesh::WorkMesh& mesh_;
    const std::vector<FinalSurface>& surfaces_;
    std::vector<surface::SurfaceEvaluator> evaluators_;
};

}  // namespace

bool smooth_borders(const FlowInput& input, FlowResult& flow, const std::vector<FinalSurface>& surfaces) {
    const FaceDistances distances(input.mesh, surfaces);
    partition::SmoothRules rules;
    rules.band = input.options.smoothing.band;
    rules.lambda = input.options.smoothing.lambda;
    rules.no_distance = std::max(rounding * input.mesh.frame.diagonal, 0.1 * flow.noise);
    const partition::FaceDistance distance = [&](std::uint32_t f, std::int32_t r) { return distances(f, r); };
    try {
        const bool changed = partition::smooth_borders({&input.mesh, input.features, {}}, flow.labels, flow.regions,
                                                       distance, rules, input.control) > 0;
        if (changed) flow.fits.clear();
        return changed;
    } catch (const runtime::Stopped&) {
        return false;
    }
}

}  // namespace quadseg::flow
