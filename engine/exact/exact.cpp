#include "exact/exact.h"

#include "exact/bands.h"
#include "exact/complete.h"
#include "exact/explained.h"
#include "exact/face_fit.h"
#include "exact/found_so_far.h"
#include "exact/grow.h"
#include "exact/join.h"
#include "exact/release.h"
#include "exact/scene.h"
#include "exact/search.h"
#include "exact/second_opinion.h"
#include "exact/select.h"
#include "exact/unite.h"
#include "runtime/parallel.h"
#include "runtime/per_thread.h"

#include <algorithm>
#include <numeric>

namespace quadseg::exact {

namespace {

/// Turn of a facet, radians: bounds of what curved surfaces tell, and what is assumed where there are none to tell.
constexpr double least_step = 0.13, most_step = 0.9, unknown_step = 0.7;
constexpr double clearly_looser = 3;

/// Sure facets, largest first, grown to planes; a facet inside an earlier plane is none of its own.
std::vector<Candidate> plane_candidates(const Scene& scene) {
    std::vector<std::uint32_t> sure;
    for (std::size_t i = 0; i < scene.facets.count(); ++i) {
        if (scene.facets.facet[i].sure) sure.push_back(static_cast<std::uint32_t>(i));
    }
    std::vector<Candidate> candidates(sure.size());
    runtime::PerThread<Marks> marks;
    runtime::parallel_for(sure.size(), 1, [&](std::size_t i) {
        if (scene.control.should_stop()) return;
        const Facet& facet = scene.facets.facet[sure[i]];
        Surface plane;
        plane.type = SurfaceType::plane;
        plane.axis = to_array(facet.normal);
        plane.point = to_array(facet.normal * facet.offset);
        const std::span<const std::uint32_t> faces(scene.facets.face.data() + scene.facets.begin[sure[i]],
                                                   scene.facets.size(sure[i]));
        try {
            candidates[i] = grow(scene, plane, faces, largest_facet_turn, marks.local());
        } catch (const runtime::Stopped&) {
            // The planes found so far count; the caller asks the control.
        }
    });
    if (scene.control.should_stop()) std::erase_if(candidates, [](const Candidate& c) { return c.faces.empty(); });
    return candidates;
}

void mark_covered(const std::vector<std::int32_t>& owner, std::vector<std::uint8_t>& covered) {
    for (std::size_t f = 0; f < owner.size(); ++f) covered[f] = owner[f] >= 0 ? 1 : 0;
}

/// Candidates and selection are the caller's: what is left of them when this throws Stopped.
ExactSurfaces search_and_settle(const Scene& scene, std::vector<Candidate>& candidates, Selection& selection) {
    const mesh::WorkMesh& mesh = scene.mesh;
    candidates = plane_candidates(scene);
    scene.control.check();
    std::vector<std::uint8_t> covered(mesh.face_count(), 0);
    append(candidates, search_surfaces(scene, {}, covered));
    scene.control.check();
    const double learned = learn_step(candidates);
    const double step = learned > 0 ? std::clamp(learned, least_step, most_step) : unknown_step;
    split_uneven_bands(scene, candidates);
    ask_for_smaller_steps(scene, step, candidates);
    replace_loose(scene, candidates);
    selection = select(scene, candidates, step);
    mark_covered(selection.owner, covered);
    // Rounded coordinates make the first pass loose already: a second one would lay tori through free-form faces.
    if (scene.tolerances.loose_fit > clearly_looser * scene.tolerances.fit) {
        std::vector<Candidate> loose = search_surfaces(scene, {.loose = true}, covered);
        scene.control.check();
        if (!loose.empty()) {
            append(candidates, std::move(loose));
            selection = select(scene, candidates, step);
        }
    }
    mark_covered(selection.owner, covered);
    std::vector<Candidate> quadrics = search_surfaces(scene, {.quadrics = true}, covered);
    scene.control.check();
    if (!quadrics.empty()) {
        append(candidates, std::move(quadrics));
        selection = select(scene, candidates, step);
    }

    Explained state;
    state.region = selection.owner;
    for (const Candidate& candidate : candidates) state.surface.push_back(candidate.surface);
    release_extruded(scene, state);
    separate_parts(scene, state);
    add_planes(scene, step, state);
    extend_to_borders(scene, step, state);
    unite_equal(scene, step, state);
    const std::vector<std::int32_t> united = state.region;
    release_doubtful(scene, state);
    search_coarse_pieces(scene, state);
    join_free_pieces(scene, state);
    absorb_exact_crumbs(scene, state);
    extend_to_borders(scene, step, state);
    absorb_badly_trimmed(scene, step, state);
    absorb_scraps(scene, step, state);
    if (state.region != united) unite_equal(scene, step, state);
    release_crumbs(scene, selection.noise, state);

    ExactSurfaces result;
    result.labels = std::move(state.region);
    result.surfaces = std::move(state.surface);
    result.noise = selection.noise;
    result.largest_step = step;
    double covered_area = 0;
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        if (result.labels[f] >= 0) covered_area += mesh.areas[f];
    }
    result.covered = mesh.total_area > 0 ? covered_area / mesh.total_area : 0;
    return result;
}

}  // namespace

ExactSurfaces find_exact_surfaces(const mesh::WorkMesh& mesh, const runtime::RunControl& control) {
    Scene scene = build_scene(mesh, control);
    std::vector<Candidate> candidates;
    Selection selection;
    try {
        ExactSurfaces result = search_and_settle(scene, candidates, selection);
        result.tolerances = scene.tolerances;
        result.facets = std::move(scene.ground->facets);
        return result;
    } catch (const runtime::Stopped&) {
        if (candidates.empty()) throw;
        return found_so_far(mesh, candidates, std::move(selection.owner));
    }
}

}  // namespace quadseg::exact
