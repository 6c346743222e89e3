#include "surface/regularities.h"

#include "surface/evaluate.h"
#include "surface/surface.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace quadseg::surface {

namespace {

bool has_direction(SurfaceType t) {
    return t != SurfaceType::sphere && t != SurfaceType::quadric && t != SurfaceType::blend &&
           t != SurfaceType::freeform;
}
bool has_axis(SurfaceType t) {
    return t == SurfaceType::cylinder || t == SurfaceType::cone || t == SurfaceType::torus;
}
bool has_centre(SurfaceType t) {
    return t == SurfaceType::sphere || t == SurfaceType::torus || t == SurfaceType::ellipsoid;
}
double tube_radius(const Surface& s) {
    switch (s.type) {
        case SurfaceType::sphere:
        case SurfaceType::cylinder:
        case SurfaceType::blend:
            return s.radius;
        case SurfaceType::torus:
            return s.minor_radius;
        default:
            return 0;
    }
}

struct Group {
    std::vector<std::size_t> members;  ///< leader first
    Vec3 direction;
    double weight = 0;
};

class Finder {
  public:
    Finder(std::span<const RegularSurface> s, const RegularityOptions& o) : s_(s), o_(o), order_(s.size()) {
        std::iota(order_.begin(), order_.end(), std::size_t{0});
        std::stable_sort(order_.begin(), order_.end(),
                         [&](std::size_t a, std::size_t b) { return s_[a].area > s_[b].area; });
        for (const RegularSurface& r : s_) result_.snapped.push_back(r.surface);
    }

    RegularityResult run() {
        parallel();
        perpendicular();
        for (std::size_t i = 0; i < s_.size(); ++i) turn(i);
        coaxial();
        coplanar();
        concentric();
        equal_radius();
        for (Surface& s : result_.snapped)
            if (s.type <= SurfaceType::cone) s.coefficients = to_coefficients(s);
        return std::move(result_);
    }

  private:
    double noise(std::size_t i) const { return s_[i].noise + o_.rounding * s_[i].extent; }
    double angle_of(std::size_t i) const { return s_[i].extent > 0 ? noise(i) / s_[i].extent : o_.most_angle; }
    /// Within what noise and the bound allow. Most pairs are beyond the bound: they need no root.
    bool is_tolerated(double angle, std::size_t i, std::size_t j) const {
        return angle <= o_.most_angle && angle <= o_.sigmas * std::hypot(angle_of(i), angle_of(j));
    }
    /// `lever`: how far from its region a quantity is looked at.
    double length_tolerance(std::size_t i, std::size_t j, double lever_i, double lever_j) const {
        const double a = noise(i) + angle_of(i) * lever_i, b = noise(j) + angle_of(j) * lever_j;
        const double smaller = std::min(s_[i].extent, s_[j].extent);
        return std::min(o_.sigmas * std::hypot(a, b),
                        std::max(o_.most_length_share * smaller, o_.sigmas * o_.rounding * smaller));
    }
    Vec3 direction(std::size_t i) const { return normalized(to_vec3(result_.snapped[i].axis)); }
    Vec3 point(std::size_t i) const { return to_vec3(result_.snapped[i].point); }
    /// Weight of a surface in means: the inverse variance of what it tells.
    double confidence(std::size_t i) const { return s_[i].area / std::max(noise(i) * noise(i), 1e-300); }

    template <class Suits, class Equal>
    std::vector<Group> grouped(Suits&& suits, Equal&& equal) const {
        std::vector<Group> groups;
        for (std::size_t i : order_) {
            if (!suits(i)) continue;
            const auto home =
                std::find_if(groups.begin(), groups.end(), [&](const Group& g) { return equal(g.members[0], i); });
            if (home != groups.end())
                home->members.push_back(i);
            else
                groups.push_back({{i}, {}, 0});
        }
        return groups;
    }

    void report(Regularity::Kind kind, const std::vector<std::size_t>& members) {
        Regularity r;
        r.kind = kind;
        r.snapped = true;
        for (std::size_t i : members) r.regions.push_back(s_[i].region);
        std::sort(r.regions.begin(), r.regions.end());
        result_.groups.push_back(std::move(r));
    }

    void parallel() {
        directions_ = grouped(
            [&](std::size_t i) { return has_direction(s_[i].surface.type) && squared_norm(direction(i)) > 0; },
            [&](std::size_t i, std::size_t j) { return is_tolerated(norm(cross(direction(i), direction(j))), i, j); });
        for (Group& g : directions_) {
            const Vec3 leader = direction(g.members[0]);
            Vec3 sum;
            for (std::size_t i : g.members) {
                const double w = s_[i].area / std::max(angle_of(i) * angle_of(i), 1e-300);
                sum += std::copysign(w, dot(direction(i), leader)) * direction(i);
                g.weight += w;
            }
            g.direction = normalized(sum);
            if (g.members.size() > 1) report(Regularity::Kind::parallel, g.members);
        }
    }

