#include "surface/constrained_fit.h"

#include "math/symmetric3.h"
#include "surface/evaluate.h"
#include "surface/fit_starts.h"
#include "surface/local_points.h"
#include "surface/quadric_refine.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace quadseg::surface {

namespace {

using quadric::Coefficients;

// A refined member of a family has exact zeros where the family has them; only rounding is to be seen through.
constexpr double classification_tolerance = 1e-9;

bool present(const Coefficients& c) {
    return std::any_of(c.begin(), c.end(), [](double v) { return v != 0; }) &&
           std::all_of(c.begin(), c.end(), [](double v) { return std::isfinite(v); });
}

/// A triad around a last direction.
QuadricFrame frame_about(const Vec3& origin, const Vec3& last, const Vec3& first) {
    QuadricFrame f;
    f.origin = origin;
    f.axes[2] = normalized(last);
    const Vec3 side = first - dot(first, f.axes[2]) * f.axes[2];
    f.axes[0] = squared_norm(side) > 1e-12 ? normalized(side) : any_perpendicular(f.axes[2]);
    f.axes[1] = cross(f.axes[2], f.axes[0]);
    return f;
}

/// Frames in which the members of a family are looked for.
class Frames {
  public:
    Frames(const LocalPoints& points, const Coefficients& general) : general_(general) {
        Symmetric3 m;
        for (const Vec3& n : points.normals) m.add_outer(n);
        normals_ = eigen_decomposition(m);
        quadric_ =
            eigen_decomposition({2 * general[4], general[5], general[6], 2 * general[7], general[8], 2 * general[9]});
        const Surface t = TorusAxes(points).start(points);
        line_point_ = to_vec3(t.point);
        line_ = to_vec3(t.axis);
        apex_ = to_vec3(start_cone(points).point);
    }

    std::vector<QuadricFrame> of(QuadricFamily family) const {
        std::vector<QuadricFrame> frames;
        const int flat = flattest(), bent = most_bent();
        switch (family) {
            case QuadricFamily::cylinder:
                frames.push_back(frame_about({}, normals_.vectors[0], normals_.vectors[2]));
                frames.push_back(frame_about({}, quadric_.vectors[flat], quadric_.vectors[bent]));
                break;
            case QuadricFamily::parabolic_cylinder: {
                // Also turned by the conic that the general quadric shows across the generator.
                QuadricFrame f = frame_about({}, normals_.vectors[0], quadric_.vectors[bent]);
                frames.push_back(f);
                frames.push_back(frame_about({}, normals_.vectors[0], normals_.vectors[1]));
                break;
            }
            case QuadricFamily::paraboloid:
                frames.push_back(frame_about({}, quadric_.vectors[flat], quadric_.vectors[bent]));
                frames.push_back(frame_about({}, normals_.vectors[2], normals_.vectors[0]));
                break;
            case QuadricFamily::cone: {
                QuadricFrame f = frame_about(apex_, {0, 0, 1}, {1, 0, 0});
                frames.push_back(f);
                Vec3 centre;
                bool finite = true;
                for (int i = 0; i < 3; ++i) {
                    const double b = dot(quadric_.vectors[i], Vec3{general_[1], general_[2], general_[3]});
                    finite = finite && quadric_.values[i] != 0;
                    if (finite) centre -= (b / quadric_.values[i]) * quadric_.vectors[i];
                }
                if (finite && norm(centre) < 1e4) {
                    f.origin = centre;
                    frames.push_back(f);
                }
                break;
            }
            case QuadricFamily::revolution:
                frames.push_back(frame_about(line_point_, line_, any_perpendicular(line_)));
                break;
            case QuadricFamily::general:
                break;
        }
        return frames;
    }

