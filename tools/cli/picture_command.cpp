// `quadseg picture`: a mesh, its regions, its surface types or its sharp edges as a PNG.
#include <quadseg/context.h>
#include <quadseg/error.h>
#include <quadseg/io.h>
#include <quadseg/mesh.h>

#include "math/vec3.h"
#include "tools/cli/commands.h"
#include "tools/cli/exit_code.h"
#include "tools/cli/files.h"
#include "tools/cli/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <tuple>
#include <vector>

namespace quadseg::cli {
namespace {

struct Arguments {
    std::string mesh, output, labels, result, up;
    double sharp = 0;
    bool edges = false;
    std::size_t width = 1000, height = 750;
};

/// A label a face of the file, as write_labels() writes them; here: one a triangle.
std::vector<std::int32_t> read_labels(const std::string& path, const Mesh& mesh) {
    std::ifstream in(path);
    if (!in) throw Error(ErrorCode::file_open, path + ": can't be opened");
    std::vector<std::int32_t> of_file;
    for (std::int32_t label = 0; in >> label;) of_file.push_back(label);
    if (!in.eof() || of_file.size() != mesh.file_faces) {
        throw Error(ErrorCode::file_format, path + ": has " + std::to_string(of_file.size()) +
                                                " whole numbers, but the mesh has " + std::to_string(mesh.file_faces) +
                                                " faces");
    }
    if (mesh.polygons.empty()) return of_file;
    std::vector<std::int32_t> labels;
    for (const std::uint32_t polygon : mesh.polygons) labels.push_back(of_file[polygon]);
    return labels;
}

std::vector<SurfaceType> read_types(const std::string& path, const std::vector<std::int32_t>& labels) {
    std::ifstream in(path);
    if (!in) throw Error(ErrorCode::file_open, path + ": can't be opened");
    std::vector<SurfaceType> types;
    try {
        const nlohmann::json result = nlohmann::json::parse(in);
        for (const auto& region : result.at("regions")) {
            const std::string name = region.at("type");
            std::size_t t = 0;
            while (t < surface_type_count && name != to_string(static_cast<SurfaceType>(t))) ++t;
            if (t == surface_type_count) {
                throw Error(ErrorCode::file_format, std::string(path).append(": no surface type: ").append(name));
            }
            types.push_back(static_cast<SurfaceType>(t));
        }
    } catch (const nlohmann::json::exception& error) {
        throw Error(ErrorCode::file_format, path + ": " + error.what());
    }
    for (const std::int32_t label : labels) {
        if (label >= 0 && static_cast<std::size_t>(label) >= types.size()) {
            throw Error(ErrorCode::file_format, path + ": has no region " + std::to_string(label));
        }
    }
    return types;
}

Vec3 normal_of(const MeshView& mesh, std::uint32_t face) {
    std::array<Vec3, 3> p;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t i = 3 * std::size_t{mesh.triangles[3 * std::size_t{face} + k]};
        p[k] = {mesh.positions[i], mesh.positions[i + 1], mesh.positions[i + 2]};
    }
    return normalized(cross(p[1] - p[0], p[2] - p[0]));
}

/// Every edge once; with `degrees` above 0 only those of a larger dihedral angle (the paper's section 5.1).
std::vector<Edge> edges_of(const MeshView& mesh, double degrees) {
    struct Side {
        std::uint32_t low, high, face;
    };
    std::vector<Side> sides;
    for (std::size_t c = 0; c < mesh.triangles.size(); ++c) {
        const std::uint32_t a = mesh.triangles[c];
        const std::uint32_t b = mesh.triangles[c - c % 3 + (c + 1) % 3];
        if (a != b) sides.push_back({std::min(a, b), std::max(a, b), static_cast<std::uint32_t>(c / 3)});
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::tie(a.low, a.high, a.face) < std::tie(b.low, b.high, b.face);
    });
    const double least = std::cos(degrees * std::numbers::pi / 180);
    std::vector<Edge> edges;
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t end = i + 1;
        while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high) ++end;
        const bool sharp = degrees <= 0 || (end - i == 2 && dot(normal_of(mesh, sides[i].face),
                                                                normal_of(mesh, sides[i + 1].face)) < least);
        if (sharp) edges.push_back({sides[i].low, sides[i].high});
        i = end;
    }
    return edges;
}

int run_picture(const Arguments& a) {
    const Mesh mesh = read_mesh(a.mesh);
    on_file(a.mesh, [&] { return inspect(mesh.view(), 0); });
    std::vector<std::int32_t> labels;
    if (!a.labels.empty()) labels = read_labels(a.labels, mesh);
    std::vector<SurfaceType> types;
    if (!a.result.empty()) types = read_types(a.result, labels);
    PictureContent content;
    std::vector<Edge> edges;
    if (a.edges || a.sharp > 0) edges = edges_of(mesh.view(), a.sharp);
    if (a.edges) {
        content.edge_color = {70, 76, 88};
        content.edge_width = 0.5;
    }
    content.labels = labels;
    content.types = types;
    content.edges = edges;
    content.up = a.up.empty() ? -1 : a.up[0] - 'x';
    content.width = a.width;
    content.height = a.height;
    write_picture(a.output, mesh.view(), content);
    return exit_done;
}

}  // namespace

Command add_picture(CLI::App& app) {
    const auto arguments = std::make_shared<Arguments>();
    CLI::App* command = app.add_subcommand("picture", "Renders a mesh and its regions as a PNG");
    command->add_option("mesh", arguments->mesh, "OFF, OBJ, PLY or STL file")->required();
    command->add_option("-o,--output", arguments->output, "PNG file to write")->required();
    CLI::Option* labels =
        command->add_option("--labels", arguments->labels, "labels.txt: every region in a colour of its own");
    command
        ->add_option("--result", arguments->result,
                     "result.json of the same run: every surface type in its colour, with a legend")
        ->needs(labels);
    CLI::Option* sharp = command->add_option("--sharp", arguments->sharp, "Draw the edges sharper than so many degrees")
                             ->check(CLI::Range(0.0, 180.0));
    command->add_flag("--edges", arguments->edges, "Draw all edges")->excludes(sharp);
    command->add_option("--up", arguments->up, "Axis that stands upright; unset: that of the shortest side")
        ->check(CLI::IsMember({"x", "y", "z"}));
    command->add_option("--width", arguments->width, "Pixels, without the legend")
        ->check(CLI::Range(16, 8192))
        ->capture_default_str();
    command->add_option("--height", arguments->height, "Pixels")->check(CLI::Range(16, 8192))->capture_default_str();
    return [arguments] { return run_picture(*arguments); };
}

}  // namespace quadseg::cli
