#include "surface/blend.h"

#include "math/symmetric3.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace quadseg::surface {

namespace {

constexpr std::size_t most_points = 512;
constexpr std::size_t neighbour_count = 12;
constexpr std::size_t least_points = 8;

struct Neighbourhood {
    std::array<std::uint32_t, neighbour_count> index{};
    std::size_t count = 0;
    Vec3 principal[2];  ///< unit tangent directions of largest and smallest |curvature|
};

/// Principal directions from Δn ≈ S Δx in the tangent plane.
void find_directions(const std::vector<Vec3>& x, const std::vector<Vec3>& n, std::size_t i, Neighbourhood& hood) {
    const Vec3 u = any_perpendicular(n[i]), v = cross(n[i], u);
    // Least squares for s_uu, s_uv, s_vv.
    double m[3][3] = {}, right[3] = {};
    for (std::size_t k = 0; k < hood.count; ++k) {
        const Vec3 dx = x[hood.index[k]] - x[i], dn = n[hood.index[k]] - n[i];
        const double a = dot(dx, u), b = dot(dx, v), p = dot(dn, u), q = dot(dn, v);
        m[0][0] += a * a;
        m[0][1] += a * b;
        m[1][1] += a * a + b * b;
        m[1][2] += a * b;
        m[2][2] += b * b;
        right[0] += a * p;
        right[1] += b * p + a * q;
        right[2] += b * q;
    }
    const double ridge = 1e-9 * (m[0][0] + m[2][2]);
    const double m0 = m[0][0] + ridge, m2 = m[2][2] + ridge;
    const double middle = m[1][1] + ridge - m[0][1] * m[0][1] / m0 - m[1][2] * m[1][2] / m2;
    const double suv = middle > 0 ? (right[1] - m[0][1] * right[0] / m0 - m[1][2] * right[2] / m2) / middle : 0;
    const double suu = m0 > 0 ? (right[0] - m[0][1] * suv) / m0 : 0, svv = m2 > 0 ? (right[2] - m[1][2] * suv) / m2 : 0;
    double angle = 0.5 * std::atan2(2 * suv, suu - svv);  // of the algebraically largest curvature
    const double mean = 0.5 * (suu + svv);
    if (mean < 0) angle += std::acos(0.0);
    hood.principal[0] = std::cos(angle) * u + std::sin(angle) * v;
    hood.principal[1] = cross(n[i], hood.principal[0]);
}

class Canal {
  public:
    explicit Canal(const PointSet& p) {
        const std::size_t step = (p.points.size() + most_points - 1) / most_points;
        for (std::size_t i = 0; i < p.points.size(); i += std::max<std::size_t>(step, 1)) {
            x_.push_back(p.points[i]);
            n_.push_back(p.normals[i]);
        }
        std::vector<std::pair<double, std::uint32_t>> near(x_.size());
        hoods_.resize(x_.size());
        for (std::size_t i = 0; i < x_.size(); ++i) {
            for (std::size_t j = 0; j < x_.size(); ++j)
                near[j] = {squared_norm(x_[j] - x_[i]), static_cast<std::uint32_t>(j)};
            const std::size_t count = std::min(neighbour_count + 1, near.size());
            std::partial_sort(near.begin(), near.begin() + std::ptrdiff_t(count), near.end());
            for (std::size_t k = 0; k < count && hoods_[i].count < neighbour_count; ++k)
                if (near[k].second != i) hoods_[i].index[hoods_[i].count++] = near[k].second;
            find_directions(x_, n_, i, hoods_[i]);
        }
    }

