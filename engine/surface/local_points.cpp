#include "surface/local_points.h"

#include "surface/surface.h"

#include <algorithm>
#include <cmath>

namespace quadseg::surface {

LocalPoints::LocalPoints(const PointSet& p) : size_(p.points.size()) {
    padded_ = (size_ + lane_count - 1) / lane_count * lane_count;
    double* memory = small_.data();
    if (padded_ > in_place) {
        large_ = std::make_unique_for_overwrite<double[]>(padded_ * arrays);
        memory = large_.get();
    }
    for (double** array : {&x, &y, &z, &weight, &distance, &trial, &sorted}) {
        *array = memory;
        memory += padded_;
    }
    if (p.normals.size() == size_) normals = p.normals;
    if (size_ == 0) return;
    // The mean of differences to the first point: exact for points far from the origin.
    const Vec3 first = p.points[0];
    Vec3 sum;
    for (const Vec3& v : p.points) sum += v - first;
    centre = first + sum / double(size_);
    double square = 0;
    for (const Vec3& v : p.points) square += squared_norm(v - centre);
    extent = std::sqrt(square / double(size_));
    if (!std::isfinite(extent) || !(extent > 0)) return;
    const double scale = 1 / extent;
    if (!std::isfinite(scale)) return;
    usable_ = true;
    const bool weighted = p.weights.size() == size_;
    unit_weights = !weighted;
    for (std::size_t i = 0; i < padded_; ++i) {
        const bool real = i < size_;
        const Vec3 u = real ? (p.points[i] - centre) * scale : Vec3{};
        x[i] = u.x;
        y[i] = u.y;
        z[i] = u.z;
        weight[i] = !real ? 0.0 : weighted ? std::max(p.weights[i], 0.0) : 1.0;
        usable_ = usable_ && std::isfinite(weight[i]);
    }
}

Surface LocalPoints::to_world(const Surface& s) const noexcept {
    Surface t = s;
    t.point = to_array(to_world(to_vec3(s.point)));
    t.radius *= extent;
    t.minor_radius *= extent;
    return t;
}

Surface LocalPoints::to_local(const Surface& s) const noexcept {
    Surface t = s;
    t.point = to_array((to_vec3(s.point) - centre) / extent);
    t.radius /= extent;
    t.minor_radius /= extent;
    return t;
}

}  // namespace quadseg::surface
