#include "flow/freeform.h"

#include "flow/curvature_patches.h"
#include "flow/faceted.h"
#include "flow/fast.h"
#include "flow/rulings.h"
#include "mesh/connected.h"

#include <algorithm>
#include <cmath>

namespace quadseg::flow {

namespace {

/// A crease is a border that the designer meant.
constexpr double crease_degrees = 30;
/// By energy, patches are grouped with a wide misfit: few and stable ones (PROTOTYPE_TRUTH.md 1.14: τ = .03).
constexpr double freeform_misfit_angle = 14;
/// Facets hide a simple surface: theirs is the narrower one of subdivided CAD tessellations (mean IoU .920 → .939).
constexpr double facets_misfit_angle = 8;
/// Curvature counts as known where at most this share of the edges shows a jump that could be a border: on CAD meshes
/// 1 to 19 %, on organic and simplified ones 21 to 40 %.
constexpr double most_jumps = 0.2;
/// Nor is it known along slivers, whose discs reach far one way and nowhere the other.
constexpr double most_slivers = 0.3;
/// A small smooth part has too few edges to tell by itself: so many edges of all the others speak along.
constexpr double prior_edges = 200;

struct Evidence {
    double edges = 0, large = 0;
    double faces = 0, slivers = 0;
};

/// Longer than three times its height.
bool is_sliver(const mesh::WorkMesh& mesh, std::uint32_t f) {
    double longest = 0;
    for (int k = 0; k < 3; ++k)
        longest = std::max(longest, squared_norm(mesh.corner(f, (k + 1) % 3) - mesh.corner(f, k)));
    return longest > 3 * 2 * mesh.areas[f];
}

/// Faces of smooth parts whose curvature is known.
std::vector<std::uint8_t> find_regular(const mesh::WorkMesh& mesh, const mesh::FeatureEdges& creases,
                                       const CurvatureField& field, double large, const runtime::RunControl& control) {
    std::vector<std::int32_t> part;
    const std::size_t parts = mesh::connected_faces(
        mesh, [&](std::size_t f) { return field.slot[f] >= 0; },
        [&](std::size_t f, std::size_t k, std::size_t) { return (creases[f] >> k & 1) == 0; }, [&] { control.check(); },
        part);
    std::vector<Evidence> evidence(parts);
    Evidence all;
    std::size_t polls = 0;
    for (const std::uint32_t f : field.face) {
        control.check_often(polls);
        Evidence& here = evidence[static_cast<std::size_t>(part[f])];
        here.faces += 1;
        here.slivers += is_sliver(mesh, f) ? 1 : 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::int32_t g = mesh.neighbors[f][k];
            if (g <= static_cast<std::int32_t>(f) || part[static_cast<std::size_t>(g)] != part[f]) continue;
            if ((creases[f] >> k & 1) != 0) continue;
            const double is_large = curvature_jump(field, mesh, f, k).relative > large ? 1 : 0;
            here.edges += 1;
            here.large += is_large;
            all.edges += 1;
            all.large += is_large;
        }
    }
    const double overall = all.edges > 0 ? all.large / all.edges : 0;
    std::vector<std::uint8_t> regular(mesh.face_count(), 0);
    for (const std::uint32_t f : field.face) {
        const Evidence& here = evidence[static_cast<std::size_t>(part[f])];
        const double share = (here.large + prior_edges * overall) / (here.edges + prior_edges);
        regular[f] = share <= most_jumps && here.slivers <= most_slivers * here.faces ? 1 : 0;
    }
    return regular;
}

std::vector<std::uint8_t> faces_where(std::size_t count, const auto& wanted) {
    std::vector<std::uint8_t> faces(count);
    for (std::size_t f = 0; f < count; ++f) faces[f] = wanted(f) ? 1 : 0;
    return faces;
}

/// Labels that are −1 so far.
void add_regions(const partition::Labels& more, FlowResult& result) {
    const auto first = static_cast<std::int32_t>(result.regions);
    for (std::size_t f = 0; f < more.size(); ++f) {
        if (more[f] < 0) continue;
        result.labels[f] = first + more[f];
        result.regions = std::max(result.regions, static_cast<std::size_t>(result.labels[f]) + 1);
    }
}

void group_by_energy(const FlowInput& input, const mesh::FeatureEdges& creases, const std::vector<std::uint8_t>& wanted,
                     double misfit_angle, FlowResult& result) {
    if (std::find(wanted.begin(), wanted.end(), 1) == wanted.end()) return;
    FastOptions options = fast_options(input.options);
    options.misfit_angle = misfit_angle;
    options.active = wanted;
    FlowResult grouped = run_fast({input.mesh, &creases, input.options, input.control}, options);
    add_regions(grouped.labels, result);
    result.stop = grouped.stop;
    result.partial = grouped.partial;
    if (result.history.empty()) result.history = std::move(grouped.history);
}

/// What a stop left without a group: connected parts.
void label_ungrouped(const mesh::WorkMesh& mesh, const mesh::FeatureEdges& creases, const partition::Labels& explained,
                     FlowResult& result) {
    if (!result.partial) return;
    const std::vector<std::uint8_t> left =
        faces_where(explained.size(), [&](std::size_t f) { return explained[f] < 0 && result.labels[f] < 0; });
    partition::Labels parts;
    mesh::connected_faces(
        mesh, [&](std::size_t f) { return left[f] != 0; },
        [&](std::size_t f, std::size_t k, std::size_t) { return (creases[f] >> k & 1) == 0; }, [] {}, parts);
    add_regions(parts, result);
    result.faceted.resize(result.regions, 0);
}

/// find_faceted() where there are no rulings: rows of an extruded profile are flat as well.
std::vector<std::uint8_t> faceted_beside(const Rulings& rulings, const FlowInput& input, std::vector<Surface> surfaces,
                                         partition::Labels& explained) {
    const auto ruled = static_cast<std::int32_t>(surfaces.size());
    Surface freeform;
    freeform.type = SurfaceType::freeform;
    surfaces.push_back(freeform);
    for (std::size_t f = 0; f < explained.size(); ++f) {
        if (rulings.ruled[f] != 0) explained[f] = ruled;
    }
    std::vector<std::uint8_t> faceted = find_faceted(input, rulings.borders, surfaces, explained);
    for (std::size_t f = 0; f < explained.size(); ++f) {
        if (rulings.ruled[f] == 0) continue;
        explained[f] = -1;
        faceted[f] = 0;
    }
    return faceted;
}

}  // namespace

