// A raw mesh becomes one of the set: oriented, checked, shuffled; and its noisy copies.
#include "step.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <queue>
#include <stdexcept>
#include <utility>

namespace step_truth {
namespace {

class Random {  // the same numbers on every machine
  public:
    explicit Random(std::uint64_t seed) : state_(seed) {}
    std::uint64_t next() {
        std::uint64_t z = (state_ += 0x9e3779b97f4a7c15U);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
        return z ^ (z >> 31);
    }
    double uniform() { return (static_cast<double>(next() >> 11) + 0.5) / 9007199254740992.0; }
    double gaussian() { return std::sqrt(-2 * std::log(uniform())) * std::cos(2 * std::numbers::pi * uniform()); }
    std::vector<int> permutation(std::size_t n) {
        std::vector<int> order(n);
        for (std::size_t i = 0; i < n; ++i) {
            const std::size_t j = next() % (i + 1);
            order[i] = order[j];
            order[j] = static_cast<int>(i);
        }
        return order;
    }

  private:
    std::uint64_t state_;
};

Vec3 area_vector(const Mesh& mesh, std::size_t t) {
    const auto& [a, b, c] = mesh.triangles[t];
    Vec3 n = cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]);
    for (double& x : n) x *= 0.5;
    return n;
}

using Neighbours = std::vector<std::array<int, 3>>;

Neighbours neighbours(const Mesh& mesh) {
    std::map<std::pair<int, int>, std::vector<std::pair<int, int>>> edges;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k)
            edges[std::minmax(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3])].push_back(
                {static_cast<int>(t), k});
    Neighbours result(mesh.triangles.size());
    for (const auto& [edge, sides] : edges) {
        if (sides.size() != 2) throw std::runtime_error("mesh not closed or not manifold");
        result[sides[0].first][sides[0].second] = sides[1].first;
        result[sides[1].first][sides[1].second] = sides[0].first;
    }
    return result;
}

bool has_edge(const std::array<int, 3>& t, int from, int to) {
    for (int k = 0; k < 3; ++k)
        if (t[k] == from && t[(k + 1) % 3] == to) return true;
    return false;
}

void orient_outwards(Mesh& mesh) {
    Neighbours next = neighbours(mesh);
    std::vector<bool> seen(mesh.triangles.size());
    std::queue<int> open({0});
    seen[0] = true;
    std::size_t reached = 1;
    while (!open.empty()) {
        const int t = open.front();
        open.pop();
        for (int k = 0; k < 3; ++k) {
            const int from = mesh.triangles[t][k], to = mesh.triangles[t][(k + 1) % 3], other = next[t][k];
            auto& triangle = mesh.triangles[other];
            if (!seen[other]) {
                if (has_edge(triangle, from, to)) {
                    std::swap(triangle[1], triangle[2]);  // edges 01 12 20 become 02 21 10
                    std::swap(next[other][0], next[other][2]);
                }
                seen[other] = true;
                ++reached;
                open.push(other);
            } else if (has_edge(triangle, from, to)) {
                throw std::runtime_error("mesh not orientable");
            }
        }
    }
    if (reached != mesh.triangles.size()) throw std::runtime_error("mesh not connected");
    double volume = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        volume += dot(area_vector(mesh, t), mesh.vertices[mesh.triangles[t][0]]);
    if (volume < 0)
        for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
}

// Of an oriented closed mesh: one fan of triangles around each vertex.
void check_fans(const Mesh& mesh) {
    std::vector<int> degree(mesh.vertices.size()), start(mesh.vertices.size(), -1);
    std::map<std::pair<int, int>, int> ahead;  // of the edge opposite to a vertex: (vertex, from) -> to
    for (const auto& t : mesh.triangles)
        for (int k = 0; k < 3; ++k) {
            ++degree[t[k]];
            start[t[k]] = t[(k + 1) % 3];
            ahead[{t[k], t[(k + 1) % 3]}] = t[(k + 2) % 3];
        }
    for (int v = 0; v < static_cast<int>(degree.size()); ++v) {
        if (start[v] < 0) continue;
        int steps = 0, at = start[v];
        do {
            at = ahead.at({v, at});
            ++steps;
        } while (at != start[v]);
        if (steps != degree[v]) throw std::runtime_error("mesh pinched at a vertex");
    }
}

