#include "tools/cli/report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace quadseg::cli {
namespace {

/// Files of a long bottom-up run stay readable: the last steps, which matter, all; the earlier ones every so often.
constexpr std::size_t history_limit = 2000;

/// Initializer lists of Json cost several times as much.
template <class... Values>
Json list_json(Values... values) {
    Json::array_t list;
    list.reserve(sizeof...(values));
    (list.emplace_back(values), ...);
    return list;
}

Json vector_json(const std::array<double, 3>& v) {
    return list_json(v[0], v[1], v[2]);
}

/// Empty, with room: keys are constant, so that one that grows copies all that it has.
Json object_json(std::size_t fields) {
    Json json = Json::object();
    json.get_ref<Json::object_t&>().reserve(fields);
    return json;
}

Json region_json(const Region& region) {
    Json json = object_json(12);
    json["id"] = region.id;
    json["type"] = to_string(region.surface.type);
    json["faces"] = region.faces;
    json["area"] = region.area;
    json["rms"] = region.rms;
    json["max"] = region.max;
    json["energy"] = region.energy;
    json["surface_id"] = region.surface_id;
    json["valid"] = region.valid;
    json["outward"] = region.surface.outward;
    json["coefficients"] = region.surface.coefficients;
    json["parameters"] = parameters_json(region.surface);
    return json;
}

Json history_json(const std::vector<MergeStep>& history) {
    Json json = Json::array();
    const std::size_t tail = history_limit / 2;
    const std::size_t head = history.size() > history_limit ? history.size() - tail : 0;
    const std::size_t stride = head / tail + 1;
    for (std::size_t k = 0; k < history.size(); ++k) {
        if (k < head && k % stride != 0) continue;
        json.push_back(list_json(history[k].regions, history[k].energy));
    }
    return json;
}

Json regularities_json(const std::vector<Regularity>& regularities) {
    Json::array_t list;
    list.reserve(regularities.size());
    for (const Regularity& regularity : regularities) {
        Json& json = list.emplace_back(object_json(3));
        json["kind"] = to_string(regularity.kind);
        json["regions"] = regularity.regions;
        json["snapped"] = regularity.snapped;
    }
    return list;
}

Json borders_json(const BorderMeasure& measure) {
    return {{"length", measure.length}, {"zigzag", measure.zigzag}};
}

}  // namespace

Json input_json(const std::string& file, const Mesh& mesh, const MeshReport& report) {
    Json json;
    json["file"] = file;
    json["faces"] = report.faces;
    json["vertices"] = report.vertices;
    json["components"] = report.components;
    json["diagonal"] = report.diagonal;
    json["area"] = report.area;
    json["offset"] = report.offset;
    json["box_min"] = vector_json(report.box_min);
    json["box_max"] = vector_json(report.box_max);
    json["file_faces"] = mesh.file_faces;
    json["border_edges"] = report.border_edges;
    json["feature_edges"] = report.feature_edges;
    json["repairs"] = {
        {"welded_vertices", mesh.welded_vertices},         {"stitched_edges", report.stitched_edges},
        {"flipped_faces", report.flipped_faces},           {"degenerate_faces", report.degenerate_faces},
        {"duplicate_faces", report.duplicate_faces},       {"isolated_vertices", report.isolated_vertices},
        {"non_manifold_edges", report.non_manifold_edges}, {"non_manifold_vertices", report.non_manifold_vertices},
        {"unorientable_edges", report.unorientable_edges}};
    return json;
}

