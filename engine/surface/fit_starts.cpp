#include "surface/fit_starts.h"

#include "math/symmetric3.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace quadseg::surface {

namespace {

/// Solves m x = v for a symmetric matrix by its eigenvalues; directions below `cut` of the largest are left at 0.
Vec3 solve(const EigenSystem& e, const Vec3& v, double cut) {
    const double top = std::max(std::abs(e.values[0]), std::abs(e.values[2]));
    Vec3 x;
    for (int i = 0; i < 3; ++i)
        if (std::abs(e.values[i]) > cut * top) x += (dot(e.vectors[i], v) / e.values[i]) * e.vectors[i];
    return x;
}

Symmetric3 covariance_of_points(const LocalPoints& p) {
    double sum = 0;
    Vec3 mean;
    for (std::size_t i = 0; i < p.size(); ++i) {
        mean += p.weight[i] * p.point(i);
        sum += p.weight[i];
    }
    mean = mean / (sum > 0 ? sum : 1);
    Symmetric3 m;
    for (std::size_t i = 0; i < p.size(); ++i) m.add_outer(p.point(i) - mean, p.weight[i]);
    return m;
}

Vec3 mean_normal(const LocalPoints& p) {
    Vec3 sum;
    for (std::size_t i = 0; i < p.normals.size(); ++i) sum += p.weight[i] * p.normals[i];
    return sum;
}

/// Circle through points of a plane: x² + y² = 2 cx x + 2 cy y + k about their mean (Kåsa: exact for exact points).
struct Circle {
    double x = 0, y = 0, radius = 0;
};
template <class Coordinates>
Circle fit_circle(std::size_t n, const double* weight, Coordinates&& at) {
    double sum = 0, mx = 0, my = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const auto [x, y] = at(i);
        sum += weight[i];
        mx += weight[i] * x;
        my += weight[i] * y;
    }
    if (!(sum > 0)) return {};
    mx /= sum;
    my /= sum;
    double xx = 0, xy = 0, yy = 0, xr = 0, yr = 0, r = 0;
    for (std::size_t i = 0; i < n; ++i) {
        auto [x, y] = at(i);
        x -= mx;
        y -= my;
        const double rr = x * x + y * y, w = weight[i];
        xx += w * x * x;
        xy += w * x * y;
        yy += w * y * y;
        xr += w * x * rr;
        yr += w * y * rr;
        r += w * rr;
    }
    const double determinant = xx * yy - xy * xy;
    if (!(determinant > 1e-15 * (xx + yy) * (xx + yy))) return {};
    const double cx = 0.5 * (xr * yy - yr * xy) / determinant, cy = 0.5 * (yr * xx - xr * xy) / determinant;
    return {cx + mx, cy + my, std::sqrt(cx * cx + cy * cy + r / sum)};
}

double squared_error(const Circle& c, std::size_t n, const double* weight, auto&& at) {
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const auto [x, y] = at(i);
        const double d = std::hypot(x - c.x, y - c.y) - c.radius;
        sum += weight[i] * d * d;
    }
    return sum;
}

struct Pair {
    double first, second;
};

Surface make(SurfaceType type, const Vec3& point, const Vec3& axis) {
    Surface s;
    s.type = type;
    s.point = to_array(point);
    s.axis = to_array(axis);
    return s;
}

double sphere_error(const LocalPoints& p, const Vec3& centre, double radius) {
    double sum = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const double d = norm(p.point(i) - centre) - radius;
        sum += p.weight[i] * d * d;
    }
    return sum;
}

}  // namespace

Vec3 anchor(const Surface& s, const LocalPoints& p) {
    double best = std::numeric_limits<double>::infinity();
    Vec3 anchor;
    const Vec3 point = to_vec3(s.point), axis = to_vec3(s.axis);
    double mean_rho = 0;
    if (s.type == SurfaceType::cone) {
        for (std::size_t i = 0; i < p.size(); ++i) {
            const Vec3 u = p.point(i) - point;
            mean_rho += norm(u - dot(u, axis) * axis) / double(p.size());
        }
    }
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Vec3 x = p.point(i), u = x - point;
        double cost = norm(x);
        const double z = dot(u, axis), rho = norm(u - z * axis);
        if (s.type == SurfaceType::cone && rho < 0.5 * mean_rho) cost += 10;
        if (s.type == SurfaceType::torus) {
            // Where the normal is parallel to the axis the frame is singular.
            const double w = rho - s.radius;
            // Clearly less than 60 degrees need no root.
            if (!(z * z < 2.9 * (w * w))) {
                const double length = std::hypot(w, z), cosine = length > 0 ? std::abs(w) / length : 0;
                cost += cosine < 0.5 ? 10 * (1.5 - cosine) : 0;
            }
            if (!(rho > 0)) cost += 100;
        }
        if (cost < best) {
            best = cost;
            anchor = x;
        }
    }
    return anchor;
}

