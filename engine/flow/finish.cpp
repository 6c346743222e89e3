#include "flow/finish.h"

#include "flow/final_surfaces.h"
#include "flow/polygons.h"
#include "flow/project.h"
#include "flow/quality.h"
#include "flow/regularities_report.h"
#include "flow/rough_planes.h"
#include "flow/smooth_borders.h"
#include "partition/border_measure.h"
#include "runtime/parallel.h"
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
    result.borders_after = result.borders_before;
    if (!smooth_borders(input, flow, surfaces)) return;
    regions = partition::region_faces(flow.labels, flow.regions);
    surfaces = final_surfaces(input, regions, flow);
    result.borders_after = partition::measure_borders(input.mesh, flow.labels);
}

/// A result that lacks nothing else than this is partial too.
void project(const FlowInput& input, const std::vector<FinalSurface>& surfaces, FlowResult& flow,
             Segmentation& result) {
    try {
        result.projected = projected_positions(input, flow.labels, surfaces);
    } catch (const runtime::Stopped& stopped) {
        flow.partial = true;
        flow.stop = stopped.deadline ? StopReason::deadline : StopReason::cancelled;
    }
}

/// What the flow tells about itself, and the labels.
void hand_over(const FlowInput& input, FlowResult&& flow, double squared_distance, Segmentation& result) {
    const mesh::WorkMesh& mesh = input.mesh;
    result.energy.total = result.energy.distance + input.options.weight * result.energy.normal;
    result.rms = std::sqrt(squared_distance / std::max(mesh.total_area, 1e-300)) / mesh.frame.diagonal;
    result.stop = flow.stop;
    result.partial = flow.partial;
    result.noise = flow.noise / mesh.frame.diagonal;
    result.input = mesh.report;
    result.history = std::move(flow.history);
    result.energies = std::move(flow.energies);
    result.labels = mesh::labels_to_input(mesh, flow.labels);
    std::vector<std::size_t> faces(result.regions.size(), 0);  // regions are large, and labels in any order
    for (std::size_t f = 0; f < result.labels.size(); ++f) {
        const std::int32_t label = result.labels[f];
        if (label < 0) {
            result.unlabelled.push_back(static_cast<std::uint32_t>(f));
        } else {
            ++faces[static_cast<std::size_t>(label)];  // duplicates and degenerate faces count too
        }
    }
    for (std::size_t r = 0; r < faces.size(); ++r) result.regions[r].faces = faces[r];
}

/// Of a flow that was stopped among its leaves, perhaps a face in twenty: planes, and figures from a few faces.
Segmentation finish_with_planes(const FlowInput& input, FlowResult&& flow) {
    const mesh::UnitFrame& frame = input.mesh.frame;
    Segmentation result;
    const std::vector<RoughPlane> planes = rough_planes(input.mesh, flow.labels, flow.regions);
    result.regions.resize(flow.regions);
    runtime::parallel_for(flow.regions, 256, [&](std::size_t r) {
        const RoughPlane& plane = planes[r];
        Region& region = result.regions[r];
        region.id = region.surface_id = static_cast<std::int32_t>(r);
        region.surface.axis = to_array(plane.normal);
        region.surface.point = to_array(frame.to_input(plane.point));
        region.surface.coefficients = surface::to_coefficients(region.surface);
        region.area = plane.area / (frame.scale * frame.scale);
        region.rms = std::sqrt(plane.squared_distance / std::max(plane.area, 1e-300)) / frame.diagonal;
        region.max = plane.max_distance / frame.diagonal;
        region.energy = plane.distance_energy + input.options.weight * plane.normal_energy;
        region.valid = plane.agrees;
    });
    double squared = 0;
    for (std::size_t r = 0; r < flow.regions; ++r) {
        result.energy.distance += planes[r].distance_energy;
        result.energy.normal += planes[r].normal_energy;
        squared += planes[r].squared_distance;
        result.max = std::max(result.max, result.regions[r].max);
    }
    flow.partial = true;
    hand_over(input, std::move(flow), squared, result);
    return result;
}

}  // namespace

Segmentation finish(const FlowInput& input, FlowResult&& flow) {
    const mesh::WorkMesh& mesh = input.mesh;
    const Options& options = input.options;
    Segmentation result;
    unify_polygons(mesh, flow);
    if (flow.surfaces.empty() && flow.regions > most_rough_fits && input.control.should_stop())
        return finish_with_planes(input, std::move(flow));
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
    if (options.project && whole) project(input, surfaces, flow, result);
    hand_over(input, std::move(flow), squared, result);
    return result;
}

}  // namespace quadseg::flow
