#include "exact/join.h"

#include "exact/face_fit.h"
#include "exact/hypothesis.h"
#include "exact/search.h"

#include <algorithm>
#include <numbers>
#include <set>

namespace quadseg::exact {

namespace {

constexpr double largest_fold = 62 * std::numbers::pi / 180;
constexpr double coarse_crease = 52;
constexpr std::size_t largest_piece = 200;

/// Free pieces beside piece i over folds that a coarse surface may have, ascending.
std::vector<std::int32_t> neighbours_of(const Scene& scene, const std::vector<std::uint32_t>& faces,
                                        const std::vector<std::int32_t>& piece_of) {
    std::set<std::int32_t> found;
    for (const std::uint32_t f : faces) {
        for (const std::int32_t g : scene.mesh.neighbors[f]) {
            if (g < 0) continue;
            const std::int32_t other = piece_of[static_cast<std::size_t>(g)];
            if (other < 0 || other == piece_of[f]) continue;
            if (dihedral(scene.mesh, f, static_cast<std::size_t>(g)) <= largest_fold) found.insert(other);
        }
    }
    return {found.begin(), found.end()};
}

/// Two rims lie on a sphere and on many tori, whatever is between them: a vertex inside tells.
bool has_inner_vertex(const Scene& scene, const Candidate& candidate) {
    std::vector<std::uint32_t> rim;
    for (const std::uint32_t f : candidate.faces) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::int32_t g = scene.mesh.neighbors[f][k];
            const bool inside = g >= 0 && std::binary_search(candidate.faces.begin(), candidate.faces.end(),
                                                             static_cast<std::uint32_t>(g));
            if (inside) continue;
            rim.push_back(scene.mesh.faces[f][k]);
            rim.push_back(scene.mesh.faces[f][(k + 1) % 3]);
        }
    }
    std::sort(rim.begin(), rim.end());
    return std::any_of(candidate.faces.begin(), candidate.faces.end(), [&](std::uint32_t f) {
        return std::any_of(scene.mesh.faces[f].begin(), scene.mesh.faces[f].end(),
                           [&](std::uint32_t v) { return !std::binary_search(rim.begin(), rim.end(), v); });
    });
}

/// Gives a candidate its faces if nearly all of them are free and it holds to the last digit.
bool claim(const Scene& scene, const Candidate& candidate, Explained& state) {
    if (candidate.surface.type == SurfaceType::plane || !at_precision(scene, candidate)) return false;
    const bool needs_inside =
        candidate.surface.type == SurfaceType::sphere || candidate.surface.type == SurfaceType::torus;
    if (needs_inside && !has_inner_vertex(scene, candidate)) return false;
    std::vector<std::uint32_t> free;
    for (const std::uint32_t f : candidate.faces) {
        if (state.region[f] < 0) free.push_back(f);
    }
    if (10 * free.size() < 9 * candidate.faces.size()) return false;
    const std::int32_t region = state.add(candidate.surface);
    for (const std::uint32_t f : free) state.region[f] = region;
    return true;
}

}  // namespace

void search_coarse_pieces(const Scene& scene, Explained& state) {
    std::vector<std::uint8_t> covered(scene.mesh.face_count(), 1);
    bool any = false;
    for (const std::vector<std::uint32_t>& piece : free_components(scene, state, false)) {
        if (piece.size() > largest_piece) continue;
        for (const std::uint32_t f : piece) covered[f] = 0;
        any = true;
    }
    if (!any) return;
    const Scene coarse = with_creases(scene, coarse_crease);
    std::vector<Candidate> candidates = search_surfaces(coarse, {}, covered);
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.faces.size() > b.faces.size(); });
    for (const Candidate& candidate : candidates) claim(scene, candidate, state);
    separate_parts(scene, state);
}

void join_free_pieces(const Scene& scene, Explained& state) {
    const std::vector<std::vector<std::uint32_t>> pieces = free_components(scene, state, true);
    if (pieces.empty()) return;
    std::vector<std::int32_t> piece_of(scene.mesh.face_count(), -1);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        if (pieces[i].size() > largest_piece) continue;
        for (const std::uint32_t f : pieces[i]) piece_of[f] = static_cast<std::int32_t>(i);
    }
    Marks marks;
    marks.prepare(scene.mesh.face_count(), scene.mesh.vertex_count());
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        scene.control.check();
        if (piece_of[pieces[i].front()] < 0) continue;
        for (const std::int32_t j : neighbours_of(scene, pieces[i], piece_of)) {
            const std::vector<std::uint32_t>& other = pieces[static_cast<std::size_t>(j)];
            if (piece_of[other.front()] < 0) continue;
            std::vector<std::uint32_t> both = pieces[i];
            both.insert(both.end(), other.begin(), other.end());
            const std::optional<Surface> surface = explain(scene, both, scene.tolerances.fit, true, marks);
            if (!surface || surface->type == SurfaceType::plane) continue;
            const Candidate grown = grow(scene, *surface, both, largest_facet_turn, marks);
            if (grown.faces.size() * 10 < both.size() * 9 || !claim(scene, grown, state)) continue;
            for (const std::uint32_t f : grown.faces) piece_of[f] = -1;
            break;
        }
    }
    separate_parts(scene, state);
}

}  // namespace quadseg::exact
