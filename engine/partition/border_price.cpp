#include "partition/border_price.h"

#include <algorithm>

namespace quadseg::partition {
namespace {

/// A fit that goes astray beyond its region must not forbid a border.
constexpr double largest_gap_share = 10;

/// First-order distance of x above the surface, up being where `up` points.
double height_above(const quadric::Proxy& proxy, const Vec3& x, const Vec3& up) noexcept {
    const Vec3 local = x - proxy.origin, gradient = quadric::gradient(proxy.c, local);
    const double steepness = std::max(norm(gradient), proxy.gradient_floor);
    const double height = steepness > 0 ? quadric::value(proxy.c, local) / steepness : 0;
    return dot(gradient, up) < 0 ? -height : height;
}

}  // namespace

double BorderPrice::of_edge(const mesh::WorkMesh& mesh, std::size_t f, std::size_t k, std::size_t g,
                            const quadric::Proxy& a, const quadric::Proxy& b) const noexcept {
    const double plain = length * edge_length(mesh, f, k);
    if (!(gap > 0)) return plain;
    const auto& v = mesh.faces[f];
    const Vec3 middle = (mesh.positions[v[k]] + mesh.positions[v[(k + 1) % 3]]) * 0.5;
    const Vec3 up = mesh.normals[f] + mesh.normals[g];
    // The noise of the point itself is in both heights and falls out.
    const double apart = height_above(a, middle, up) - height_above(b, middle, up);
    const double share = gap * apart * apart;
    return plain * (1 + (share < largest_gap_share ? share : largest_gap_share));
}

}  // namespace quadseg::partition
