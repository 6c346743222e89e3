#include "quadric/region_fit.h"

#include "quadric/face_packs.h"
#include "quadric/fit.h"
#include "quadric/sheets.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace quadseg::quadric {
namespace {

class RegionFitter {
  public:
    RegionFitter(const TriangleSoup& region, const RegionFitOptions& options)
        : soup_(region),
          options_(options),
          faces_(region, true, &options.poll),
          moments_(faces_.moments()),
          weight_(scaled_weight(options.weight, faces_.scale())) {}

    RegionFit run() {
        if (!(faces_.area() > 0)) return degenerate();
        poll();
        fit_planar();
        const double tolerance = options_.plane_tolerance * (options_.plane_tolerance_per_area ? faces_.area() : 1);
        if (best_.total <= tolerance) return best_;
        if (options_.best_of) {
            fit_best();
        } else {
            fit_two_steps();
        }
        return best_;
    }

  private:
    void poll() const {
        if (options_.poll) options_.poll();
    }

    Candidate prepare(const Coefficients& c) {
        poll();
        return faces_.prepare(c);
    }

    RegionFit degenerate() const {
        RegionFit fit;
        fit.proxy = soup_.size() > 0 ? plane_proxy(soup_.corners[0], soup_.normals[0]) : plane_proxy({}, {0, 0, 1});
        return fit;
    }

    /// Energies of the local frame in the unit frame: E_d scales by s⁴, E_n by s².
    void set_energy(RegionFit& fit, double distance, double normal) const {
        const double s2 = faces_.scale() * faces_.scale();
        fit.energy = {distance / (s2 * s2), normal / s2};
        fit.total = fit.energy.hybrid(options_.weight);
    }

    void fit_planar() {
        Candidate plane;
        plane.c = fit_plane(moments_, weight_).c;
        const TriangleEnergy energy = moment_energy(plane.c, moments_);
        set_energy(best_, energy.distance, energy.normal);
        const Vec3 normal{plane.c[1], plane.c[2], plane.c[3]};
        best_.proxy = plane_proxy(faces_.centre(), normal);
        best_.proxy.c[0] = plane.c[0] / faces_.scale();
        // A normal on the wrong side costs 2 an area at least: most planes need no look at the faces.
        if (energy.normal > 2 * tolerated_share * moments_.area[0]) {
            faces_.evaluate(plane);
            best_.valid = plane.against <= tolerated_share * moments_.area[0];
        }
    }

    /// Takes the candidate if it is better: valid ones first, then by true energy.
    void offer(Candidate& candidate) {
        if (!candidate.usable) return;
        poll();
        faces_.evaluate(candidate);
        if (!candidate.usable) return;
        RegionFit fit;
        set_energy(fit, candidate.distance, candidate.normal);
        if (!(fit.total < best_.total) && (best_.valid || !options_.best_of)) return;
        fit.valid = candidate.against <= tolerated_share * moments_.area[0] &&
                    faces_.share_on_other_sheet(candidate.c) <= tolerated_share;
        if (options_.best_of && fit.valid != best_.valid) {
            if (!fit.valid) return;
        } else if (!(fit.total < best_.total)) {
            return;
        }
        fit.proxy.origin = faces_.centre();
        fit.proxy.c = from_local(candidate.c, {}, faces_.scale());
        for (double& v : fit.proxy.c) v /= faces_.scale();  // |∇f| as it is in the local frame
        fit.proxy.gradient_floor = candidate.gradient_floor;
        best_ = fit;
    }

    /// The paper's two steps: Taubin, then the weighted linear system.
    void fit_two_steps() {
        Candidate candidate = prepare(fit_taubin(moments_).c);
        for (int k = 0; k < options_.reweightings && candidate.usable && weight_ > 0; ++k) {
            Moments weighted;
            poll();
            faces_.reweigh(candidate, weighted);
            candidate = prepare(fit_least_squares(weighted, weight_).c);
        }
        offer(candidate);
    }

    /// Two starts that fail in different places (Taubin on near planes, unit weights on cones), each also reweighted.
    void fit_best() {
        Candidate taubin = prepare(fit_taubin(moments_).c);
        offer(taubin);
        if (!(weight_ > 0)) return;
        Candidate linear = prepare(fit_least_squares(moments_, weight_).c);
        offer(linear);
        for (int k = 0; k < options_.reweightings; ++k) {
            if (!linear.usable) return;
            if (!taubin.usable) taubin = linear;
            Moments weighted_taubin, weighted_linear;
            poll();
            faces_.reweigh(taubin, linear, weighted_taubin, weighted_linear);
            taubin = prepare(fit_least_squares(weighted_taubin, weight_).c);
            linear = prepare(fit_least_squares(weighted_linear, weight_).c);
            offer(taubin);
            offer(linear);
        }
    }

    const TriangleSoup& soup_;
    const RegionFitOptions& options_;
    FacePacks faces_;
    const Moments& moments_;
    double weight_;
    RegionFit best_;
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

bool is_valid(const Proxy& proxy, const TriangleSoup& region) {
    const FacePacks faces(region, false);
    if (!(faces.area() > 0)) return true;
    Candidate local;
    local.c = to_local(proxy.c, faces.centre() - proxy.origin, faces.scale());
    faces.evaluate(local);
    return local.against <= tolerated_share * faces.moments().area[0] &&
           (proxy.planar() || faces.share_on_other_sheet(local.c) <= tolerated_share);
}

}  // namespace quadseg::quadric
