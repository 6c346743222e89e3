// Half-edges are gathered in chains, one for the larger vertex of each edge; the few half-edges of a chain are sorted
// by the other vertex and matched. Vertices are numbered by first use, so the chains are as local as the faces, and the
// hub of a fan, used early, is the smaller vertex of its spokes: its chain stays short.
#include "mesh/build.h"
#include "runtime/parallel.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <memory>
#include <utility>

namespace quadseg::mesh::build {

namespace {

constexpr std::uint32_t end_of_chain = std::numeric_limits<std::uint32_t>::max();

struct HalfEdge {
    std::uint32_t other;  ///< smaller vertex
    std::uint32_t id;     ///< 3 · face + edge
};

class Chains {
  public:
    Chains(const WorkMesh& mesh, const runtime::RunControl& control)
        : head_(mesh.vertex_count(), end_of_chain),
          next_(std::make_unique_for_overwrite<std::uint32_t[]>(3 * mesh.face_count())) {
        const bool alone = runtime::arena_threads() <= 1;
        runtime::parallel_blocks(mesh.face_count(), block, [&](std::size_t begin, std::size_t end) {
            control.check();
            for (std::size_t f = begin; f < end; ++f) {
                const auto& v = mesh.faces[f];
                for (std::size_t k = 0; k < 3; ++k) {
                    const std::uint32_t id = static_cast<std::uint32_t>(3 * f + k);
                    std::uint32_t& head = head_[std::max(v[k], v[(k + 1) % 3])];
                    if (alone) {
                        next_[id] = head;
                        head = id;
                    } else {
                        next_[id] = std::atomic_ref<std::uint32_t>(head).exchange(id, std::memory_order_relaxed);
                    }
                }
            }
        });
    }

    /// Half-edges whose larger vertex is v, by smaller vertex, then id.
    void collect(const WorkMesh& mesh, std::size_t v, std::vector<HalfEdge>& out) const {
        out.clear();
        for (std::uint32_t id = head_[v]; id != end_of_chain; id = next_[id]) {
            const auto& t = mesh.faces[id / 3];
            const std::uint32_t k = id % 3;
            out.push_back({std::min(t[k], t[(k + 1) % 3]), id});
        }
        const auto less = [](const HalfEdge& a, const HalfEdge& b) {
            return a.other != b.other ? a.other < b.other : a.id < b.id;
        };
        if (out.size() > 24) {
            std::sort(out.begin(), out.end(), less);
            return;
        }
        for (std::size_t i = 1; i < out.size(); ++i) {
            const HalfEdge e = out[i];
            std::size_t j = i;
            for (; j > 0 && less(e, out[j - 1]); --j) out[j] = out[j - 1];
            out[j] = e;
        }
    }