    /// The ball whose section runs along principal direction `section`.
    BlendFit along(int section) const {
        BlendFit f;
        double numerator = 0, denominator = 0, pairs = 0;
        std::vector<double> own;
        for (std::size_t i = 0; i < x_.size(); ++i) {
            const Vec3& spine = hoods_[i].principal[1 - section];
            double up = 0, down = 0;
            for (std::size_t k = 0; k < hoods_[i].count; ++k) {
                const std::uint32_t j = hoods_[i].index[k];
                Vec3 dx = x_[j] - x_[i], dn = n_[j] - n_[i];
                dx -= dot(dx, spine) * spine;
                dn -= dot(dn, spine) * spine;
                up += dot(dx, dn);
                down += squared_norm(dn);
            }
            pairs += double(hoods_[i].count);
            numerator += up;
            denominator += down;
            if (down > 0) own.push_back(up / down);
        }
        if (!(denominator > 0) || own.empty()) return f;
        const double r = numerator / denominator;
        f.radius = std::abs(r);
        f.outward = r >= 0;
        f.section_angle = std::sqrt(denominator / pairs);
        for (double& v : own) v = std::abs(v - r) / std::abs(r);
        std::nth_element(own.begin(), own.begin() + std::ptrdiff_t(own.size() / 2), own.end());
        f.radius_spread = own[own.size() / 2];
        Vec3 mean;
        std::vector<Vec3> centre;
        for (std::size_t i = 0; i < x_.size(); ++i) {
            centre.push_back(x_[i] - r * n_[i]);
            mean += (x_[i] - r * n_[i]) / double(x_.size());
        }
        double square = 0, extent = 0;
        for (std::size_t i = 0; i < x_.size(); ++i) {
            square += squared_thickness(centre, i, hoods_[i].principal[1 - section]);
            extent += squared_norm(centre[i] - mean);
        }
        f.spine_residual = std::sqrt(square / double(x_.size()));
        f.spine_extent = std::sqrt(extent / double(x_.size()));
        f.ok = std::isfinite(f.radius + f.spine_residual + f.spine_extent + f.radius_spread) && f.radius > 0;
        return f;
    }

    std::size_t size() const { return x_.size(); }

  private:
    /// Mean squared distance of the neighbourhood's centres from their own parabola over the spine's direction.
    double squared_thickness(const std::vector<Vec3>& centre, std::size_t i, const Vec3& spine) const {
        const Neighbourhood& hood = hoods_[i];
        double longest = 0;
        for (std::size_t k = 0; k < hood.count; ++k)
            longest = std::max(longest, std::abs(dot(centre[hood.index[k]] - centre[i], spine)));
        const double unit = longest > 0 ? 1 / longest : 0;
        double m[5] = {};
        Vec3 right[3];
        auto add = [&](const Vec3& d) {
            const double s = dot(d, spine) * unit;
            const Vec3 across = d - dot(d, spine) * spine;
            double power = 1;
            for (int k = 0; k < 5; ++k) {
                m[k] += power;
                if (k < 3) right[k] += power * across;
                power *= s;
            }
        };
        add({});
        for (std::size_t k = 0; k < hood.count; ++k) add(centre[hood.index[k]] - centre[i]);
        // Cholesky of the 3×3 Hankel matrix with a ridge: sections without extent along the spine fall back on the
        // mean.
        const double ridge = 1e-9 * m[0], l00 = std::sqrt(m[0] + ridge), l10 = m[1] / l00, l20 = m[2] / l00;
        const double l11 = std::sqrt(std::max(m[2] + ridge - l10 * l10, ridge)), l21 = (m[3] - l20 * l10) / l11;
        const double l22 = std::sqrt(std::max(m[4] + ridge - l20 * l20 - l21 * l21, ridge));
        const Vec3 y0 = right[0] / l00, y1 = (right[1] - l10 * y0) / l11, y2 = (right[2] - l20 * y0 - l21 * y1) / l22;
        const Vec3 c2 = y2 / l22, c1 = (y1 - l21 * c2) / l11, c0 = (y0 - l10 * c1 - l20 * c2) / l00;
        auto rest = [&](const Vec3& d) {
            const double s = dot(d, spine) * unit;
            return squared_norm(d - dot(d, spine) * spine - c0 - s * c1 - s * s * c2);
        };
        double sum = rest({});
        for (std::size_t k = 0; k < hood.count; ++k) sum += rest(centre[hood.index[k]] - centre[i]);
        // Three parameters were fitted.
        return sum / std::max(double(hood.count) + 1 - 3, 1.0);
    }

    std::vector<Vec3> x_, n_;
    std::vector<Neighbourhood> hoods_;
};

}  // namespace

BlendFit fit_blend(const PointSet& p) {
    if (p.normals.size() != p.points.size() || p.points.size() < least_points) return {};
    for (std::size_t i = 0; i < p.points.size(); ++i)
        if (!std::isfinite(squared_norm(p.points[i]) + squared_norm(p.normals[i]))) return {};
    const Canal canal(p);
    const BlendFit section = canal.along(0), other = canal.along(1);
    if (!other.ok) return section;
    if (!section.ok) return other;
    // Relative to the radius: a large ball always looks thick.
    return other.spine_residual / other.radius < 0.5 * section.spine_residual / section.radius ? other : section;
}

}  // namespace quadseg::surface
