#include "quadric/region_fit.h"

#include "quadric/fit.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace quadseg::quadric {
namespace {

constexpr double floor_share = 0.05;  // of the median |∇f⁰(c_t)| (MATH.md §3)

class RegionFitter {
  public:
    RegionFitter(const TriangleSoup& region, const RegionFitOptions& options) : soup_(region), options_(options) {
        Vec3 moment{};
        for (std::size_t t = 0; t < region.size(); ++t) {
            const double a = region.areas[t];
            if (!(a > 0)) continue;
            area_ += a;
            moment += (corner(t, 0) + corner(t, 1) + corner(t, 2)) * (a / 3);
        }
        if (!(area_ > 0)) return;
        centre_ = moment / area_;
        Moments m;
        for (std::size_t t = 0; t < region.size(); ++t) {
            if (!(region.areas[t] > 0)) continue;
            accumulate(m, corner(t, 0) - centre_, corner(t, 1) - centre_, corner(t, 2) - centre_, region.normals[t],
                       region.areas[t]);
        }
        const double radius = spread(m).radius;
        if (!(radius > 0)) {
            area_ = 0;
            return;
        }
        scale_ = 1 / radius;
        moments_ = scaled(m, scale_);
        weight_ = scaled_weight(options.weight, scale_);
    }

    RegionFit run() {
        if (!(area_ > 0)) return degenerate();
        RegionFit best = planar();
        const double tolerance = options_.plane_tolerance * (options_.plane_tolerance_per_area ? area_ : 1);
        if (best.total <= tolerance) return best;
        offer(fit_taubin(moments_), best);
        if (options_.best_of && weight_ > 0) offer(fit_least_squares(moments_, weight_), best);
        return best;
    }

  private:
    Vec3 corner(std::size_t t, std::size_t k) const { return soup_.corners[3 * t + k]; }

    RegionFit degenerate() const {
        RegionFit fit;
        if (soup_.size() > 0) {
            fit.proxy = plane_proxy(corner(0, 0), soup_.normals[0]);
        } else {
            fit.proxy = plane_proxy({}, {0, 0, 1});
        }
        return fit;
    }

    RegionFit planar() const {
        RegionFit fit;
        const QuadricFit local = fit_plane(moments_, weight_);
        fit.proxy = plane_proxy(centre_, {local.c[1], local.c[2], local.c[3]});
        fit.proxy.c[0] = local.c[0] / scale_;
        evaluate(fit);
        return fit;
    }

    void evaluate(RegionFit& fit) const {
        for (std::size_t t = 0; t < soup_.size(); ++t) {
            const TriangleEnergy e =
                triangle_energy(fit.proxy, corner(t, 0), corner(t, 1), corner(t, 2), soup_.normals[t], soup_.areas[t]);
            fit.energy.distance += e.distance;
            fit.energy.normal += e.normal;
        }
        fit.total = fit.energy.hybrid(options_.weight);
        fit.valid = is_valid(fit.proxy, soup_);
    }

    /// Takes a start, improves it by reweighting, and keeps what is better than `best`.
    void offer(QuadricFit start, RegionFit& best) {
        Coefficients c = start.c;
        if (options_.best_of || options_.reweightings == 0 || !(weight_ > 0)) consider(c, best);
        for (int k = 0; k < options_.reweightings && weight_ > 0; ++k) {
            const Proxy proxy = proxy_of(c);
            const Moments weighted = reweighted(proxy);
            c = fit_least_squares(weighted, weight_).c;
            if (options_.best_of || k + 1 == options_.reweightings) consider(c, best);
        }
    }

    Proxy proxy_of(const Coefficients& local) {
        Proxy proxy;
        proxy.origin = centre_;
        proxy.c = from_local(local, {}, scale_);
        double mean = 0;
        lengths_.clear();
        for (std::size_t t = 0; t < soup_.size(); ++t) {
            const Vec3 x = (corner(t, 0) + corner(t, 1) + corner(t, 2)) / 3.0 - centre_;
            const double length = norm(gradient(proxy.c, x));
            lengths_.push_back(length);
            mean += soup_.areas[t] * length;
        }
        mean /= area_;
        if (!(mean > 0) || !std::isfinite(mean)) return plane_proxy(centre_, {0, 0, 1});
        for (double& v : proxy.c) v /= mean;
        for (double& v : lengths_) v /= mean;
        sorted_ = lengths_;
        const auto middle = sorted_.begin() + static_cast<std::ptrdiff_t>(sorted_.size() / 2);
        std::nth_element(sorted_.begin(), middle, sorted_.end());
        proxy.gradient_floor = std::max(1e-6, floor_share * *middle);
        return proxy;
    }

    Moments reweighted(const Proxy& proxy) const {
        Moments m;
        for (std::size_t t = 0; t < soup_.size(); ++t) {
            if (!(soup_.areas[t] > 0)) continue;
            const double w = 1 / std::max(lengths_[t], proxy.gradient_floor);
            accumulate(m, (corner(t, 0) - centre_) * scale_, (corner(t, 1) - centre_) * scale_,
                       (corner(t, 2) - centre_) * scale_, soup_.normals[t], soup_.areas[t] * scale_ * scale_, w * w, w);
        }
        return m;
    }

    void consider(const Coefficients& local, RegionFit& best) {
        RegionFit candidate;
        candidate.proxy = proxy_of(local);
        evaluate(candidate);
        if (!std::isfinite(candidate.total)) return;
        const bool preferred =
            options_.best_of && candidate.valid != best.valid ? candidate.valid : candidate.total < best.total;
        if (preferred) best = candidate;
    }

    const TriangleSoup& soup_;
    const RegionFitOptions& options_;
    Vec3 centre_;
    double area_ = 0, scale_ = 1, weight_ = 0;
    Moments moments_;
    std::vector<double> lengths_, sorted_;
};

}  // namespace

Proxy plane_proxy(const Vec3& point, const Vec3& normal) noexcept {
    const double length = norm(normal);
    return {point, plane(length > 0 ? normal / length : Vec3{0, 0, 1}, 0), 1e-6};
}

TriangleEnergy triangle_energy(const Proxy& proxy, const Vec3& v0, const Vec3& v1, const Vec3& v2, const Vec3& n,
                               double area) noexcept {
    const Vec3 a = v0 - proxy.origin, b = v1 - proxy.origin, c = v2 - proxy.origin;
    if (proxy.planar()) {
        return plane_triangle_energy({proxy.c[1], proxy.c[2], proxy.c[3]}, proxy.c[0], a, b, c, n, area);
    }
    return triangle_energy(proxy.c, a, b, c, n, area, proxy.gradient_floor);
}

RegionFit fit_region(const TriangleSoup& region, const RegionFitOptions& options) {
    return RegionFitter(region, options).run();
}

}  // namespace quadseg::quadric