  private:
    int flattest() const {
        int k = 0;
        for (int i = 1; i < 3; ++i)
            if (std::abs(quadric_.values[i]) < std::abs(quadric_.values[k])) k = i;
        return k;
    }
    int most_bent() const {
        int k = 0;
        for (int i = 1; i < 3; ++i)
            if (std::abs(quadric_.values[i]) > std::abs(quadric_.values[k])) k = i;
        return k;
    }
    Coefficients general_;
    EigenSystem normals_, quadric_;
    Vec3 line_point_, line_, apex_;
};

struct Candidate {
    SurfaceFit fit;
    int freedom = 0;
    double preference = 1;  ///< factor on the mean squared angle between the normals
    double deviation = 0;   ///< mean squared sine of half the angle, ·4
    bool usable() const { return fit.ok; }
};

double normal_deviation(const Surface& s, const PointSet& p) {
    if (p.normals.size() != p.points.size() || p.points.empty()) return 0;
    double sum = 0;
    SurfaceEvaluator(s).visit([&](const auto& e) {
        for (std::size_t i = 0; i < p.points.size(); ++i) sum += squared_norm(e.normal(p.points[i]) - p.normals[i]);
    });
    return sum / double(p.points.size());
}

bool belongs(SurfaceType type, QuadricFamily family) {
    switch (family) {
        case QuadricFamily::cylinder:
            return type == SurfaceType::elliptic_cylinder || type == SurfaceType::hyperbolic_cylinder ||
                   type == SurfaceType::cylinder;
        case QuadricFamily::parabolic_cylinder:
            return type == SurfaceType::parabolic_cylinder;
        case QuadricFamily::paraboloid:
            return type == SurfaceType::elliptic_paraboloid || type == SurfaceType::hyperbolic_paraboloid;
        case QuadricFamily::cone:
            return type == SurfaceType::elliptic_cone || type == SurfaceType::cone;
        default:
            return true;
    }
}

/// Exact distances of a refined quadric, its name and parameters.
SurfaceFit described(const Coefficients& local, const LocalPoints& points, const PointSet& p) {
    const Coefficients c = normalised_to(quadric::from_local(local, points.centre, 1 / points.extent), p);
    // The point nearest to the centroid: where the data are.
    std::size_t middle = 0;
    for (std::size_t i = 1; i < points.size(); ++i)
        if (squared_norm(points.point(i)) < squared_norm(points.point(middle))) middle = i;
    Coefficients oriented = local;
    if (dot(quadric::gradient(c, p.points[middle]), quadric::gradient(local, points.point(middle))) < 0)
        for (double& v : oriented) v = -v;
    const Vec3 near = points.point(middle);
    Surface s = classify(oriented, near, 1, classification_tolerance);
    s = points.to_world(s);
    for (double& v : s.semi_axes) v *= s.type == SurfaceType::elliptic_cone ? 1 : points.extent;
    s.coefficients = s.type > SurfaceType::torus ? c : to_coefficients(s);
    return measure(s, p);
}

class Chooser {
  public:
    Chooser(const PointSet& p, const Coefficients& start, const FitOptions& options)
        : p_(p), options_(options), points_(p) {
        if (!points_.usable()) return;
        if (present(start)) start_ = quadric::to_local(start, points_.centre, 1 / points_.extent);
    }

    bool usable() const { return points_.usable(); }
    double extent() const { return points_.extent; }

    Candidate direct(SurfaceType type) {
        static constexpr double preferences[] = {1, 1.05, 1, 1.02, 1.15};
        Candidate c;
        c.fit = fit(type, p_, options_);
        c.freedom = degrees_of_freedom(type);
        c.preference = preferences[int(type)];
        finish(c);
        return c;
    }

    /// Best member of a family over its frames. Needs the general one first for its frames.
    Candidate family(QuadricFamily family) {
        Candidate best;
        best.freedom = degrees_of_freedom(family);
        best.preference = 1.15 + 0.02 * best.freedom;
        if (points_.size() < std::size_t(best.freedom)) return best;
        auto consider = [&](const QuadricFrame& start) {
            Coefficients c;
            if (!refine_quadric(family, points_, start, options_, c)) return;
            SurfaceFit f = described(c, points_, p_);
            if (!f.ok || !belongs(f.surface.type, family)) return;
            if (!best.fit.ok || f.rms < best.fit.rms) best.fit = f;
        };
        for (QuadricFrame start : frames_of(family)) {
            QuadricFrame guided = start;
            if (start_quadric(family, points_, start)) consider(start);
            if (family == QuadricFamily::general && present(start_)) {
                guided.c = to_frame(start_, guided);
                consider(guided);
            }
        }
        finish(best);
        return best;
    }

  private:
    void finish(Candidate& c) const {
        if (c.fit.ok) c.deviation = normal_deviation(c.fit.surface, p_);
    }

    /// The general quadric has every frame: none need be looked for.
    std::vector<QuadricFrame> frames_of(QuadricFamily family) {
        if (family == QuadricFamily::general) return {frame_about({}, {0, 0, 1}, {1, 0, 0})};
        return Frames(points_, general()).of(family);
    }

    /// A first general quadric, for frames only.
    const Coefficients& general() {
        if (present(general_)) return general_;
        QuadricFrame f = frame_about({}, {0, 0, 1}, {1, 0, 0});
        general_ = present(start_) ? start_ : Coefficients{0, 0, 0, 1, 0, 0, 0, 0, 0, 0};
        if (start_quadric(QuadricFamily::general, points_, f)) general_ = from_frame(f);
        return general_;
    }

    const PointSet& p_;
    FitOptions options_;
    LocalPoints points_;
    Coefficients start_{}, general_{};
};

QuadricFamily family_of(SurfaceType type) {
    switch (type) {
        case SurfaceType::elliptic_cylinder:
        case SurfaceType::hyperbolic_cylinder:
            return QuadricFamily::cylinder;
        case SurfaceType::parabolic_cylinder:
            return QuadricFamily::parabolic_cylinder;
        case SurfaceType::elliptic_paraboloid:
        case SurfaceType::hyperbolic_paraboloid:
            return QuadricFamily::paraboloid;
        case SurfaceType::elliptic_cone:
            return QuadricFamily::cone;
        default:
            return QuadricFamily::general;
    }
}

}  // namespace

