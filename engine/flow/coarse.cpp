#include "flow/coarse.h"

#include <quadseg/error.h>

#include "flow/fast.h"
#include "flow/paper.h"
#include "flow/project_labels.h"
#include "flow/simplified_mesh.h"
#include "mesh/features.h"
#include "simplify/decimate.h"

#include <algorithm>
#include <chrono>
#include <numbers>
#include <optional>
#include <vector>

namespace quadseg::flow {

namespace {

constexpr std::size_t smallest_mesh_that_pays = 10000;
constexpr std::size_t smallest_coarse = 1000;
constexpr std::size_t faces_per_coarse_face = 10;
/// Simplified to more than this share there is nothing to gain.
constexpr double useful_share = 0.7;
/// A part of a projected region of this share of its main part is no fringe of jagged faces: a region of its own.
constexpr double independent_share = 0.9;
/// Of the regions brought to the fine mesh a quarter are too many: the last merges see the true energies. (Where a
/// single one would be a third of all, none: merging three surfaces' worth of four ended at twice the energy.)
constexpr std::size_t regions_per_spare = 3;
/// Teleportations on the simplified mesh, after merging; more where surfaces explain it badly (RMS angle of the
/// normals, degrees), as shapes without surfaces have many local minima. On the fine mesh, where each is as dear as
/// many of these, spare regions do as well: none.
constexpr std::size_t coarse_teleportations = 4;
constexpr double organic_angle = 6;
/// Regions on the simplified mesh before merging, for one that is wanted: 1 traps the loop in what insertion found, 2
/// takes twice as long and ends no lower.
constexpr double regions_overshoot = 1.4;
constexpr double default_crease = 30;

double crease_degrees(const Options& options, double otherwise) noexcept {
    return options.feature_angle > 0 ? options.feature_angle : otherwise;
}

/// Features of the simplified mesh: the edges where the fine mesh has features between the faces that two simplified
/// faces stand for. Found afresh they would be too many: simplified fillets and small cylinders have sharp edges. Where
/// no fine edge lies between the two, or few of them are features, the edge's own sharpness has a say.
class FeatureTransfer {
  public:
    FeatureTransfer(const FlowInput& fine, const std::vector<std::uint32_t>& face_map) {
        const mesh::WorkMesh& mesh = fine.mesh;
        for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
            for (std::uint32_t k = 0; k < 3; ++k) {
                const std::int32_t g = mesh.neighbors[f][k];
                if (g < static_cast<std::int32_t>(f)) continue;  // once an edge; no borders
                const std::uint32_t a = face_map[f], b = face_map[static_cast<std::uint32_t>(g)];
                if (a == b) continue;
                const double length =
                    norm(mesh.corner(f, static_cast<int>((k + 1) % 3)) - mesh.corner(f, static_cast<int>(k)));
                edges_.push_back({std::minmax(a, b), length, ((*fine.features)[f] >> k & 1U) != 0});
            }
        }
        std::stable_sort(edges_.begin(), edges_.end(),
                         [](const FineEdge& a, const FineEdge& b) { return a.between < b.between; });
    }

    bool is_feature(std::uint32_t a, std::uint32_t b, bool sharp) const {
        const std::pair<std::uint32_t, std::uint32_t> between = std::minmax(a, b);
        auto edge = std::lower_bound(edges_.begin(), edges_.end(), between,
                                     [](const FineEdge& e, const auto& key) { return e.between < key; });
        if (edge == edges_.end() || edge->between != between) return sharp;
        double length = 0, feature_length = 0;
        for (; edge != edges_.end() && edge->between == between; ++edge) {
            length += edge->length;
            if (edge->feature) feature_length += edge->length;
        }
        return feature_length >= 0.5 * length || (sharp && feature_length > 0);
    }

  private:
    struct FineEdge {
        std::pair<std::uint32_t, std::uint32_t> between;  ///< simplified faces, the smaller first
        double length;
        bool feature;
    };
    std::vector<FineEdge> edges_;
};

mesh::FeatureEdges transfer_features(const FlowInput& fine, const std::vector<std::uint32_t>& face_map,
                                     const mesh::WorkMesh& coarse, double degrees) {
    const FeatureTransfer transfer(fine, face_map);
    const mesh::FeatureEdges sharp = mesh::find_feature_edges(coarse, degrees, fine.control);
    mesh::FeatureEdges features(coarse.face_count(), 0);
    for (std::size_t f = 0; f < coarse.face_count(); ++f) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::int32_t g = coarse.neighbors[f][k];
            if (g == mesh::no_face) continue;
            const std::uint32_t a = coarse.input_face[f], b = coarse.input_face[static_cast<std::size_t>(g)];
            if (transfer.is_feature(a, b, (sharp[f] >> k & 1U) != 0)) {
                features[f] = static_cast<std::uint8_t>(features[f] | 1U << k);
            }
        }
    }
    return features;
}

struct CoarseResult {
    FlowResult flow;
    partition::Labels labels;  ///< of the fine mesh, connected
};

