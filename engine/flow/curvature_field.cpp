#include "flow/curvature_field.h"

#include "mesh/marks.h"
#include "runtime/parallel.h"
#include "runtime/per_thread.h"

#include <algorithm>
#include <cmath>

namespace quadseg::flow {

namespace {

constexpr std::size_t wanted_points = 8;
constexpr int most_rings = 4;
constexpr std::size_t faces_per_task = 512;
/// Curvatures below 1 / (the unit frame's extent) are those of a plane.
constexpr double flat = 1;

struct Disc {
    std::vector<std::uint32_t> faces;
    std::vector<Vec3> points;
    mesh::Marks marks;
};

class DiscCollector {
  public:
    DiscCollector(const mesh::WorkMesh& mesh, std::span<const std::uint8_t> active, const mesh::FeatureEdges& creases)
        : mesh_(mesh), active_(active), creases_(creases) {}

    /// Rings of faces around f, creases and inactive faces not entered, until there are points enough.
    void collect(std::uint32_t f, Disc& disc) const {
        disc.marks.prepare(mesh_.face_count(), mesh_.vertex_count());
        disc.marks.clear();
        disc.faces.clear();
        disc.points.clear();
        take(f, disc);
        std::size_t begin = 0;
        for (int ring = 1; ring <= most_rings; ++ring) {
            const std::size_t end = disc.faces.size();
            for (std::size_t i = begin; i < end; ++i) {
                const std::uint32_t g = disc.faces[i];
                for (std::size_t k = 0; k < 3; ++k) {
                    const std::int32_t n = mesh_.neighbors[g][k];
                    if (n < 0 || active_[static_cast<std::size_t>(n)] == 0 || (creases_[g] >> k & 1) != 0) continue;
                    if (!disc.marks.has_face(static_cast<std::size_t>(n))) take(static_cast<std::uint32_t>(n), disc);
                }
            }
            if (disc.faces.size() == end) return;
            if (disc.points.size() >= wanted_points) return;
            begin = end;
        }
    }

  private:
    void take(std::uint32_t f, Disc& disc) const {
        disc.marks.mark_face(f);
        disc.faces.push_back(f);
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t v = mesh_.faces[f][static_cast<std::size_t>(k)];
            if (disc.marks.mark_vertex(v)) disc.points.push_back(mesh_.positions[v]);
        }
    }

    const mesh::WorkMesh& mesh_;
    std::span<const std::uint8_t> active_;
    const mesh::FeatureEdges& creases_;
};

/// A symmetric form in a tangent plane.
struct Form {
    double xx = 0, xy = 0, yy = 0;
};

/// The form in axes turned by the angle of (cosine, sine).
Form turned(const Form& form, double cosine, double sine) {
    const double cc = cosine * cosine, ss = sine * sine, cs = cosine * sine;
    return {cc * form.xx + 2 * cs * form.xy + ss * form.yy, cs * (form.yy - form.xx) + (cc - ss) * form.xy,
            ss * form.xx - 2 * cs * form.xy + cc * form.yy};
}

/// RMS over the points of a disc of the curvature that a form gives to them: directions in which the disc has no
/// points do not count.
double seen_by(const surface::CurvatureTensor& disc, const Form& form) {
    const auto& m = disc.spread;
    const double square = form.xx * form.xx * m[0] + 4 * form.xx * form.xy * m[1] +
                          (2 * form.xx * form.yy + 4 * form.xy * form.xy) * m[2] + 4 * form.xy * form.yy * m[3] +
                          form.yy * form.yy * m[4];
    return std::sqrt(std::max(0.0, square));
}

/// Direction of an edge in the tangent plane of a disc: cosine and sine to its x axis.
struct Direction {
    double cosine, sine;
};
Direction direction_in(const surface::CurvatureTensor& disc, const Vec3& edge) {
    const double x = dot(edge, disc.x_axis), y = dot(edge, cross(disc.normal, disc.x_axis));
    const double length = std::hypot(x, y);
    return length > 0 ? Direction{x / length, y / length} : Direction{1, 0};
}

}  // namespace

CurvatureField estimate_curvatures(const mesh::WorkMesh& mesh, std::span<const std::uint8_t> active,
                                   const mesh::FeatureEdges& creases, const runtime::RunControl& control) {
    CurvatureField field;
    field.slot.assign(mesh.face_count(), -1);
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        if (active[f] == 0) continue;
        field.slot[f] = static_cast<std::int32_t>(field.face.size());
        field.face.push_back(static_cast<std::uint32_t>(f));
    }
    const DiscCollector collector(mesh, active, creases);
    runtime::PerThread<Disc> scratch;
    const auto for_every_disc = [&](const auto& body) {
        runtime::parallel_blocks(field.face.size(), faces_per_task, [&](std::size_t begin, std::size_t end) {
            control.check();
            Disc& disc = scratch.local();
            for (std::size_t i = begin; i < end; ++i) {
                collector.collect(field.face[i], disc);
                body(i, disc);
            }
        });
    };
    std::vector<surface::CurvatureTensor> centred(field.face.size());
    for_every_disc([&](std::size_t i, const Disc& disc) {
        Vec3 orientation;
        for (const std::uint32_t g : disc.faces) orientation += mesh.normals[g] * mesh.areas[g];
        centred[i] = surface::fit_curvature(disc.points, mesh.centroid(field.face[i]), orientation);
    });
    field.tensor.resize(field.face.size());
    for_every_disc([&](std::size_t i, const Disc& disc) {
        std::size_t best = i;
        for (const std::uint32_t g : disc.faces) {
            const auto other = static_cast<std::size_t>(field.slot[g]);
            if (centred[other].error < centred[best].error ||
                (centred[other].error == centred[best].error && other < best)) {
                best = other;
            }
        }
        field.tensor[i] = centred[best];
    });
    return field;
}

CurvatureJump curvature_jump(const CurvatureField& field, const mesh::WorkMesh& mesh, std::size_t f,
                             std::size_t k) noexcept {
    const surface::CurvatureTensor& one = field.of(f);
    const surface::CurvatureTensor& other = field.of(static_cast<std::size_t>(mesh.neighbors[f][k]));
    if (!std::isfinite(one.error) || !std::isfinite(other.error)) return {};
    const Vec3 edge = mesh.corner(f, static_cast<int>((k + 1) % 3)) - mesh.corner(f, static_cast<int>(k));
    const Direction e = direction_in(one, edge), d = direction_in(other, edge);
    const Form a{one.along_x, one.mixed, one.along_y}, b{other.along_x, other.mixed, other.along_y};
    // b in the frame of a: the edge has angle e there and d in its own.
    const double cosine = e.cosine * d.cosine + e.sine * d.sine, sine = e.cosine * d.sine - e.sine * d.cosine;
    const Form b_in_a = turned(b, cosine, sine), a_in_b = turned(a, cosine, -sine);
    const auto seen = [](const surface::CurvatureTensor& disc, const Form& own, const Form& others) {
        CurvatureJump jump;
        jump.difference = seen_by(disc, {own.xx - others.xx, own.xy - others.xy, own.yy - others.yy});
        jump.relative = jump.difference / std::max({seen_by(disc, own), seen_by(disc, others), flat});
        return jump;
    };
    const CurvatureJump by_one = seen(one, a, b_in_a), by_other = seen(other, b, a_in_b);
    return by_one.relative <= by_other.relative ? by_one : by_other;
}

}  // namespace quadseg::flow