Coefficients normalised_to(const Coefficients& c, const PointSet& p) {
    if (p.points.empty()) return c;
    double steep = 0, vote = 0;
    const bool normals = p.normals.size() == p.points.size();
    for (std::size_t i = 0; i < p.points.size(); ++i) {
        const Vec3 g = quadric::gradient(c, p.points[i]);
        steep += norm(g);
        if (normals) vote += dot(g, p.normals[i]);
    }
    if (!(steep > 0) || !std::isfinite(steep)) return c;
    const double scale = (vote < 0 ? -1 : 1) * double(p.points.size()) / steep;
    Coefficients result = c;
    for (double& v : result) v *= scale;
    return result;
}

SurfaceFit fit_type(SurfaceType type, const PointSet& p, const Coefficients& start, const FitOptions& options) {
    if (type <= SurfaceType::torus) return fit(type, p, options);
    SurfaceFit none;
    none.surface.type = type;
    if (type == SurfaceType::blend || type == SurfaceType::freeform) return none;
    Chooser chooser(p, start, options);
    if (!chooser.usable()) return none;
    SurfaceFit f = chooser.family(family_of(type)).fit;
    if (type != SurfaceType::quadric && f.surface.type != type) f.ok = false;
    return f;
}

namespace {

SurfaceFit choose_among_all(const PointSet& p, const Coefficients& start, const ChoiceOptions& options) {
    SurfaceFit none;
    none.surface.type = SurfaceType::quadric;
    none.surface.coefficients = start;
    none.rms = none.max = std::numeric_limits<double>::infinity();
    Chooser chooser(p, start, options.fit);
    if (!chooser.usable()) return none;
    const double floor = std::max(options.noise_floor, 1e-12 * chooser.extent());
    std::vector<Candidate> candidates;
    auto consider = [&](Candidate c) {
        if (c.usable()) candidates.push_back(std::move(c));
    };
    auto best_rms = [&] {
        double best = std::numeric_limits<double>::infinity();
        for (const Candidate& c : candidates) best = std::min(best, c.fit.rms);
        return best;
    };
    consider(chooser.direct(SurfaceType::plane));
    if (!candidates.empty() && candidates[0].fit.rms <= floor) return candidates[0].fit;
    for (SurfaceType type : {SurfaceType::sphere, SurfaceType::cylinder, SurfaceType::cone})
        consider(chooser.direct(type));
    if (options.torus) consider(chooser.direct(SurfaceType::torus));
    if (options.general && best_rms() > floor) {
        for (QuadricFamily family :
             {QuadricFamily::parabolic_cylinder, QuadricFamily::cylinder, QuadricFamily::revolution,
              QuadricFamily::paraboloid, QuadricFamily::cone, QuadricFamily::general})
            consider(chooser.family(family));
    }
    if (candidates.empty()) return none;
    const double limit = std::max(floor, options.ratio * best_rms());
    const Candidate* chosen = nullptr;
    auto score = [](const Candidate& c) { return (c.deviation + 1e-7) * c.preference; };
    for (const Candidate& c : candidates)
        if (c.fit.rms <= limit && (!chosen || score(c) < score(*chosen))) chosen = &c;
    return chosen->fit;
}

/// Every k-th point.
struct Sample {
    std::vector<Vec3> points, normals;
    std::vector<double> weights;
    Sample(const PointSet& p, std::size_t step) {
        for (std::size_t i = 0; i < p.points.size(); i += step) {
            points.push_back(p.points[i]);
            if (p.normals.size() == p.points.size()) normals.push_back(p.normals[i]);
            if (p.weights.size() == p.points.size()) weights.push_back(p.weights[i]);
        }
    }
};

}  // namespace

SurfaceFit choose_surface_fit(const PointSet& p, const Coefficients& start, const ChoiceOptions& options) {
    const std::size_t n = p.points.size(), most = std::max<std::size_t>(options.sample, 64);
    if (n <= most) return choose_among_all(p, start, options);
    const Sample sample(p, (n + most - 1) / most);
    SurfaceFit f = choose_among_all({sample.points, sample.normals, sample.weights}, start, options);
    if (!f.ok) return f;
    if (f.surface.type <= SurfaceType::torus) {
        const SurfaceFit all = refine(f.surface, p, options.fit);
        if (all.ok) return all;
    }
    f.surface.coefficients =
        f.surface.type > SurfaceType::torus ? normalised_to(f.surface.coefficients, p) : f.surface.coefficients;
    return measure(f.surface, p);
}

Surface choose_surface(const PointSet& p, const Coefficients& start, const ChoiceOptions& options) {
    return choose_surface_fit(p, start, options).surface;
}

}  // namespace quadseg::surface
