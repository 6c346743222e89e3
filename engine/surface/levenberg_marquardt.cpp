#include "surface/levenberg_marquardt.h"

#include "surface/median.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace quadseg::surface {

namespace {

using quadric::load_part, quadric::Pack, quadric::Part, quadric::part_size, quadric::store_part;

constexpr double first_damping = 1e-4, least_damping = 1e-9, most_damping = 1e8;
// In units of the points' RMS radius: below, distances are rounding.
constexpr double rounding = 4e-16;
// Squared sine of the angle between a parameter's effect and those of the others, below which the points do not tell
// them apart.
constexpr double indistinguishable = 1e-13;
// Mean squared derivative of the distance below which a parameter has no effect at all (the axis of a torus that is a
// sphere).
constexpr double no_effect = 1e-15;
// Steps in a row that leave the median where it is, after which it is not going to fall much.
constexpr int idle_steps = 3;
// Where the only question is whether the points come close: a step that promises less than this share of the cost leads
// nowhere, unless the points are this near already (in strays), where the weights may yet tell the exact ones.
constexpr double least_promise = 0.25, near_enough = 0.25;
// Of least squares: the cost falls by no more than so many times what a step promises.
constexpr double most_of_promise = 1.5;
// In scales, three medians each: more than a smooth misfit spreads.
constexpr double outlying = 1.5;

/// A row a pack, zero beyond K.
template <int K>
struct NormalEquations {
    Pack h[K];
    double g[K];
};

/// Some of the points in the frame's coordinates.
struct LocalPart {
    Part n, g, b;

    [[gnu::always_inline]] LocalPart(const LocalPoints& p, const ShapeFrame& f, std::size_t first) {
        const Part x = load_part(p.x + first) - f.p.x, y = load_part(p.y + first) - f.p.y,
                   z = load_part(p.z + first) - f.p.z;
        n = f.n.x * x + f.n.y * y + f.n.z * z;
        g = f.g.x * x + f.g.y * y + f.g.z * z;
        b = f.b.x * x + f.b.y * y + f.b.z * z;
    }
};

template <SurfaceType type>
class Problem {
  public:
    static constexpr int K = parameters_of<type>;

    Problem(LocalPoints& points, const FitOptions& options)
        : p_(points), robust_(options.robust), least_scale_(options.minimum_scale / points.extent) {}

    void distances(const ShapeFrame& f, const ShapeDistance<type>& shape, double* out) const {
        for (std::size_t first = 0; first < p_.padded(); first += part_size) {
            const LocalPart u(p_, f, first);
            Part d;
            shape.distance(u.n, u.g, u.b, d);
            store_part(out + first, d);
        }
    }

    double scale_of(const double* distance) const {
        return std::max(3 * median_magnitude(distance, p_.size(), p_.sorted), std::max(least_scale_, rounding));
    }

    /// scale_of(distance) <= bound.
    bool is_scale_below(double bound, const double* distance) const {
        std::size_t below = 0;
        for (std::size_t i = 0; i < p_.size(); ++i) below += 3 * std::abs(distance[i]) <= bound ? 1 : 0;
        return below > p_.size() / 2 && least_scale_ <= bound;
    }

    /// Σ w ρ(d): d²/2, or Cauchy's σ²/2 log(1 + (d/σ)²).
    double cost(const double* distance, double scale) const {
        double sum = 0;
        if (!robust_) {
            for (std::size_t i = 0; i < p_.size(); ++i) sum += p_.weight[i] * distance[i] * distance[i];
            return 0.5 * sum;
        }
        const double inverse = 1 / (scale * scale);
        // Where rounding is all that is left, the last digits of the cost decide when to stop.
        if (p_.unit_weights && scale > 1e3 * rounding) return 0.5 * scale * scale * sum_of_logs(distance, inverse);
        for (std::size_t i = 0; i < p_.size(); ++i)
            sum += p_.weight[i] * std::log1p(distance[i] * distance[i] * inverse);
        return 0.5 * scale * scale * sum;
    }