    void perpendicular() {
        // The surest direction stays, the others give way: to at most two that they are perpendicular to.
        std::vector<std::size_t> by_weight(directions_.size());
        std::iota(by_weight.begin(), by_weight.end(), std::size_t{0});
        std::stable_sort(by_weight.begin(), by_weight.end(),
                         [&](std::size_t a, std::size_t b) { return directions_[a].weight > directions_[b].weight; });
        for (std::size_t a = 0; a < by_weight.size(); ++a) {
            Group& g = directions_[by_weight[a]];
            Vec3 fixed[2];
            int count = 0;
            for (std::size_t b = 0; b < a; ++b) {
                const Group& h = directions_[by_weight[b]];
                if (!is_tolerated(std::abs(dot(g.direction, h.direction)), g.members[0], h.members[0])) continue;
                report(Regularity::Kind::perpendicular, {g.members[0], h.members[0]});
                Vec3 d = h.direction;
                for (int k = 0; k < count; ++k) d -= dot(d, fixed[k]) * fixed[k];
                // Nearly the same direction again, or a third: nothing is left to give way with.
                if (count < 2 && norm(d) > 0.5) fixed[count++] = normalized(d);
            }
            Vec3 d = g.direction;
            for (int k = 0; k < count; ++k) d -= dot(d, fixed[k]) * fixed[k];
            g.direction = normalized(d);
        }
        home_.assign(s_.size(), -1);
        for (std::size_t k = 0; k < directions_.size(); ++k)
            for (std::size_t i : directions_[k].members) home_[i] = int(k);
    }

    /// Turns surface i about its region to its group's direction.
    void turn(std::size_t i) {
        if (home_[i] < 0) return;
        Surface& s = result_.snapped[i];
        const Vec3 old = direction(i);
        Vec3 d = directions_[std::size_t(home_[i])].direction;
        if (dot(d, old) < 0) d = -d;
        const Vec3 p = to_vec3(s.point), c = s_[i].centroid;
        if (s.type == SurfaceType::plane) {
            s.point = to_array(c - dot(c - p, old) * old);
        } else if (s.type == SurfaceType::cylinder || s.type == SurfaceType::cone) {
            const double along = dot(c - p, old);
            const Vec3 on_axis = p + along * old;
            s.point = to_array(s.type == SurfaceType::cylinder ? on_axis : on_axis - along * d);
        }
        s.axis = to_array(d);
        if (s.type > SurfaceType::torus) {
            // The triad turns with its last axis.
            const Vec3 turn = cross(old, d);
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3 a{s.axes[3 * k], s.axes[3 * k + 1], s.axes[3 * k + 2]};
                const Vec3 b = normalized(a + cross(turn, a));
                s.axes[3 * k] = b.x;
                s.axes[3 * k + 1] = b.y;
                s.axes[3 * k + 2] = b.z;
            }
        }
    }

    double lever(std::size_t i, const Vec3& at) const { return norm(at - s_[i].centroid); }

    void coaxial() {
        const auto groups = grouped([&](std::size_t i) { return has_axis(s_[i].surface.type); },
                                    [&](std::size_t i, std::size_t j) {
                                        if (home_[i] != home_[j]) return false;
                                        const Vec3 d = direction(i), u = point(j) - point(i), apart = u - dot(u, d) * d;
                                        // Both axes looked at half way between the regions.
                                        const double half = 0.5 * std::abs(dot(s_[i].centroid - s_[j].centroid, d));
                                        return norm(apart) <= length_tolerance(i, j, half, half);
                                    });
        for (const Group& g : groups) {
            if (g.members.size() < 2) continue;
            report(Regularity::Kind::coaxial, g.members);
            const Vec3 origin = point(g.members[0]), d = direction(g.members[0]);
            Vec3 sum;
            double weight = 0;
            for (std::size_t i : g.members) {
                const Vec3 u = point(i) - origin;
                sum += confidence(i) * (u - dot(u, d) * d);
                weight += confidence(i);
            }
            for (std::size_t i : g.members) {
                const Vec3 u = point(i) - origin;
                result_.snapped[i].point = to_array(origin + sum / weight + dot(u, d) * d);
            }
        }
    }

    void coplanar() {
        const auto groups =
            grouped([&](std::size_t i) { return s_[i].surface.type == SurfaceType::plane; },
                    [&](std::size_t i, std::size_t j) {
                        if (home_[i] != home_[j]) return false;
                        const double half = 0.5 * norm(s_[i].centroid - s_[j].centroid);
                        return std::abs(dot(point(j) - point(i), direction(i))) <= length_tolerance(i, j, half, half);
                    });
        for (const Group& g : groups) {
            if (g.members.size() < 2) continue;
            report(Regularity::Kind::coplanar, g.members);
            const Vec3 origin = point(g.members[0]), d = direction(g.members[0]);
            double sum = 0, weight = 0;
            for (std::size_t i : g.members) {
                sum += confidence(i) * dot(point(i) - origin, d);
                weight += confidence(i);
            }
            for (std::size_t i : g.members) {
                const double height = dot(point(i) - origin, d);
                result_.snapped[i].point = to_array(point(i) + (sum / weight - height) * d);
            }
        }
    }