Json options_json(const Options& options) {
    Json json;
    json["preset"] = to_string(options.preset);
    json["method"] = to_string(options.method);
    json["regions"] = options.regions;
    json["tolerance"] = options.tolerance;
    json["detail"] = options.detail;
    json["features"] = options.feature_angle;
    json["weight"] = options.weight;
    json["seed"] = options.seed;
    json["coarse"] = options.coarse;
    json["smooth"] = options.smooth;
    json["project"] = options.project;
    json["project_joint"] = options.project_joint;
    json["regularities"] = options.regularities;
    const PaperOptions& paper = options.paper;
    json["paper"] = {{"lloyd_iterations", paper.lloyd_iterations}, {"convergence", paper.convergence},
                     {"plane_tolerance", paper.plane_tolerance},   {"merge_tolerance", paper.merge_tolerance},
                     {"initial_regions", paper.initial_regions},   {"merging", paper.merging},
                     {"teleportation", paper.teleportation},       {"teleportations", paper.teleportations},
                     {"energy_threshold", paper.energy_threshold}, {"maximum_regions", paper.maximum_regions}};
    json["smoothing"] = {{"band", options.smoothing.band}, {"lambda", options.smoothing.lambda}};
    return json;
}

Json parameters_json(const Surface& s) {
    Json json = object_json(4);
    switch (s.type) {
        case SurfaceType::plane:
            json["normal"] = vector_json(s.axis);
            json["offset"] = -(s.axis[0] * s.point[0] + s.axis[1] * s.point[1] + s.axis[2] * s.point[2]);
            break;
        case SurfaceType::sphere:
            json["center"] = vector_json(s.point);
            json["radius"] = s.radius;
            break;
        case SurfaceType::cylinder:
            json["axis_point"] = vector_json(s.point);
            json["axis"] = vector_json(s.axis);
            json["radius"] = s.radius;
            break;
        case SurfaceType::cone:
            json["apex"] = vector_json(s.point);
            json["axis"] = vector_json(s.axis);
            json["half_angle"] = s.half_angle;
            break;
        case SurfaceType::torus:
            json["center"] = vector_json(s.point);
            json["axis"] = vector_json(s.axis);
            json["major_radius"] = std::abs(s.radius);  // negative: the lemon of a spindle torus
            json["minor_radius"] = s.minor_radius;
            break;
        case SurfaceType::blend:
            json["radius"] = s.radius;
            break;
        default:
            json["center"] = vector_json(s.point);
            json["axes"] = Json::array({{s.axes[0], s.axes[1], s.axes[2]},
                                        {s.axes[3], s.axes[4], s.axes[5]},
                                        {s.axes[6], s.axes[7], s.axes[8]}});
            json["semi_axes"] = vector_json(s.semi_axes);
    }
    return json;
}

Json result_json(const std::string& file, const Mesh& mesh, const Options& options, const Segmentation& segmentation) {
    Json json = object_json(24);
    json["quadseg"] = QUADSEG_VERSION;
    json["input"] = input_json(file, mesh, segmentation.input);
    json["options"] = options_json(options);
    json["stop"] = to_string(segmentation.stop);
    json["partial"] = segmentation.partial;
    const Energy& energy = segmentation.energy;
    json["energy"] = {{"total", energy.total}, {"distance", energy.distance}, {"normal", energy.normal}};
    json["rms"] = segmentation.rms;
    json["max"] = segmentation.max;
    json["noise"] = segmentation.noise;
    const Timings& s = segmentation.seconds;
    json["seconds"] = {{"read", s.read}, {"prepare", s.prepare}, {"coarse", s.coarse}, {"fine", s.fine},
                       {"post", s.post}, {"write", s.write},     {"total", s.total}};
    json["threads"] = segmentation.threads;
    json["peak_bytes"] = segmentation.peak_bytes;
    json["unlabelled"] = segmentation.unlabelled;
    json["borders"] = {{"before", borders_json(segmentation.borders_before)},
                       {"after", borders_json(segmentation.borders_after)}};
    json["regularities"] = regularities_json(segmentation.regularities);
    Json::array_t regions;
    regions.reserve(segmentation.regions.size());
    for (const Region& region : segmentation.regions) regions.push_back(region_json(region));
    json["regions"] = std::move(regions);
    json["history"] = history_json(segmentation.history);
    json["energies"] = segmentation.energies;
    return json;
}

std::string indented(const Json& json) {
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace quadseg::cli