    /// Σ log(1 + d²·inverse) as the logarithm of products.
    double sum_of_logs(const double* distance, double inverse) const {
        double sum = 0;
        std::size_t i = 0;
        while (i < p_.size()) {
            double product[lane_count];
            std::fill_n(product, lane_count, 1.0);
            // Not more factors than leave the product of the lanes' within the range of doubles.
            for (int block = 0; block < 4 && i < p_.size(); ++block, i += lane_count) {
                if (i + lane_count <= p_.size()) {
                    for (std::size_t l = 0; l < lane_count; l += part_size) {
                        const Part d = load_part(distance + i + l),
                                   factors = load_part(product + l) * (1 + d * d * inverse);
                        store_part(product + l, factors);
                    }
                } else {
                    for (std::size_t l = 0; i + l < p_.size(); ++l)
                        product[l] *= 1 + distance[i + l] * distance[i + l] * inverse;
                }
            }
            double all = 1;
            for (const double v : product) all *= v;
            if (all < std::numeric_limits<double>::max()) {
                sum += std::log(all);
            } else {
                for (const double v : product) sum += std::log(v);
            }
        }
        return sum;
    }

    NormalEquations<K> normal_equations(const ShapeFrame& f, const ShapeDistance<type>& shape, double scale) const {
        constexpr int pairs = K * (K + 1) / 2 + K;
        Pack sums[pairs];
        const double inverse = robust_ ? 1 / (scale * scale) : 0;
        // The first points set the sums: for a few, zeroes would cost as much as they do.
        const auto add = [&](std::size_t first, std::size_t part, auto is_first) {
            const LocalPart u(p_, f, first);
            Part column[K], d;
            shape.derivatives(u.n, u.g, u.b, column, d);
            const Part w = load_part(p_.weight + first) / (1 + d * d * inverse);
            int pair = 0;
            const auto sum_up = [&](const Part& product) {
                Part& sum = quadric::part_of(sums[pair++], part);
                if constexpr (is_first.value) {
                    sum = product;
                } else {
                    sum += product;
                }
            };
            for (int i = 0; i < K; ++i) {
                const Part weighted = w * column[i];
                for (int j = 0; j <= i; ++j) sum_up(weighted * column[j]);
                sum_up(weighted * d);
            }
        };
        for (std::size_t part = 0; part < quadric::parts; ++part) add(part * part_size, part, std::true_type{});
        for (std::size_t first = lane_count; first < p_.padded(); first += lane_count) {
            for (std::size_t part = 0; part < quadric::parts; ++part)
                add(first + part * part_size, part, std::false_type{});
        }
        NormalEquations<K> e{};
        int pair = 0;
        auto total = [&] {
            double sum = 0;
            for (std::size_t l = 0; l < lane_count; ++l) sum += sums[pair][l];
            ++pair;
            return sum;
        };
        for (int i = 0; i < K; ++i) {
            for (int j = 0; j <= i; ++j) {
                const double sum = total();
                e.h[i][std::size_t(j)] = sum;
                e.h[j][std::size_t(i)] = sum;
            }
            e.g[i] = total();
        }
        return e;
    }

    /// Cholesky of the system scaled to a unit diagonal plus damping. False: not positive definite. smallest: least
    /// squared pivot.
    static bool solve(const NormalEquations<K>& e, double damping, double* step, double& smallest) {
        // A row of the upper factor and, in its last lane, the right side: what is left of it is one value.
        constexpr std::size_t right = lane_count - 1;
        static_assert(K <= right);
        Pack u[K], s{};
        smallest = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < K; ++i) {
            s[i] = e.h[i][i] > 0 ? 1 / std::sqrt(e.h[i][i]) : 0;
            if (!std::isfinite(s[i])) return false;
        }
        for (std::size_t i = 0; i < K; ++i) {
            u[i] = e.h[i] * s * s[i];
            u[i][i] = s[i] == 0 ? 0 : 1 + damping;
            u[i][right] = -e.g[i] * s[i];
        }
        double root[K];
        for (std::size_t k = 0; k < K; ++k) {
            const double pivot = u[k][k];
            smallest = std::min(smallest, pivot);
            if (!(pivot > 1e-15)) return false;
            root[k] = std::sqrt(pivot);
            u[k] = u[k] / root[k];
            for (std::size_t i = k + 1; i < K; ++i) u[i] = u[i] - u[k][i] * u[k];
        }
        double v[K];
        for (std::size_t i = K; i-- > 0;) {
            double sum = u[i][right];
            for (std::size_t k = i + 1; k < K; ++k) sum -= u[i][k] * v[k];
            v[i] = sum / root[i];
        }
        for (std::size_t i = 0; i < K; ++i) step[i] = v[i] * s[i];
        return true;
    }

