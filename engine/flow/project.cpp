#include "flow/project.h"

#include "math/symmetric3.h"
#include "runtime/parallel.h"
#include "surface/surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

namespace quadseg::flow {

namespace {

constexpr double box_inflation = 0.01;  ///< of the diagonal
constexpr std::size_t grain = 4096;

struct Box {
    Vec3 low, high;
    bool contains(const Vec3& p) const noexcept {
        // False for what is not finite.
        return p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y && p.z <= high.z;
    }
};

Box inflated_box(const mesh::WorkMesh& mesh) {
    Box box{mesh.positions.front(), mesh.positions.front()};
    for (const Vec3& p : mesh.positions) {
        for (int k = 0; k < 3; ++k) {
            box.low[k] = std::min(box.low[k], p[k]);
            box.high[k] = std::max(box.high[k], p[k]);
        }
    }
    const double margin = box_inflation * norm(box.high - box.low);
    box.low -= {margin, margin, margin};
    box.high += {margin, margin, margin};
    return box;
}

/// Labels around every vertex, CSR, ascending and once each.
struct VertexLabels {
    std::vector<std::uint32_t> begin;
    std::vector<std::int32_t> label;
    std::span<const std::int32_t> of(std::size_t v) const {
        return {label.data() + begin[v], label.data() + begin[v + 1]};
    }
};

/// The first vertex at the same position: another than itself only where borders were stitched.
std::vector<std::uint32_t> first_at_position(const mesh::WorkMesh& mesh) {
    std::vector<std::uint32_t> first(mesh.vertex_count());
    std::iota(first.begin(), first.end(), 0U);
    if (mesh.report.stitched_edges == 0) return first;
    std::vector<std::uint32_t> order = first;
    const auto key = [&](std::uint32_t v) {
        const Vec3& p = mesh.positions[v];
        return std::tuple(p.x, p.y, p.z, v);
    };
    runtime::parallel_sort(order.begin(), order.end(),
                           [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    for (std::size_t i = 1; i < order.size(); ++i) {
        if (mesh.positions[order[i]] == mesh.positions[order[i - 1]]) first[order[i]] = first[order[i - 1]];
    }
    return first;
}

VertexLabels vertex_labels(const mesh::WorkMesh& mesh, const partition::Labels& labels,
                           const std::vector<std::uint32_t>& first, const runtime::RunControl& control) {
    VertexLabels result;
    result.begin.assign(mesh.vertex_count() + 1, 0);
    for (const auto& face : mesh.faces) {
        for (const std::uint32_t v : face) ++result.begin[first[v]];
    }
    runtime::exclusive_scan(result.begin);
    control.check();
    result.label.resize(3 * mesh.face_count());
    std::vector<std::uint32_t> next(result.begin.begin(), result.begin.end() - 1);
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        for (const std::uint32_t v : mesh.faces[f]) {
            // Most faces around a vertex have its last label.
            std::uint32_t& end = next[first[v]];
            if (end > result.begin[first[v]] && result.label[end - 1] == labels[f]) continue;
            result.label[end++] = labels[f];
        }
    }
    control.check();
    std::uint32_t filled = 0;
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
        const auto from = result.label.begin() + result.begin[v], to = result.label.begin() + next[v];
        std::sort(from, to);
        const auto unique_end = std::unique(from, to);
        result.begin[v] = filled;
        for (auto it = from; it != unique_end; ++it) {
            if (*it >= 0) result.label[filled++] = *it;
        }
    }
    result.begin.back() = filled;
    return result;
}

class VertexProjection {
  public:
    VertexProjection(const std::vector<FinalSurface>& surfaces, bool joint, const Box& box) : joint_(joint), box_(box) {
        projectors_.reserve(surfaces.size());
        for (const FinalSurface& s : surfaces) projectors_.emplace_back(s);
    }

    Vec3 operator()(const Vec3& p, std::span<const std::int32_t> labels) const {
        if (labels.empty()) return p;
        Vec3 sum;
        double count = 0;
        for (const std::int32_t label : labels) {
            const Vec3 foot = projectors_[static_cast<std::size_t>(label)].foot_point(p);
            if (!box_.contains(foot)) continue;  // this surface is nowhere near
            sum += foot;
            ++count;
        }
        if (count == 0) return p;
        if (labels.size() == 1) return sum;
        const Vec3 mean = sum / count;
        if (!joint_) return mean;
        std::array<const SurfaceProjector*, 8> incident{};
        const std::size_t used = std::min(labels.size(), incident.size());
        for (std::size_t i = 0; i < used; ++i) incident[i] = &projectors_[static_cast<std::size_t>(labels[i])];
        Vec3 common;
        const bool found = used == labels.size() && joint_projection({incident.data(), used}, p, common);
        return found && box_.contains(common) ? common : mean;
    }

