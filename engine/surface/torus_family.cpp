#include "surface/torus_family.h"

#include "surface/evaluate.h"
#include "surface/fit_starts.h"
#include "surface/local_points.h"
#include "surface/median.h"
#include "surface/shape_frame.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace quadseg::surface {

namespace {

constexpr std::size_t most_starts = 18;
struct Start {
    Surface surface;
    double error = 0;  ///< median distance
};

class Starts {
  public:
    explicit Starts(LocalPoints& points) : points_(points) {
        add(start_sphere(points_));
        add(start_plane(points_));
        add_from_normals();
    }

    void add_from_normals() {
        const Surface cylinder = start_cylinder(points_);
        const TorusAxes axes(points_);
        add(cylinder);
        add(start_torus_from(cylinder, points_));
        add(start_cone(points_));
        add(start_cone_from(cylinder, points_));
        add(start_cylinder_along(points_));
        for (int rank = 0; rank < 3; ++rank) add(axes.start(points_, rank));
    }

    /// By rising error: nine of ten patches of a surface need only the first.
    std::span<const Start> sorted() {
        std::stable_sort(start_.begin(), start_.begin() + static_cast<std::ptrdiff_t>(count_),
                         [](const Start& a, const Start& b) { return a.error < b.error; });
        return {start_.data(), count_};
    }

  private:
    void add(const Surface& s) {
        SurfaceEvaluator(s).visit([&](const auto& e) {
            for (std::size_t i = 0; i < points_.size(); ++i) points_.trial[i] = e.distance(points_.point(i));
        });
        const double error = median_magnitude(points_.trial, points_.size(), points_.sorted);
        if (std::isfinite(error)) start_[count_++] = {s, error};
    }

    LocalPoints& points_;
    std::array<Start, most_starts> start_;
    std::size_t count_ = 0;
};

}  // namespace

bool may_lie_on_torus(const PointSet& p, std::span<const Vec3> more_normals, const Closeness& goal,
                      const FitOptions& options) {
    LocalPoints points(p);
    if (!points.usable() || points.normals.empty()) return true;
    Starts starts(points);
    if (more_normals.size() == points.size()) {
        points.normals = more_normals;
        starts.add_from_normals();
    }
    for (const Start& start : starts.sorted()) {
        ShapeFrame frame;
        if (!frame_of(start.surface, anchor(start.surface, points), SurfaceType::torus, frame)) continue;
        if (adjust_towards(goal, frame, points, options).close) return true;
    }
    return false;
}

}  // namespace quadseg::surface