    bool is_close(const double* distance, const Closeness& goal) const {
        const std::size_t n = p_.size();
        const double tolerance = goal.tolerance / p_.extent, stray = goal.stray / p_.extent;
        std::size_t within = 0, nearly = 0;
        for (std::size_t i = 0; i < n; ++i) {
            const double d = std::abs(distance[i]);
            within += d <= tolerance ? 1 : 0;
            nearly += d <= stray ? 1 : 0;
        }
        const auto quantile = [n](double q) { return std::min(std::size_t(q * double(n)), n - 1) + 1; };
        return within >= quantile(0.9) || (within >= quantile(0.5) && nearly >= quantile(0.97));
    }

    /// Some points lie far from where the others do: they may be what holds a fit up, and the weights need time to
    /// tell.
    bool has_outliers(const double* distance, double scale) const {
        return std::any_of(distance, distance + p_.size(), [&](double d) { return std::abs(d) > outlying * scale; });
    }

    /// goal: null, or stop where the points are so close or fall too slowly.
    Adjustment run(const ShapeFrame& start, const FitOptions& options, const Closeness* goal) {
        Adjustment best;
        best.frame = start;
        ShapeDistance<type> shape(start);
        distances(start, shape, p_.distance);
        // Least squares that have no goal need no scale, only whether rounding is all that there is.
        const bool scaled = robust_ || goal;
        const bool exact_start = !scaled && is_scale_below(100 * rounding, p_.distance);
        double scale = scaled ? scale_of(p_.distance) : 0, current = cost(p_.distance, scale), damping = first_damping;
        best.finite = std::isfinite(current);
        if (!best.finite) return best;
        best.close = goal && is_close(p_.distance, *goal);
        if (best.close) return best;
        const double hopeless = options.hopeless / p_.extent, wanted = options.wanted / p_.extent;
        const double most_cost = robust_ || !(options.most_rms > 0) ? std::numeric_limits<double>::infinity()
                                                                    : cost_of_rms(options.most_rms / p_.extent);
        double smallest = 0;
        int plateau = 0, accepted = 0, idle = 0;
        bool fresh = false;
        NormalEquations<K> e{};
        bool falling = false;  // the last step still paid a lot
        for (int iteration = 0; iteration < (falling ? 2 : 1) * options.iterations; ++iteration) {
            if (!fresh) e = normal_equations(best.frame, shape, scale);
            fresh = true;
            double step[K];
            if (!solve(e, damping, step, smallest)) {
                damping = std::max(damping * 10, 1e-6);
                if (damping > most_damping) break;
                continue;
            }
            if (goal && scale > 3 * near_enough * goal->stray / p_.extent &&
                promise(e, step) < least_promise * current && !has_outliers(p_.distance, scale))
                break;
            if (accepted > 0 && current - most_of_promise * promise(e, step) > most_cost) return useless(best);
            limit(step);
            const ShapeFrame next = stepped(best.frame, step);
            const ShapeDistance<type> shape_there(next);
            distances(next, shape_there, p_.trial);
            const double cost_there = cost(p_.trial, scale);
            if (!(cost_there <= current)) {
                // Rounding is all that is left, or the step was too long.
                if ((scaled ? scale <= 100 * rounding : exact_start) || current - cost_there > -1e-11 * current) break;
                damping = std::max(damping * 10, 1e-6);
                if (damping > most_damping) break;
                continue;
            }
            best.frame = next;
            shape = shape_there;
            std::swap(p_.distance, p_.trial);
            fresh = false;
            ++accepted;
            best.close = goal && is_close(p_.distance, *goal);
            if (best.close) return best;
            const double gain = current - cost_there;
            damping = damping * 0.02 < least_damping ? 0 : damping * 0.02;
            const double scale_there = robust_ ? scale_of(p_.distance) : scale;
            const bool steady = !robust_ || scale_there > 0.99 * scale;
            plateau = !steady || gain > 1e-4 * current ? 0 : plateau + (gain <= 1e-9 * current ? 2 : 1);
            idle = scale_there > 0.9 * scale ? idle + 1 : 0;
            falling = robust_ ? scale_there < 0.7 * scale : gain > 0.3 * current;
            scale = scale_there;
            current = robust_ ? cost(p_.distance, scale) : cost_there;
            double longest = 0;
            for (double v : step) longest = std::max(longest, std::abs(v));
            if (plateau >= 4 || longest < 1e-15 || !(current > 0)) break;
            if (hopeless > 0 && accepted == options.hopeless_after &&
                median_magnitude(p_.distance, p_.size(), p_.sorted) > hopeless)
                break;
            // The scale is three times the median.
            if (robust_ && wanted > 0 && idle >= idle_steps && scale > 9 * wanted) break;
        }
        if (current > most_cost) return useless(best);
        best.median = median_magnitude(p_.distance, p_.size(), p_.sorted);
        if (!robust_) best.rms = std::sqrt(current / cost_of_rms(1));
        if (wanted > 0 && !(best.median <= wanted)) return best;
        double step[K], total = 0;
        if (!fresh) e = normal_equations(best.frame, shape, scale);
        best.determined = solve(e, 0, step, smallest) && smallest > indistinguishable;
        for (std::size_t i = 0; i < p_.size(); ++i) total += p_.weight[i];
        for (int i = 0; i < K; ++i) best.determined = best.determined && e.h[i][std::size_t(i)] > no_effect * total;
        return best;
    }