Surface start_plane(const LocalPoints& p) {
    Vec3 n = eigen_decomposition(covariance_of_points(p)).vectors[0];
    if (dot(n, mean_normal(p)) < 0) n = -n;
    double sum = 0;
    Vec3 mean;
    for (std::size_t i = 0; i < p.size(); ++i) {
        mean += p.weight[i] * p.point(i);
        sum += p.weight[i];
    }
    return make(SurfaceType::plane, mean / (sum > 0 ? sum : 1), n);
}

Surface start_sphere(const LocalPoints& p) {
    Surface s = make(SurfaceType::sphere, {}, {0, 0, 1});
    // |x|² = 2 c·x + k, the points being centred.
    Symmetric3 m;
    Vec3 right, mean;
    double sum = 0, square = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
        mean += p.weight[i] * p.point(i);
        sum += p.weight[i];
    }
    if (!(sum > 0)) return s;
    mean = mean / sum;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Vec3 u = p.point(i) - mean;
        const double uu = squared_norm(u), w = p.weight[i];
        m.add_outer(u, 2 * w);
        right += w * uu * u;
        square += w * uu;
    }
    Vec3 centre = solve(eigen_decomposition(m), right, 1e-13);
    double radius = std::sqrt(square / sum + squared_norm(centre));
    centre += mean;
    if (!p.normals.empty()) {
        // x = c + r n: the same from the normals, for points that hardly leave a plane.
        Vec3 mean_n = mean_normal(p) / sum;
        double covariance = 0, variance = 0;
        for (std::size_t i = 0; i < p.size(); ++i) {
            const Vec3 n = p.normals[i] - mean_n;
            covariance += p.weight[i] * dot(n, p.point(i) - mean);
            variance += p.weight[i] * squared_norm(n);
        }
        if (variance > 1e-20 * sum) {
            const double r = covariance / variance;
            const Vec3 c = mean - r * mean_n;
            if (std::isfinite(r) && std::abs(r) > 0 &&
                sphere_error(p, c, std::abs(r)) < sphere_error(p, centre, radius)) {
                centre = c;
                radius = std::abs(r);
            }
        }
    }
    s.point = to_array(centre);
    s.radius = radius;
    return s;
}

namespace {

Surface cylinder_along(const Vec3& axis, const Vec3& ex, const Vec3& ey, const LocalPoints& p) {
    Surface s = make(SurfaceType::cylinder, {}, axis);
    auto at = [&](std::size_t i) {
        const Vec3 u = p.point(i);
        return Pair{dot(u, ex), dot(u, ey)};
    };
    Circle best = fit_circle(p.size(), p.weight, at);
    // Nearest point to the normals' lines: better where the arc is short.
    double xx = 0, xy = 0, yy = 0, rx = 0, ry = 0, sum = 0;
    for (std::size_t i = 0; i < p.normals.size(); ++i) {
        const auto [x, y] = at(i);
        const double nx = dot(p.normals[i], ex), ny = dot(p.normals[i], ey), w = p.weight[i], c = x * ny - y * nx;
        xx += w * ny * ny;
        xy -= w * nx * ny;
        yy += w * nx * nx;
        rx += w * c * ny;
        ry -= w * c * nx;
        sum += w;
    }
    const double determinant = xx * yy - xy * xy;
    if (determinant > 1e-15 * (xx + yy) * (xx + yy) && sum > 0) {
        Circle c{(rx * yy - ry * xy) / determinant, (ry * xx - rx * xy) / determinant, 0};
        for (std::size_t i = 0; i < p.size(); ++i) {
            const auto [x, y] = at(i);
            c.radius += p.weight[i] * std::hypot(x - c.x, y - c.y);
        }
        c.radius /= sum;
        if (!(best.radius > 0) ||
            squared_error(c, p.size(), p.weight, at) < squared_error(best, p.size(), p.weight, at))
            best = c;
    }
    s.point = to_array(best.x * ex + best.y * ey);
    s.radius = best.radius;
    return s;
}

}  // namespace