    void concentric() {
        const auto groups = grouped([&](std::size_t i) { return has_centre(s_[i].surface.type); },
                                    [&](std::size_t i, std::size_t j) {
                                        return norm(point(i) - point(j)) <=
                                               length_tolerance(i, j, lever(i, point(i)), lever(j, point(j)));
                                    });
        for (const Group& g : groups) {
            if (g.members.size() < 2) continue;
            report(Regularity::Kind::concentric, g.members);
            // A torus that shares its axis keeps it; spheres follow.
            Vec3 sum;
            double weight = 0;
            const auto torus = std::find_if(g.members.begin(), g.members.end(),
                                            [&](std::size_t i) { return s_[i].surface.type == SurfaceType::torus; });
            for (std::size_t i : g.members) {
                sum += confidence(i) * (point(i) - point(g.members[0]));
                weight += confidence(i);
            }
            const Vec3 centre = torus != g.members.end() ? point(*torus) : point(g.members[0]) + sum / weight;
            for (std::size_t i : g.members)
                if (s_[i].surface.type == SurfaceType::sphere) result_.snapped[i].point = to_array(centre);
        }
    }

    void equal_radius() {
        const auto groups = grouped([&](std::size_t i) { return tube_radius(s_[i].surface) > 0; },
                                    [&](std::size_t i, std::size_t j) {
                                        const Surface &a = s_[i].surface, &b = s_[j].surface;
                                        if (a.type != b.type) return false;
                                        const double ra = tube_radius(a), rb = tube_radius(b);
                                        return std::abs(ra - rb) <= length_tolerance(i, j, ra, rb);
                                    });
        for (const Group& g : groups) {
            if (g.members.size() < 2) continue;
            report(Regularity::Kind::equal_radius, g.members);
            double sum = 0, weight = 0;
            for (std::size_t i : g.members) {
                sum += confidence(i) * tube_radius(s_[i].surface);
                weight += confidence(i);
            }
            for (std::size_t i : g.members) {
                Surface& s = result_.snapped[i];
                (s.type == SurfaceType::torus ? s.minor_radius : s.radius) = sum / weight;
            }
        }
    }

    std::span<const RegularSurface> s_;
    RegularityOptions o_;
    std::vector<std::size_t> order_;
    std::vector<Group> directions_;
    std::vector<int> home_;
    RegularityResult result_;
};

}  // namespace

RegularityResult find_regularities(std::span<const RegularSurface> surfaces, const RegularityOptions& options) {
    RegularityResult result = Finder(surfaces, options).run();
    std::stable_sort(result.groups.begin(), result.groups.end(), [](const Regularity& a, const Regularity& b) {
        return a.kind != b.kind ? a.kind < b.kind : a.regions < b.regions;
    });
    return result;
}

double max_distance(const Surface& s, std::span<const Vec3> points) {
    double worst = 0;
    SurfaceEvaluator(s).visit([&](const auto& e) {
        for (const Vec3& p : points) worst = std::max(worst, std::abs(e.distance(p)));
    });
    return worst;
}

bool same_surface(const Surface& a, std::span<const Vec3> points_of_a, const Surface& b,
                  std::span<const Vec3> points_of_b, double tolerance) {
    if (a.type != b.type || a.type >= SurfaceType::blend) return false;
    auto within = [&](const Surface& s, std::span<const Vec3> points) {
        return SurfaceEvaluator(s).visit([&](const auto& e) {
            return std::all_of(points.begin(), points.end(),
                               [&](const Vec3& p) { return std::abs(e.distance(p)) <= tolerance; });
        });
    };
    return within(b, points_of_a) && within(a, points_of_b);
}

std::vector<std::int32_t> surface_ids(std::span<const SurfacePoints> regions) {
    std::vector<std::int32_t> ids(regions.size());
    for (std::size_t i = 0; i < regions.size(); ++i) {
        ids[i] = std::int32_t(i);
        for (std::size_t j = 0; j < i; ++j) {
            if (ids[j] != std::int32_t(j)) continue;
            const double tolerance = std::max(regions[i].tolerance, regions[j].tolerance);
            if (same_surface(regions[i].surface, regions[i].points, regions[j].surface, regions[j].points, tolerance)) {
                ids[i] = std::int32_t(j);
                break;
            }
        }
    }
    return ids;
}

}  // namespace quadseg::surface
