#include "simplify/rating.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace quadseg::simplify {
namespace {

constexpr std::size_t lanes = 8;
using Lane = std::array<double, lanes>;

/// The sums of the quadrics of the ends, and the middles and squared lengths of the edges.
struct Edges {
    Lane xx, xy, xz, yy, yz, zz, bx, by, bz, c, area, mx, my, mz, length2;

    void set(std::size_t i, const Vertex& v, const Vertex& w) noexcept {
        const ErrorQuadric &p = v.quadric, &q = w.quadric;
        xx[i] = p.xx + q.xx;
        xy[i] = p.xy + q.xy;
        xz[i] = p.xz + q.xz;
        yy[i] = p.yy + q.yy;
        yz[i] = p.yz + q.yz;
        zz[i] = p.zz + q.zz;
        bx[i] = p.b.x + q.b.x;
        by[i] = p.b.y + q.b.y;
        bz[i] = p.b.z + q.b.z;
        c[i] = p.c + q.c;
        area[i] = p.area + q.area;
        const Vec3 middle = (v.position + w.position) * 0.5;
        mx[i] = middle.x;
        my[i] = middle.y;
        mz[i] = middle.z;
        length2[i] = squared_norm(w.position - v.position);
    }
};

/// ErrorQuadric::minimum_near() and the error there, operation by operation, lane by lane; `moved2`: how far it is
/// from the middle, squared; not a number where there is no plane. No branches: the compiler makes packs of the lanes.
void rate_lanes(const Edges& e, Lane& error, Lane& moved2) noexcept {
    for (std::size_t i = 0; i < lanes; ++i) {
        const double ridge = 1e-6 * (e.xx[i] + e.yy[i] + e.zz[i]);
        const double dx = e.xx[i] + ridge, dy = e.yy[i] + ridge, dz = e.zz[i] + ridge;
        const double xy = e.xy[i], xz = e.xz[i], yz = e.yz[i];
        const double ixx = dy * dz - yz * yz, ixy = xz * yz - xy * dz, ixz = xy * yz - xz * dy;
        const double iyy = dx * dz - xz * xz, iyz = xy * xz - dx * yz, izz = dx * dy - xy * xy;
        const double determinant = dx * ixx + xy * ixy + xz * ixz;
        const double inverse = 1.0 / determinant;
        double x = e.mx[i], y = e.my[i], z = e.mz[i];
        for (int step = 0; step < 2; ++step) {
            const double gx = (e.xx[i] * x + xy * y + xz * z + e.bx[i]) * inverse;
            const double gy = (xy * x + e.yy[i] * y + yz * z + e.by[i]) * inverse;
            const double gz = (xz * x + yz * y + e.zz[i] * z + e.bz[i]) * inverse;
            x -= ixx * gx + ixy * gy + ixz * gz;
            y -= ixy * gx + iyy * gy + iyz * gz;
            z -= ixz * gx + iyz * gy + izz * gz;
        }
        const double ex = e.xx[i] * x + xy * y + xz * z + e.bx[i] * 2.0;
        const double ey = xy * x + e.yy[i] * y + yz * z + e.by[i] * 2.0;
        const double ez = xz * x + yz * y + e.zz[i] * z + e.bz[i] * 2.0;
        error[i] = x * ex + y * ey + z * ez + e.c[i];
        const double ux = x - e.mx[i], uy = y - e.my[i], uz = z - e.mz[i];
        moved2[i] = ux * ux + uy * uy + uz * uz;
    }
}

/// Bound vertices stay in their places: place_collapsed() alone knows.
bool is_bound(const Vertex& v, const Vertex& w) {
    return ((v.flags | w.flags) & (vertex_border | vertex_locked)) != 0;
}

}  // namespace

void rate_edges(const CollapseMesh& mesh, std::span<RatedEdge> edges) {
    Edges group;
    Lane error, moved2;
    for (std::size_t begin = 0; begin < edges.size(); begin += lanes) {
        const std::size_t count = std::min(lanes, edges.size() - begin);
        for (std::size_t i = 0; i < lanes; ++i) {
            const RatedEdge& edge = edges[begin + std::min(i, count - 1)];
            group.set(i, mesh.vertices[edge.v], mesh.vertices[edge.w]);
        }
        rate_lanes(group, error, moved2);
        for (std::size_t i = 0; i < count; ++i) {
            RatedEdge& edge = edges[begin + i];
            const bool plain =
                moved2[i] <= 4 * group.length2[i] && !is_bound(mesh.vertices[edge.v], mesh.vertices[edge.w]);
            const double by_length = length_weight * group.area[i] * group.length2[i];
            edge.cost = static_cast<float>(plain ? std::max(error[i], 0.0) + by_length
                                                 : place_collapsed(mesh, edge.v, edge.w).cost);
        }
    }
}

}  // namespace quadseg::simplify