void check_surfaces(const Solid& solid, const Mesh& mesh) {
    std::vector<int> face_of(mesh.vertices.size(), -1);  // -2 on edges, where the tolerance of the source rules
    std::vector<double> area(solid.faces.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Vec3 n = area_vector(mesh, t);
        area[mesh.face[t]] += std::sqrt(dot(n, n));
        for (const int v : mesh.triangles[t])
            face_of[v] = face_of[v] == -1 || face_of[v] == mesh.face[t] ? mesh.face[t] : -2;
    }
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        if (face_of[v] < 0) continue;
        const Face& face = solid.faces[face_of[v]];
        if (face.analytic() && distance(face, mesh.vertices[v]) > 1e-7 * solid.diagonal)
            throw std::runtime_error("a vertex is off its " + face.type);
    }
    for (std::size_t f = 0; f < area.size(); ++f)
        if (std::abs(area[f] - solid.faces[f].area) >
            0.05 * solid.faces[f].area + 1e-6 * solid.diagonal * solid.diagonal)
            throw std::runtime_error("the area of a " + solid.faces[f].type + " is wrong: " + std::to_string(area[f]) +
                                     " for " + std::to_string(solid.faces[f].area));
}

// Neighbours within a face whose normals are more than a right angle apart: the mesh is folded there.
void check_folds(const Mesh& mesh) {
    const Neighbours next = neighbours(mesh);
    std::size_t folds = 0;
    for (std::size_t t = 0; t < next.size(); ++t)
        for (const int other : next[t])
            if (mesh.face[t] == mesh.face[other] && dot(area_vector(mesh, t), area_vector(mesh, other)) < 0) ++folds;
    if (folds > 8) throw std::runtime_error("folded mesh");
}

void shuffle(Mesh& mesh, Random random) {
    Mesh mixed = mesh;
    std::vector<int> used;
    std::vector<bool> is_used(mesh.vertices.size());
    for (const auto& t : mesh.triangles)
        for (const int v : t) is_used[v] = true;
    for (std::size_t v = 0; v < is_used.size(); ++v)
        if (is_used[v]) used.push_back(static_cast<int>(v));
    const std::vector<int> vertex = random.permutation(used.size()), triangle = random.permutation(mesh.face.size());
    std::vector<int> place(mesh.vertices.size());
    mixed.vertices.resize(used.size());
    for (std::size_t i = 0; i < used.size(); ++i) {
        place[used[vertex[i]]] = static_cast<int>(i);
        mixed.vertices[i] = mesh.vertices[used[vertex[i]]];
    }
    for (std::size_t i = 0; i < triangle.size(); ++i) {
        const auto& t = mesh.triangles[triangle[i]];
        const std::size_t turn = random.next() % 3;
        for (std::size_t k = 0; k < 3; ++k) mixed.triangles[i][k] = place[t[(k + turn) % 3]];
        mixed.face[i] = mesh.face[triangle[i]];
    }
    mesh = std::move(mixed);
}

}  // namespace

void finish(const Solid& solid, Mesh& mesh, std::uint64_t seed) {
    if (mesh.triangles.empty()) throw std::runtime_error("empty mesh");
    orient_outwards(mesh);
    check_fans(mesh);
    check_surfaces(solid, mesh);
    check_folds(mesh);
    shuffle(mesh, Random(seed));
}

Mesh with_noise(const Mesh& mesh, double sigma, std::uint64_t seed) {
    std::vector<Vec3> normal(mesh.vertices.size(), Vec3{});
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Vec3 n = area_vector(mesh, t);
        for (const int v : mesh.triangles[t])
            for (int i = 0; i < 3; ++i) normal[v][i] += n[i];
    }
    Mesh noisy = mesh;
    Random random(seed);
    for (std::size_t v = 0; v < normal.size(); ++v) {
        const double shift = sigma * random.gaussian(), length = std::sqrt(dot(normal[v], normal[v]));
        for (int i = 0; i < 3; ++i) noisy.vertices[v][i] += shift * normal[v][i] / length;
    }
    return noisy;
}

}  // namespace step_truth