FlowResult group_freeform(const FlowInput& input, const std::vector<Surface>& surfaces, partition::Labels& explained) {
    const mesh::WorkMesh& mesh = input.mesh;
    PatchRules rules;
    rules.jump /= std::sqrt(input.options.detail);
    const Rulings rulings = find_rulings(
        mesh, input.features ? *input.features : mesh::find_feature_edges(mesh, crease_degrees, input.control),
        faces_where(explained.size(), [&](std::size_t f) { return explained[f] < 0; }), input.control);
    const mesh::FeatureEdges& creases = rulings.borders;
    FlowResult result;
    result.regions = mesh::connected_faces(
        mesh, [&](std::size_t f) { return rulings.ruled[f] != 0; },
        [&](std::size_t f, std::size_t k, std::size_t) { return (creases[f] >> k & 1) == 0; },
        [&] { input.control.check(); }, result.labels);
    const std::vector<std::uint8_t> faceted = faceted_beside(rulings, input, surfaces, explained);
    {
        const std::vector<std::uint8_t> free = faces_where(explained.size(), [&](std::size_t f) {
            return explained[f] < 0 && result.labels[f] < 0 && faceted[f] == 0;
        });
        const CurvatureField field = estimate_curvatures(mesh, free, creases, input.control);
        const std::vector<std::uint8_t> regular = find_regular(mesh, creases, field, rules.jump, input.control);
        add_regions(curvature_patches(mesh, creases, field, regular, rules, input.control), result);
    }
    result.faceted.assign(result.regions, 0);
    for (const bool in_facets : {true, false}) {
        const std::vector<std::uint8_t> wanted = faces_where(explained.size(), [&](std::size_t f) {
            return explained[f] < 0 && result.labels[f] < 0 && (faceted[f] != 0) == in_facets;
        });
        group_by_energy(input, creases, wanted, in_facets ? facets_misfit_angle : freeform_misfit_angle, result);
        result.faceted.resize(result.regions, in_facets ? 1 : 0);
        if (result.partial) break;
    }
    label_ungrouped(mesh, creases, explained, result);
    return result;
}

}  // namespace quadseg::flow