Surface start_cylinder(const LocalPoints& p) {
    Symmetric3 m;
    for (std::size_t i = 0; i < p.normals.size(); ++i) m.add_outer(p.normals[i], p.weight[i]);
    const EigenSystem e = eigen_decomposition(m);
    return cylinder_along(e.vectors[0], e.vectors[1], e.vectors[2], p);
}

Surface start_cylinder_along(const LocalPoints& p) {
    const EigenSystem e = eigen_decomposition(covariance_of_points(p));
    return cylinder_along(e.vectors[2], e.vectors[0], e.vectors[1], p);
}

Surface start_cone(const LocalPoints& p) {
    // Tangent planes meet in the apex; normals lie on a cone about the axis.
    Symmetric3 m, spread;
    Vec3 right, mean;
    double sum = 0;
    for (std::size_t i = 0; i < p.normals.size(); ++i) {
        const Vec3& n = p.normals[i];
        m.add_outer(n, p.weight[i]);
        right += p.weight[i] * dot(n, p.point(i)) * n;
        mean += p.weight[i] * n;
        sum += p.weight[i];
    }
    mean = mean / (sum > 0 ? sum : 1);
    for (std::size_t i = 0; i < p.normals.size(); ++i) spread.add_outer(p.normals[i] - mean, p.weight[i]);
    const Vec3 apex = solve(eigen_decomposition(m), right, 1e-14);
    Vec3 axis = eigen_decomposition(spread).vectors[0];
    double along = 0, across = 0;
    for (std::size_t i = 0; i < p.size(); ++i) along += p.weight[i] * dot(p.point(i) - apex, axis);
    if (along < 0) axis = -axis;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Vec3 u = p.point(i) - apex;
        across += p.weight[i] * norm(u - dot(u, axis) * axis);
    }
    Surface s = make(SurfaceType::cone, apex, axis);
    s.half_angle = std::atan2(across, std::abs(along));
    return s;
}

Surface start_cone_from(const Surface& cylinder, const LocalPoints& p) {
    const Vec3 point = to_vec3(cylinder.point);
    Vec3 axis = to_vec3(cylinder.axis);
    double sum = 0, z0 = 0, r0 = 0, zz = 0, zr = 0;
    auto at = [&](std::size_t i) {
        const Vec3 u = p.point(i) - point;
        const double z = dot(u, axis);
        return Pair{z, norm(u - z * axis)};
    };
    for (std::size_t i = 0; i < p.size(); ++i) {
        const auto [z, r] = at(i);
        sum += p.weight[i];
        z0 += p.weight[i] * z;
        r0 += p.weight[i] * r;
    }
    z0 /= sum;
    r0 /= sum;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const auto [z, r] = at(i);
        zz += p.weight[i] * (z - z0) * (z - z0);
        zr += p.weight[i] * (z - z0) * (r - r0);
    }
    double slope = zz > 0 ? zr / zz : 0;
    if (slope < 0) {
        slope = -slope;
        axis = -axis;
        z0 = -z0;
    }
    slope = std::max(slope, 1e-3);  // the apex has to be somewhere
    Surface s = make(SurfaceType::cone, point + (z0 - r0 / slope) * axis, axis);
    s.half_angle = std::atan(slope);
    return s;
}

Surface start_torus_about(const Vec3& point, const Vec3& direction, const LocalPoints& p) {
    auto at = [&](std::size_t i) {
        const Vec3 u = p.point(i) - point;
        const double z = dot(u, direction);
        return Pair{norm(u - z * direction), z};
    };
    const Circle c = fit_circle(p.size(), p.weight, at);
    Surface s = make(SurfaceType::torus, point + c.y * direction, direction);
    s.radius = c.x;
    s.minor_radius = c.radius;
    return s;
}

