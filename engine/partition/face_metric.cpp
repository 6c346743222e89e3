#include "partition/face_metric.h"

#include <algorithm>
#include <limits>

namespace quadseg::partition {

namespace {

/// Mean values over a face of f² and |g|², g = ∇f − n, both divided by |∇f|² when normalised.
struct MeanEnergy {
    double distance, normal;
};

/// Corners relative to the proxy's origin.
MeanEnergy mean_energy(const quadric::Proxy& proxy, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& n,
                       bool normalised) noexcept {
    const Vec3 ga = quadric::gradient(proxy.c, a), gb = quadric::gradient(proxy.c, b),
               gc = quadric::gradient(proxy.c, c);

    // Along an edge e from p to q a quadratic rises by (∇f(p) + ∇f(q))·e/2, and its middle lies (∇f(q) − ∇f(p))·e/8
    // below the mean of its ends.
    const Vec3 ab = b - a, bc = c - b, ca = a - c;
    const double fa = quadric::value(proxy.c, a), fb = fa + 0.5 * dot(ga + gb, ab), fc = fa - 0.5 * dot(gc + ga, ca);
    const double mab = 0.5 * (fa + fb) - 0.125 * dot(gb - ga, ab);
    const double mbc = 0.5 * (fb + fc) - 0.125 * dot(gc - gb, bc);
    const double mca = 0.5 * (fc + fa) - 0.125 * dot(ga - gc, ca);
    // fᵀ Q f of MATH.md §2, Q/180.
    const double corners = 6 * (fa * fa + fb * fb + fc * fc) - 2 * (fa * fb + fb * fc + fc * fa);
    const double mixed = -8 * (fa * mbc + fb * mca + fc * mab);
    const double middles = 32 * (mab * mab + mbc * mbc + mca * mca + mab * mbc + mbc * mca + mca * mab);
    const double square = std::max(0.0, (corners + mixed + middles) / 180);

    double inverse = 1;
    if (normalised) inverse = 1 / std::max(norm(ga + gb + gc) / 3, proxy.gradient_floor);
    const Vec3 da = ga * inverse - n, db = gb * inverse - n, dc = gc * inverse - n;
    const double deviation = (squared_norm(da) + squared_norm(db) + squared_norm(dc) + squared_norm(da + db + dc)) / 12;
    return {square * inverse * inverse, deviation};
}

MeanEnergy mean_energy(const mesh::WorkMesh& mesh, std::size_t face, const quadric::Proxy& proxy,
                       bool normalised) noexcept {
    const auto& v = mesh.faces[face];
    return mean_energy(proxy, mesh.positions[v[0]] - proxy.origin, mesh.positions[v[1]] - proxy.origin,
                       mesh.positions[v[2]] - proxy.origin, mesh.normals[face], normalised);
}

/// NaN and infinity count as the worst value.
double finite(double x) noexcept {
    return x < std::numeric_limits<double>::max() ? x : std::numeric_limits<double>::max();
}

}  // namespace

quadric::TriangleEnergy face_energy(const mesh::WorkMesh& mesh, std::size_t face, const quadric::Proxy& proxy,
                                    bool normalised) noexcept {
    const double area = mesh.areas[face];
    if (!(area > 0)) return {};
    const MeanEnergy mean = mean_energy(mesh, face, proxy, normalised);
    return {mean.distance * area, mean.normal * area};
}

quadric::TriangleEnergy corner_energy(const quadric::Proxy& proxy, const Vec3& a, const Vec3& b, const Vec3& c,
                                      const Vec3& n, double area, bool normalised) noexcept {
    if (!(area > 0)) return {};
    const Vec3& o = proxy.origin;
    const MeanEnergy mean = mean_energy(proxy, a - o, b - o, c - o, n, normalised);
    return {mean.distance * area, mean.normal * area};
}

double error_density(const mesh::WorkMesh& mesh, std::size_t face, const quadric::Proxy& proxy,
                     const FaceMetric& metric) noexcept {
    if (!(mesh.areas[face] > 0)) return 0;
    const MeanEnergy mean = mean_energy(mesh, face, proxy, metric.normalised);
    return finite(metric.distance * mean.distance + metric.normal * mean.normal);
}

}  // namespace quadseg::partition
