#include "flow/finish.h"

#include "flow/final_surfaces.h"
#include "flow/polygons.h"
#include "flow/project.h"
#include "flow/quality.h"
#include "flow/regularities_report.h"
#include "flow/smooth_borders.h"
#include "partition/border_measure.h"
#include "surface/surface.h"

#include <algorithm>
#include <cmath>

namespace quadseg::flow {

namespace {

void scale(Quadric& c, double factor) {
    for (double& v : c) v *= factor;
}

/// In input coordinates; coefficients with a mean |∇f(c_t)| of 1 over the region.
Surface input_surface(const mesh::UnitFrame& frame, const FinalSurface& final, const RegionQuality& quality) {
    Surface s = surface::transformed_back(final.surface, frame.centre, frame.scale);
    double gradient = quality.area > 0 ? quality.gradient / quality.area : 1;
    if (s.type <= SurfaceType::cone) {
        s.coefficients = surface::to_coefficients(s);
        if (s.type == SurfaceType::cone) gradient /= frame.scale;  // a length: the distance from the apex
    } else {
        // From the region's own frame straight to the input's: nothing is lost on the way.
        s.coefficients = quadric::from_local(final.quadric.c, frame.to_input(final.quadric.origin), frame.scale);
        scale(s.coefficients, 1 / frame.scale);
    }
    if (gradient > 0 && std::isfinite(gradient)) scale(s.coefficients, 1 / gradient);
    return s;
}

Region describe_region(const mesh::WorkMesh& mesh, std::size_t r, const FinalSurface& final,
                       const RegionQuality& quality, double weight) {
    const double diagonal = mesh.frame.diagonal, area = std::max(quality.area, 1e-300);
    Region region;
    region.id = static_cast<std::int32_t>(r);
    region.surface = input_surface(mesh.frame, final, quality);
    region.area = quality.area / (mesh.frame.scale * mesh.frame.scale);
    region.rms = std::sqrt(quality.squared_distance / area) / diagonal;
    region.max = quality.max_distance / diagonal;
    region.energy = quality.energy.hybrid(weight);
    region.surface_id = region.id;
    region.valid = final.one_sheet && quality.against <= 0.01 * quality.area;
    return region;
}

/// Section 4.4.1, and the surfaces refitted after.
void smooth(const FlowInput& input, FlowResult& flow, partition::RegionFaces& regions,
            std::vector<FinalSurface>& surfaces, Segmentation& result) {
    result.borders_before = partition::measure_borders(input.mesh, flow.labels);
    if (smooth_borders(input, flow, surfaces)) {
        regions = partition::region_faces(flow.labels, flow.regions);
        surfaces = final_surfaces(input, regions, flow);
    }
    result.borders_after = partition::measure_borders(input.mesh, flow.labels);
}

}  // namespace

Segmentation finish(const FlowInput& input, FlowResult&& flow) {
    const mesh::WorkMesh& mesh = input.mesh;
    const Options& options = input.options;
    Segmentation result;
    unify_polygons(mesh, flow);
    partition::RegionFaces regions = partition::region_faces(flow.labels, flow.regions);
    std::vector<FinalSurface> surfaces = final_surfaces(input, regions, flow);
    const bool whole = !flow.partial && !input.control.should_stop();
    if (options.smooth && whole) smooth(input, flow, regions, surfaces, result);

    std::vector<std::int32_t> ids;
    if (options.regularities && options.preset == Preset::standard && whole)
        result.regularities = snap_regularities(surfaces, region_areas(mesh, regions), flow.noise);
    const std::vector<RegionQuality> quality = measure_quality(mesh, regions, surfaces, input.control);
    if (input.control.should_stop()) {
        flow.partial = true;  // surfaces and distances may be rough ones
        for (std::size_t r = 0; r < flow.regions; ++r) ids.push_back(static_cast<std::int32_t>(r));
    } else {
        ids = analytic_surface_ids(surfaces, flow.noise);
    }

    double squared = 0;
    result.regions.reserve(flow.regions);
    for (std::size_t r = 0; r < flow.regions; ++r) {
        Region region = describe_region(mesh, r, surfaces[r], quality[r], options.weight);
        region.surface_id = ids[r];
        result.energy.distance += quality[r].energy.distance;
        result.energy.normal += quality[r].energy.normal;
        squared += quality[r].squared_distance;
        result.max = std::max(result.max, region.max);
        result.regions.push_back(region);
    }
    result.energy.total = result.energy.distance + options.weight * result.energy.normal;
    result.rms = std::sqrt(squared / std::max(mesh.total_area, 1e-300)) / mesh.frame.diagonal;
    result.stop = flow.stop;
    result.partial = flow.partial;
    result.noise = flow.noise / mesh.frame.diagonal;
    result.input = mesh.report;
    result.history = std::move(flow.history);
    result.energies = std::move(flow.energies);
    result.labels = mesh::labels_to_input(mesh, flow.labels);
    for (std::size_t f = 0; f < result.labels.size(); ++f) {
        const std::int32_t label = result.labels[f];
        if (label < 0) {
            result.unlabelled.push_back(static_cast<std::uint32_t>(f));
        } else {
            ++result.regions[static_cast<std::size_t>(label)].faces;  // duplicates and degenerate faces count too
        }
    }
    if (options.project && whole) result.projected = projected_positions(input, flow.labels, surfaces);
    return result;
}

}  // namespace quadseg::flow
