#include "flow/description_length.h"

#include "quadric/fit.h"
#include "quadric/nested_fits.h"

#include <algorithm>

namespace quadseg::flow {
namespace {

struct Centred {
    quadric::Spread size;
    quadric::Moments moments;
    double weight = 0, price = 0;
    double to_input = 1;  ///< energies are lengths to the fourth power
};

Centred centred(const quadric::Moments& m, double weight, double price) noexcept {
    Centred r;
    r.size = quadric::spread(m);
    const double scale = 1 / r.size.radius;
    r.moments = quadric::scaled(quadric::shifted(m, r.size.centroid), scale);
    r.weight = quadric::scaled_weight(weight, scale);
    r.to_input = r.size.radius * r.size.radius * r.size.radius * r.size.radius;
    r.price = price / r.to_input;
    return r;
}

PricedFit brought_back(const Centred& frame, const quadric::QuadricFit& fit, int parameters) noexcept {
    PricedFit r;
    r.c = quadric::from_local(fit.c, frame.size.centroid, 1 / frame.size.radius);
    for (double& v : r.c) v *= frame.size.radius;
    r.energy = fit.energy * frame.to_input;
    r.parameters = parameters;
    r.length = (fit.energy + frame.price * parameters) * frame.to_input;
    return r;
}

PricedFit without_extent(const quadric::Moments& m, double weight, double price) noexcept {
    PricedFit r;
    r.c = quadric::fit_plane(m, weight).c;
    r.length = 3 * price;
    return r;
}

}  // namespace

PricedFit plane_priced(const quadric::Moments& m, double weight, double price) noexcept {
    if (!(quadric::spread(m).radius > 0)) return without_extent(m, weight, price);
    const Centred frame = centred(m, weight, price);
    return brought_back(frame, quadric::fit_plane(frame.moments, frame.weight), 3);
}

PricedFit fit_priced(const quadric::Moments& m, double weight, double price) noexcept {
    if (!(quadric::spread(m).radius > 0)) return without_extent(m, weight, price);
    const Centred frame = centred(m, weight, price);
    quadric::QuadricFit best = quadric::fit_plane(frame.moments, frame.weight);
    int parameters = 3;
    double length = best.energy + frame.price * parameters;
    if (length > frame.price * 4) {
        const quadric::NestedFits fits(frame.moments, frame.weight);
        // No model has less energy than the quadric: what it cannot win with, no other needs to try.
        const double bound = fits.quadric_energy();
        const auto may_win = [&](int p) { return bound + frame.price * p < length; };
        const auto offer = [&](const quadric::QuadricFit& fit, int p) {
            const double l = std::max(0.0, fit.energy) + frame.price * p;
            if (l < length) {
                best = fit;
                parameters = p;
                length = l;
            }
        };
        if (fits.usable() && may_win(4)) {
            if (fits.sphere_energy() + frame.price * 4 < length) offer(fits.sphere(), 4);
            if (may_win(5)) offer(fits.cylinder(quadric::cylinder_direction(frame.moments)), 5);
            if (may_win(7)) offer(fits.revolution(quadric::revolution_direction(frame.moments)), 7);
            if (may_win(7)) {
                const quadric::QuadricFit general = fits.quadric();
                offer(fits.revolution(quadric::revolution_direction(general.c)), 7);
                offer(general, quadric_parameters);
            }
        }
    }
    return brought_back(frame, best, parameters);
}

}  // namespace quadseg::flow