  private:
    /// Of least squares.
    double cost_of_rms(double rms) const {
        double total = 0;
        for (std::size_t i = 0; i < p_.size(); ++i) total += p_.weight[i];
        return 0.5 * total * rms * rms;
    }

    static Adjustment useless(Adjustment adjustment) {
        adjustment.median = adjustment.rms = std::numeric_limits<double>::infinity();
        return adjustment;
    }

    /// By how much the cost falls with a step if it is as the normal equations say.
    static double promise(const NormalEquations<K>& e, const double* step) {
        double slope = 0;
        for (int i = 0; i < K; ++i) slope -= e.g[i] * step[i];
        return 0.5 * slope;
    }

    /// Rotations of more than half a radian leave the neighbourhood in which the derivatives mean something.
    static void limit(double* step) {
        double turn = 0;
        for (int i = 1; i < 3; ++i) turn = std::max(turn, std::abs(step[i]));
        if constexpr (K >= 5) turn = std::max(turn, std::abs(step[3]));
        if constexpr (K >= 6) turn = std::max(turn, std::abs(step[5]));
        if (turn > 0.5)
            for (int i = 0; i < K; ++i) step[i] *= 0.5 / turn;
    }

    LocalPoints& p_;
    bool robust_;
    double least_scale_;
};

}  // namespace

namespace {

Adjustment adjust(const ShapeFrame& start, LocalPoints& points, const FitOptions& options, const Closeness* goal) {
    switch (start.type) {
        case SurfaceType::plane:
            return Problem<SurfaceType::plane>(points, options).run(start, options, goal);
        case SurfaceType::sphere:
            return Problem<SurfaceType::sphere>(points, options).run(start, options, goal);
        case SurfaceType::cylinder:
            return Problem<SurfaceType::cylinder>(points, options).run(start, options, goal);
        case SurfaceType::cone:
            return Problem<SurfaceType::cone>(points, options).run(start, options, goal);
        case SurfaceType::torus:
            return Problem<SurfaceType::torus>(points, options).run(start, options, goal);
        default:
            return {};
    }
}

}  // namespace

Adjustment adjust_towards(const Closeness& goal, const ShapeFrame& start, LocalPoints& points,
                          const FitOptions& options) {
    FitOptions towards = options;
    towards.wanted = goal.tolerance;
    return adjust(start, points, towards, &goal);
}

Adjustment adjust(const ShapeFrame& start, LocalPoints& points, const FitOptions& options) {
    return adjust(start, points, options, nullptr);
}

}  // namespace quadseg::surface