/// None: the mesh cannot be simplified.
std::optional<CoarseResult> segment_simplified(const FlowInput& input, const SimplifyFunction& simplify,
                                               const FlowFunction& flow_on_coarse) {
    const simplify::Decimated decimated = simplify(input);
    const auto fine_faces = static_cast<double>(input.mesh.face_count());
    if (decimated.faces.empty() || static_cast<double>(decimated.faces.size()) > useful_share * fine_faces) return {};

    const mesh::WorkMesh mesh = build_simplified_mesh(input.mesh, decimated.positions, decimated.faces, input.control);
    std::optional<mesh::FeatureEdges> features;
    if (input.features != nullptr) {
        features = transfer_features(input, decimated.face_map, mesh, crease_degrees(input.options, default_crease));
    }
    CoarseResult result;
    result.flow = flow_on_coarse({mesh, features ? &*features : nullptr, input.options, input.control});
    result.labels = project_labels(mesh::labels_to_input(mesh, result.flow.labels), decimated.face_map);
    return result;
}

}  // namespace

std::size_t coarse_face_count(const Options& options, std::size_t faces) {
    if (options.coarse > 0) {
        const auto wanted = static_cast<std::size_t>(options.coarse);
        return wanted < faces ? wanted : 0;
    }
    if (options.coarse == 0 || options.preset != Preset::paper || faces < smallest_mesh_that_pays) return 0;
    return std::max(smallest_coarse, faces / faces_per_coarse_face);
}

simplify::Decimated simplified(const FlowInput& input, const std::vector<Vec3>& positions, std::size_t faces,
                               double crease) {
    simplify::DecimateOptions options;
    options.target_faces = faces;
    options.feature_degrees = crease_degrees(input.options, crease);
    // Left by Stopped: what is simplified so far would be thrown away.
    options.should_stop = [&] {
        input.control.check();
        return false;
    };
    return simplify::decimate(positions, input.mesh.faces, options);
}

FlowResult run_coarse(const FlowInput& input, const SimplifyFunction& simplify, const FlowFunction& flow_on_coarse,
                      const RefineFunction& refine_on_fine) {
    const auto start = std::chrono::steady_clock::now();
    input.control.report(Phase::coarse, 0.2);
    std::optional<CoarseResult> coarse;
    try {
        coarse = segment_simplified(input, simplify, flow_on_coarse);
    } catch (const runtime::Stopped&) {
        // The flow below stops at once with what it makes of that.
    } catch (const Error& error) {
        if (error.code() != ErrorCode::empty_mesh) throw;  // nothing left with an area
    }
    if (!coarse) return flow_on_coarse(input);

    const partition::Passage passage{&input.mesh, input.features, {}};
    const runtime::RunControl bounded(nullptr);  // linear work, also for a stopped run: it owes connected labels
    const std::size_t regions = connect_labels(passage, coarse->labels, independent_share, bounded);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    FlowResult result;
    if (coarse->flow.partial) {
        result = std::move(coarse->flow);
        result.labels = std::move(coarse->labels);
        result.regions = regions;
        result.surfaces.clear();  // they belong to the coarse regions
    } else {
        result = refine_on_fine(input, coarse->labels);
        result.energies.insert(result.energies.begin(), coarse->flow.energies.begin(), coarse->flow.energies.end());
        if (result.history.empty()) result.history = std::move(coarse->flow.history);
    }
    result.coarse_seconds = seconds;
    return result;
}

namespace {

SimplifyFunction simplify_to(std::size_t faces) {
    return [faces](const FlowInput& fine) { return simplified(fine, fine.mesh.positions, faces, default_crease); };
}

int teleportations_on_coarse(const FlowInput& input, double energy) {
    const double angle = organic_angle * std::numbers::pi / 180;
    const bool organic = energy > input.options.weight * angle * angle * input.mesh.total_area;
    const std::size_t count = coarse_teleportations + (organic ? 1 + input.options.regions / 2 : 0);
    const auto most = static_cast<std::size_t>(input.options.paper.teleportations);
    return static_cast<int>(std::min(count, most));
}

FlowResult overshoot_and_merge(const FlowInput& input) {
    if (input.options.regions == 0) return run_paper(input);
    Options more = input.options;
    more.regions = static_cast<std::size_t>(regions_overshoot * static_cast<double>(input.options.regions));
    more.paper.teleportations = 0;
    FlowResult many = run_paper({input.mesh, input.features, more, input.control});
    if (many.partial) return many;
    more.regions = input.options.regions + (input.options.regions - 1) / regions_per_spare;
    more.paper.teleportations = teleportations_on_coarse(input, many.energies.empty() ? 0 : many.energies.back());
    FlowResult result = run_paper({input.mesh, input.features, more, input.control}, &many.labels);
    result.energies.insert(result.energies.begin(), many.energies.begin(), many.energies.end());
    return result;
}

}  // namespace

FlowResult run_paper_coarse(const FlowInput& input, std::size_t coarse_faces) {
    if (input.options.method == Method::hierarchical) return run_paper(input);  // merges from single faces up
    return run_coarse(input, simplify_to(coarse_faces), overshoot_and_merge,
                      [](const FlowInput& fine, const partition::Labels& labels) {
                          Options fewer = fine.options;
                          fewer.paper.teleportations = 0;
                          return run_paper({fine.mesh, fine.features, fewer, fine.control}, &labels);
                      });
}

FlowResult run_fast_coarse(const FlowInput& input, std::size_t coarse_faces) {
    const FastOptions options = fast_options(input.options);
    const auto on_coarse = [&](const FlowInput& coarse) {
        FastOptions more = options;
        if (more.regions > 0) more.regions += (more.regions - 1) / regions_per_spare;
        return run_fast(coarse, more);
    };
    const auto on_fine = [&](const FlowInput& fine, const partition::Labels& labels) {
        return refine_fast(fine, options, labels);
    };
    return run_coarse(input, simplify_to(coarse_faces), on_coarse, on_fine);
}

}  // namespace quadseg::flow
