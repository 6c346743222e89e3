#include "simplify/piece.h"

#include "runtime/parallel.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace quadseg::simplify {
namespace {

constexpr std::size_t rating_grain = 8192;
/// Edges taken from the queue between two questions whether to stop.
constexpr std::size_t poll_interval = 64;

std::size_t spread(std::uint32_t v, std::size_t slots) {
    return (std::uint64_t{v} * 0x9e3779b97f4a7c15U >> 32) & (slots - 1);
}

}  // namespace

std::uint32_t Piece::local_vertex(const CollapseMesh& mesh, std::uint32_t v) {
    std::size_t slot = spread(v, slots_.size());
    for (; slots_[slot] != none; slot = (slot + 1) & (slots_.size() - 1)) {
        if (global_vertex_[slots_[slot]] == v) return slots_[slot];
    }
    const auto i = static_cast<std::uint32_t>(global_vertex_.size());
    slots_[slot] = i;
    global_vertex_.push_back(v);
    local_.vertices.push_back(mesh.vertices[v]);
    return i;
}

void Piece::load(const CollapseMesh& mesh, const Pieces& pieces, std::uint32_t number) {
    const std::span<const std::uint32_t> faces = pieces.faces[number];
    global_face_.assign(faces.begin(), faces.end());
    global_vertex_.clear();
    local_.vertices.clear();
    // At most three vertices a face, usually one for two faces.
    slots_.assign(std::bit_ceil(4 * faces.size() + 1), none);
    local_.faces.resize(faces.size());
    local_.next_corner.resize(3 * faces.size());
    for (std::size_t i = 0; i < faces.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) local_.faces[i][k] = local_vertex(mesh, mesh.faces[faces[i]][k]);
    }
    local_.face_count = faces.size();
    local_.first_corner.assign(local_.vertices.size(), none);
    stamps_.assign(local_.vertices.size(), 0);
    for (std::size_t v = 0; v < local_.vertices.size(); ++v) {
        local_.vertices[v].valence = 0;
        if (pieces.owner[global_vertex_[v]] != number) local_.vertices[v].flags |= vertex_frozen;
    }
    for (std::size_t i = faces.size(); i-- > 0;) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t v = local_.faces[i][k];
            local_.next_corner[3 * i + k] = local_.first_corner[v];
            local_.first_corner[v] = static_cast<std::uint32_t>(3 * i + k);
            ++local_.vertices[v].valence;
        }
    }
    max_error_ = 0;
}

bool Piece::may_collapse(std::uint32_t v, std::uint32_t w) const {
    const Vertex &a = local_.vertices[v], &b = local_.vertices[w];
    return ((a.flags | b.flags) & vertex_frozen) == 0 && (a.flags & b.flags & vertex_locked) == 0 &&
           a.valence <= max_valence && b.valence <= max_valence;
}

void Piece::rate_all() {
    const std::size_t blocks = (local_.faces.size() + rating_grain - 1) / rating_grain;
    if (rated_.size() < blocks) rated_.resize(blocks);
    for (auto& part : rated_) part.clear();
    runtime::parallel_blocks(local_.faces.size(), rating_grain, [&](std::size_t begin, std::size_t end) {
        std::vector<RatedEdge>& edges = rated_[begin / rating_grain];
        for (std::size_t i = begin; i < end; ++i) {
            const Face& f = local_.faces[i];
            if (f[0] == none) continue;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t v = f[k], w = f[k == 2 ? 0 : k + 1];
                // An edge of two faces is met once in either direction.
                const bool twice = (local_.vertices[v].flags & local_.vertices[w].flags & vertex_irregular) == 0;
                if ((!twice || v < w) && may_collapse(v, w)) edges.push_back({v, w, 0});
            }
        }
        rate_edges(local_, edges);
    });
}

float Piece::cost_of_rank(std::size_t k) {
    rate_all();
    std::vector<float> usable;
    for (const auto& part : rated_) {
        for (const RatedEdge& edge : part) usable.push_back(edge.cost);
    }
    if (k >= usable.size()) return std::numeric_limits<float>::max();
    const auto nth = usable.begin() + static_cast<std::ptrdiff_t>(k);
    std::nth_element(usable.begin(), nth, usable.end());
    return *nth;
}

void Piece::rate_around(std::uint32_t v, float largest_cost) {
    const bool regular = (local_.vertices[v].flags & vertex_irregular) == 0;
    around_.clear();
    const auto add = [&](std::uint32_t w) {
        if (may_collapse(v, w)) around_.push_back({v, w, 0});
    };
    for (std::uint32_t c = local_.first_corner[v]; c != none; c = local_.next_corner[c]) {
        const std::uint32_t f = corner_face(c), k = c - 3 * f;
        const Face& face = local_.faces[f];
        add(face[k == 2 ? 0 : k + 1]);
        if (!regular) add(face[k == 0 ? 2 : k - 1]);
    }
    rate_edges(local_, around_);
    for (const RatedEdge& edge : around_) enqueue(edge, largest_cost);
}

void Piece::enqueue(const RatedEdge& edge, float largest_cost) {
    if (edge.cost <= largest_cost) queue_.push(edge.cost, {edge.v, edge.w, stamp(edge.v, edge.w)});
}

std::size_t Piece::collapse(const PieceLimits& limits, const std::function<bool()>& stopped) {
    rate_all();
    queue_.clear();
    for (const auto& part : rated_) {
        for (const RatedEdge& edge : part) enqueue(edge, limits.largest_cost);
    }
    std::size_t collapses = 0;
    QueuedEdge edge;
    for (std::size_t taken = 0; local_.face_count > limits.fewest_faces && queue_.pop(edge); ++taken) {
        if (taken % poll_interval == 0 && stopped()) break;
        if (stamp(edge.v, edge.w) != edge.stamp || local_.dead_vertex(edge.v) || local_.dead_vertex(edge.w)) continue;
        const Placement placement = place_collapsed(local_, edge.v, edge.w);
        const std::size_t removed = try_collapse(local_, edge.v, edge.w, placement, limits.keep_shape);
        if (removed == 0) continue;
        ++collapses;
        if (placement.area > 0) max_error_ = std::max(max_error_, std::sqrt(placement.quadric_error / placement.area));
        ++stamps_[edge.v];
        rate_around(edge.v, limits.largest_cost);
    }
    return collapses;
}

void Piece::store(CollapseMesh& mesh, std::vector<std::uint32_t>& alive) const {
    for (std::size_t i = 0; i < global_face_.size(); ++i) {
        Face f = local_.faces[i];
        if (f[0] == none) {
            f[1] = global_face_[f[1]];
        } else {
            for (std::uint32_t& v : f) v = global_vertex_[v];
            alive.push_back(global_face_[i]);
        }
        mesh.faces[global_face_[i]] = f;
    }
    for (std::size_t v = 0; v < global_vertex_.size(); ++v) {
        if ((local_.vertices[v].flags & vertex_frozen) == 0) mesh.vertices[global_vertex_[v]] = local_.vertices[v];
    }
}

}  // namespace quadseg::simplify