  private:
    std::vector<SurfaceProjector> projectors_;
    bool joint_;
    Box box_;
};

}  // namespace

SurfaceProjector::SurfaceProjector(const FinalSurface& s)
    : closed_(s.surface), origin_(s.quadric.origin), is_closed_(s.surface.type <= SurfaceType::torus) {
    if (is_closed_) {
        evaluator_ = surface::SurfaceEvaluator(s.surface);
    } else {
        quadric_.projector = surface::QuadricProjector(s.quadric.c);
    }
}

Vec3 SurfaceProjector::foot_point(const Vec3& p) const noexcept {
    return is_closed_ ? surface::foot_point(closed_, p) : origin_ + quadric_.projector.foot_point(p - origin_);
}

double SurfaceProjector::distance(const Vec3& p) const noexcept {
    return is_closed_ ? evaluator_.distance(p) : quadric_.distance(p - origin_);
}

Vec3 SurfaceProjector::normal(const Vec3& p) const noexcept {
    return is_closed_ ? evaluator_.normal(p) : quadric_.normal(p - origin_);
}

bool joint_projection(std::span<const SurfaceProjector* const> surfaces, const Vec3& p, Vec3& result) {
    constexpr int iterations = 20;
    constexpr double converged = 1e-12, acceptable = 1e-10;  // unit frame
    // Of the normals' eigenvalues: surfaces that touch at less than about a degree do not fix a point across.
    constexpr double independent = 1e-4;
    double farthest = 0;
    for (const SurfaceProjector* s : surfaces) farthest = std::max(farthest, std::abs(s->distance(p)));
    const double most_move = 10 * farthest + converged;
    Vec3 x = p;
    double miss = std::numeric_limits<double>::infinity();
    for (int step = 0; step < iterations; ++step) {
        // x' = p + N⁺ (N (x − p) − d): the correction of smallest length that solves the linearised constraints.
        Symmetric3 normals;
        Vec3 right;
        miss = 0;
        for (const SurfaceProjector* s : surfaces) {
            const double d = s->distance(x);
            const Vec3 n = s->normal(x);
            miss = std::max(miss, std::abs(d));
            normals.add_outer(n);
            right += n * (dot(n, x - p) - d);
        }
        if (!std::isfinite(miss)) return false;
        const EigenSystem e = eigen_decomposition(normals);
        Vec3 next = p;
        for (int k = 0; k < 3; ++k) {
            if (e.values[k] > independent * e.values[2])
                next += (dot(e.vectors[k], right) / e.values[k]) * e.vectors[k];
        }
        const double move = norm(next - x);
        x = next;
        if (!(norm(x - p) <= most_move)) return false;
        if (miss <= converged && move <= converged) break;
    }
    miss = 0;
    for (const SurfaceProjector* s : surfaces) miss = std::max(miss, std::abs(s->distance(x)));
    if (!(miss <= acceptable)) return false;
    result = x;
    return true;
}

std::vector<double> projected_positions(const FlowInput& input, const partition::Labels& labels,
                                        const std::vector<FinalSurface>& surfaces) {
    const mesh::WorkMesh& mesh = input.mesh;
    input.control.check();
    std::vector<double> projected(3 * mesh.report.vertices, 0);
    if (mesh.vertex_count() == 0) return projected;
    const VertexProjection project(surfaces, input.options.project_joint, inflated_box(mesh));
    const std::vector<std::uint32_t> first = first_at_position(mesh);
    const VertexLabels around = vertex_labels(mesh, labels, first, input.control);
    runtime::parallel_blocks(mesh.vertex_count(), grain, [&](std::size_t begin, std::size_t end) {
        std::size_t polls = 0;  // a foot point on a general quadric takes microseconds
        input.control.check();
        for (std::size_t v = begin; v < end; ++v) {
            input.control.check_often(polls);
            const Vec3 p = mesh.frame.to_input(project(mesh.positions[v], around.of(first[v])));
            double* out = &projected[3 * std::size_t{mesh.input_vertex[v]}];
            out[0] = p.x;
            out[1] = p.y;
            out[2] = p.z;
        }
    });
    return projected;
}

UnusedVertices::UnusedVertices(const mesh::WorkMesh& mesh, std::span<const double> input_positions) {
    std::vector<std::uint8_t> used(input_positions.size() / 3, 0);
    for (const std::uint32_t v : mesh.input_vertex) used[v] = 1;
    for (std::size_t v = 0; v < used.size(); ++v) {
        if (used[v] != 0) continue;
        vertex.push_back(v);
        for (std::size_t k = 0; k < 3; ++k) positions.push_back(input_positions[3 * v + k]);
    }
}

void UnusedVertices::restore(std::vector<double>& projected) const {
    if (projected.empty()) return;
    for (std::size_t i = 0; i < vertex.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) projected[3 * vertex[i] + k] = positions[3 * i + k];
    }
}

}  // namespace quadseg::flow