  private:
    std::vector<std::uint32_t> head_;
    std::unique_ptr<std::uint32_t[]> next_;  // not a vector: all threads touch it first
};

void match_group(WorkMesh& mesh, const HalfEdge* group, std::size_t size, EdgeCounts& counts) {
    const auto slot = [&](std::uint32_t id) -> std::int32_t& { return mesh.neighbors[id / 3][id % 3]; };
    if (size == 2) {
        const std::uint32_t a = group[0].id, b = group[1].id;
        slot(a) = static_cast<std::int32_t>(b / 3);
        slot(b) = static_cast<std::int32_t>(a / 3);
        const bool same = mesh.faces[a / 3][a % 3] == mesh.faces[b / 3][b % 3];
        counts.same_direction += same ? 1 : 0;
        return;
    }
    for (std::size_t i = 0; i < size; ++i) slot(group[i].id) = no_face;
    if (size == 1) {
        ++counts.border;
    } else {
        ++counts.non_manifold;
    }
}

EdgeCounts join(EdgeCounts a, const EdgeCounts& b) noexcept {
    a.border += b.border;
    a.non_manifold += b.non_manifold;
    a.same_direction += b.same_direction;
    return a;
}

}  // namespace

EdgeCounts match_edges(WorkMesh& mesh, const runtime::RunControl& control) {
    mesh.neighbors.resize(mesh.face_count());
    const Chains chains(mesh, control);
    return runtime::reduce_blocks(
        mesh.vertex_count(), block / 2, EdgeCounts{},
        [&](std::size_t begin, std::size_t end) {
            control.check();
            EdgeCounts local;
            std::vector<HalfEdge> chain;
            for (std::size_t v = begin; v < end; ++v) {
                chains.collect(mesh, v, chain);
                for (std::size_t i = 0, j = 0; i < chain.size(); i = j) {
                    while (j < chain.size() && chain[j].other == chain[i].other) ++j;
                    match_group(mesh, &chain[i], j - i, local);
                }
            }
            return local;
        },
        join);
}

std::size_t count_non_manifold_vertices(const WorkMesh& mesh, const runtime::RunControl& control) {
    const auto corner_of = [&](std::size_t f, std::uint32_t v) -> std::size_t {
        const auto& t = mesh.faces[f];
        return t[0] == v ? 0 : t[1] == v ? 1 : 2;
    };
    // The fan of a corner: round the vertex in both directions until a border or the start. Faces need not agree in
    // orientation yet, so a face is left by the edge at the vertex that it was not entered by.
    const auto fan_size = [&](std::size_t start, std::size_t k) {
        const std::uint32_t v = mesh.faces[start][k];
        std::size_t size = 1;
        for (const std::size_t first_edge : {k, (k + 2) % 3}) {
            std::size_t f = start, edge = first_edge;
            while (mesh.neighbors[f][edge] != no_face) {
                const auto next = static_cast<std::size_t>(mesh.neighbors[f][edge]);
                if (next == start) return size;
                const std::size_t corner = corner_of(next, v);
                edge = mesh.neighbors[next][corner] == static_cast<std::int32_t>(f) ? (corner + 2) % 3 : corner;
                f = next;
                ++size;
            }
        }
        return size;
    };
    // The first corner of each vertex: vertices are numbered by first use, so it is where a new number appears. The
    // first new one of a block of faces follows the largest before it.
    std::vector<std::uint32_t> first(mesh.vertex_count());
    std::vector<std::uint32_t> seen((mesh.face_count() + block - 1) / block, 0);
    runtime::parallel_blocks(mesh.face_count(), block, [&](std::size_t begin, std::size_t end) {
        control.check();
        std::uint32_t& after = seen[begin / block];
        for (std::size_t f = begin; f < end; ++f)
            for (const std::uint32_t v : mesh.faces[f]) after = std::max(after, v + 1);
    });
    for (std::uint32_t before = 0; std::uint32_t & after : seen)
        before = std::max(before, std::exchange(after, before));
    runtime::parallel_blocks(mesh.face_count(), block, [&](std::size_t begin, std::size_t end) {
        std::uint32_t next = seen[begin / block];
        for (std::size_t f = begin; f < end; ++f) {
            for (std::size_t k = 0; k < 3; ++k) {
                if (mesh.faces[f][k] == next) first[next++] = static_cast<std::uint32_t>(3 * f + k);
            }
        }
    });
    control.check();
    std::vector<std::uint32_t> fan(mesh.vertex_count());
    const std::size_t corners = runtime::reduce_blocks(
        mesh.vertex_count(), block, std::size_t{0},
        [&](std::size_t begin, std::size_t end) {
            control.check();
            std::size_t sum = 0;
            for (std::size_t v = begin; v < end; ++v) {
                fan[v] = static_cast<std::uint32_t>(fan_size(first[v] / 3, first[v] % 3));
                sum += fan[v];
            }
            return sum;
        },
        [](std::size_t a, std::size_t b) { return a + b; });
    if (corners == 3 * mesh.face_count()) return 0;  // the first fan of every vertex has all its corners
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        if (f % block == 0) control.check();
        for (const std::uint32_t v : mesh.faces[f]) --fan[v];  // wraps round where there are more corners
    }
    return fan.size() - static_cast<std::size_t>(std::count(fan.begin(), fan.end(), 0U));
}

}  // namespace quadseg::mesh::build