TorusAxes::TorusAxes(const LocalPoints& p) {
    // Normal lines (n, x×n) meet the axis (a, m): n·m + a·(x×n) = 0, the 6×6 line complex, m eliminated.
    Symmetric3 nn, qq;
    double nq[3][3] = {};
    for (std::size_t i = 0; i < p.normals.size(); ++i) {
        const Vec3 &n = p.normals[i], q = cross(p.point(i), n);
        nn.add_outer(n, p.weight[i]);
        qq.add_outer(q, p.weight[i]);
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c) nq[r][c] += p.weight[i] * n[r] * q[c];
    }
    const double cut = 1e-10;
    const EigenSystem directions = eigen_decomposition(nn);
    Vec3 columns[3];  // nn⁻¹ · (column of nq)
    for (int c = 0; c < 3; ++c) columns[c] = solve(directions, {nq[0][c], nq[1][c], nq[2][c]}, cut);
    double reduced[3][3];
    const double full[3][3] = {{qq.xx, qq.xy, qq.xz}, {qq.xy, qq.yy, qq.yz}, {qq.xz, qq.yz, qq.zz}};
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c)
            reduced[r][c] = full[r][c] - (nq[0][r] * columns[c].x + nq[1][r] * columns[c].y + nq[2][r] * columns[c].z);
    const EigenSystem e = eigen_decomposition({reduced[0][0], 0.5 * (reduced[0][1] + reduced[1][0]),
                                               0.5 * (reduced[0][2] + reduced[2][0]), reduced[1][1],
                                               0.5 * (reduced[1][2] + reduced[2][1]), reduced[2][2]});
    for (int rank = 0; rank < 3; ++rank) {
        const Vec3 a = e.vectors[rank];
        direction_[rank] = a;
        point_[rank] = cross(a, -1.0 * (a.x * columns[0] + a.y * columns[1] + a.z * columns[2]));
    }
}

Surface TorusAxes::start(const LocalPoints& p, int rank) const {
    return start_torus_about(point_[rank], direction_[rank], p);
}

Surface start_torus_from(const Surface& cylinder, const LocalPoints& p) {
    // Distances from the cylinder: −½ z² k (e·n) for a spine of curvature k e, beside what a shifted, turned and
    // resized cylinder explains.
    constexpr int K = 7;
    const Vec3 point = to_vec3(cylinder.point), t = to_vec3(cylinder.axis), ex = any_perpendicular(t),
               ey = cross(t, ex);
    double m[K][K] = {}, right[K] = {};
    double z0 = 0, sum = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
        z0 += p.weight[i] * dot(p.point(i) - point, t);
        sum += p.weight[i];
    }
    z0 /= sum > 0 ? sum : 1;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Vec3 u = p.point(i) - point;
        const double z = dot(u, t) - z0, x = dot(u, ex), y = dot(u, ey), rho = std::hypot(x, y);
        if (!(rho > 0)) continue;
        const double nx = x / rho, ny = y / rho,
                     row[K] = {-.5 * z * z * nx, -.5 * z * z * ny, 1, nx, ny, z * nx, z * ny};
        for (int r = 0; r < K; ++r) {
            for (int c = 0; c <= r; ++c) m[r][c] += p.weight[i] * row[r] * row[c];
            right[r] += p.weight[i] * row[r] * (rho - cylinder.radius);
        }
    }
    // Gaussian elimination from the last unknown down, with a ridge: what is left gives k e.
    for (int r = 0; r < K; ++r) m[r][r] += 1e-12 * (m[r][r] + sum);
    for (int r = 0; r < K; ++r)
        for (int c = r + 1; c < K; ++c) m[r][c] = m[c][r];
    for (int k = K - 1; k > 0; --k) {
        for (int r = 0; r < k; ++r) {
            const double f = m[r][k] / m[k][k];
            for (int c = 0; c < k; ++c) m[r][c] -= f * m[k][c];
            right[r] -= f * right[k];
        }
    }
    const double kx = right[0] / m[0][0], ky = (right[1] - m[1][0] * kx) / m[1][1], k = std::hypot(kx, ky);
    Surface s = make(SurfaceType::torus, {}, t);
    if (!(k > 0)) return s;
    const Vec3 e = (kx / k) * ex + (ky / k) * ey;
    s.axis = to_array(cross(t, e));
    s.point = to_array(point + z0 * t + e / k);
    s.radius = 1 / k;
    s.minor_radius = cylinder.radius;
    return s;
}

}  // namespace quadseg::surface
