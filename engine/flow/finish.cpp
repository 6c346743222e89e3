#include "flow/finish.h"

#include "flow/quality.h"
#include "surface/surface.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace quadseg::flow {

namespace {

/// Triangles of one polygon of the file share the label that covers most of its area (the smaller label on a tie).
void unify_polygons(const mesh::WorkMesh& mesh, FlowResult& flow) {
    if (mesh.polygon.empty()) return;
    std::vector<std::vector<std::uint32_t>> members;
    std::map<std::int32_t, std::size_t> slot;
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        const auto [entry, fresh] = slot.emplace(mesh.polygon[f], members.size());
        if (fresh) members.emplace_back();
        members[entry->second].push_back(static_cast<std::uint32_t>(f));
    }
    bool changed = false;
    for (const auto& faces : members) {
        std::map<std::int32_t, double> area;
        for (const std::uint32_t f : faces) area[flow.labels[f]] += mesh.areas[f];
        if (area.size() < 2) continue;
        const auto best = std::max_element(area.begin(), area.end(),
                                           [](const auto& a, const auto& b) { return a.second < b.second; });
        for (const std::uint32_t f : faces) flow.labels[f] = best->first;
        changed = true;
    }
    if (!changed) return;
    partition::split_disconnected(mesh, flow.labels);
    flow.surfaces.clear();
    flow.regions = partition::compact(flow.labels);
}

/// Coefficients of a proxy of the unit frame in the input's coordinates, mean gradient 1.
Quadric input_coefficients(const mesh::UnitFrame& frame, const quadric::Proxy& proxy) {
    Quadric c = quadric::from_local(proxy.c, frame.centre + proxy.origin / frame.scale, frame.scale);
    for (double& x : c) x /= frame.scale;
    return c;
}

Surface surface_of_proxy(const quadric::Proxy& proxy, const quadric::Coefficients& unit, const Vec3& near,
                         double radius) {
    Surface s = surface::classify(unit, near, radius);
    s.coefficients = unit;
    (void)proxy;
    return s;
}

}  // namespace

Segmentation finish(const FlowInput& input, FlowResult&& flow) {
    const mesh::WorkMesh& mesh = input.mesh;
    unify_polygons(mesh, flow);
    const partition::RegionFaces regions = partition::region_faces(flow.labels, flow.regions);
    quadric::RegionFitOptions fit_options;
    fit_options.weight = input.options.weight;
    const runtime::RunControl unstoppable(nullptr);
    const auto fits = partition::fit_regions(mesh, regions, fit_options, unstoppable);

    std::vector<Surface> surfaces(flow.regions);
    for (std::size_t r = 0; r < flow.regions; ++r) {
        const quadric::Proxy& proxy = fits[r].proxy;
        const quadric::Coefficients unit = quadric::from_local(proxy.c, proxy.origin, 1);
        if (r < flow.surfaces.size() && flow.surfaces[r].type != SurfaceType::freeform) {
            surfaces[r] = flow.surfaces[r];
        } else {
            surfaces[r] = surface_of_proxy(proxy, unit, proxy.origin, 1);
        }
        if (surfaces[r].type == SurfaceType::torus) surfaces[r].coefficients = unit;
    }
    const auto quality = measure_quality(mesh, regions, surfaces);

    Segmentation result;
    const double diagonal = mesh.frame.diagonal;
    double squared = 0;
    for (std::size_t r = 0; r < flow.regions; ++r) {
        Region region;
        region.id = static_cast<std::int32_t>(r);
        region.surface = surface::transformed_back(surfaces[r], mesh.frame.centre, mesh.frame.scale);
        if (r >= flow.surfaces.size() || flow.surfaces[r].type == SurfaceType::freeform) {
            region.surface.coefficients = input_coefficients(mesh.frame, fits[r].proxy);
        }
        region.faces = regions.size(r);
        region.area = quality[r].area / (mesh.frame.scale * mesh.frame.scale);
        region.rms = std::sqrt(quality[r].squared_distance / std::max(quality[r].area, 1e-300)) / diagonal;
        region.max = quality[r].max_distance / diagonal;
        region.energy = fits[r].total;
        region.surface_id = region.id;
        region.valid = fits[r].valid;
        result.energy.distance += fits[r].energy.distance;
        result.energy.normal += fits[r].energy.normal;
        squared += quality[r].squared_distance;
        result.max = std::max(result.max, region.max);
        result.regions.push_back(region);
    }
    result.energy.total = result.energy.distance + input.options.weight * result.energy.normal;
    result.rms = std::sqrt(squared / std::max(mesh.total_area, 1e-300)) / diagonal;
    result.stop = flow.stop;
    result.partial = flow.partial;
    result.noise = flow.noise / diagonal;
    result.input = mesh.report;
    result.history = std::move(flow.history);
    result.energies = std::move(flow.energies);
    result.labels = mesh::labels_to_input(mesh, flow.labels);
    for (std::size_t f = 0; f < result.labels.size(); ++f) {
        if (result.labels[f] < 0) result.unlabelled.push_back(static_cast<std::uint32_t>(f));
    }
    return result;
}

}  // namespace quadseg::flow
