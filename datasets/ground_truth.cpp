// Ground truth as JSON, the format of the shared evaluators (tools/README.md).
#include "datasets/generate.h"
#include "math/vec3.h"

#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>

namespace quadseg::datasets {
namespace {

template <class Number>
void append(std::string& text, Number value) {
    char buffer[32];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, value);
    text.append(buffer, end.ptr);
}

template <class Numbers>
void append_list(std::string& text, const char* key, const Numbers& numbers) {
    text += ", \"";
    text += key;
    text += "\": [";
    bool first = true;
    for (const auto value : numbers) {
        if (!first) text += ", ";
        first = false;
        append(text, value);
    }
    text += ']';
}

void append_number(std::string& text, const char* key, double value) {
    text += ", \"";
    text += key;
    text += "\": ";
    append(text, value);
}

void append_parameters(std::string& text, const Surface& s) {
    switch (s.type) {
        case SurfaceType::plane:
            append_list(text, "point", s.point);
            append_list(text, "normal", s.axis);
            return;
        case SurfaceType::sphere:
            append_list(text, "center", s.point);
            append_number(text, "radius", s.radius);
            break;
        case SurfaceType::cylinder:
            append_list(text, "point", s.point);
            append_list(text, "axis", s.axis);
            append_number(text, "radius", s.radius);
            break;
        case SurfaceType::cone:
            append_list(text, "apex", s.point);
            append_list(text, "axis", s.axis);
            append_number(text, "half_angle_deg", s.half_angle * 180 / std::numbers::pi);
            break;
        case SurfaceType::torus:
            append_list(text, "center", s.point);
            append_list(text, "axis", s.axis);
            append_number(text, "major_radius", s.radius);
            append_number(text, "minor_radius", s.minor_radius);
            break;
        default:
            append_list(text, "center", s.point);
            append_list(text, "axes", s.axes);
            append_list(text, "semi_axes", s.semi_axes);
            append_list(text, "coefficients", s.coefficients);
    }
    text += s.outward ? ", \"convex\": true" : ", \"convex\": false";
}

struct Border {
    double length = 0;
    double angle = 0;  ///< length weighted, between the triangles' normals
};

/// Boundaries between surfaces, from the mesh: triangles of a solid share every edge in pairs.
std::map<std::pair<std::int32_t, std::int32_t>, Border> adjacency(const Generated& generated) {
    const Mesh& mesh = generated.mesh;
    const auto at = [&](std::uint32_t v) {
        const std::size_t i = 3 * std::size_t{v};
        return Vec3{mesh.positions[i], mesh.positions[i + 1], mesh.positions[i + 2]};
    };
    // Only vertices of two surfaces can bound; few are left for the sort.
    std::vector<std::int32_t> surface_of(mesh.positions.size() / 3, -1);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        auto& s = surface_of[mesh.triangles[i]];
        const std::int32_t own = generated.truth[i / 3];
        s = s == -1 || s == own ? own : -2;
    }
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> open;
    std::map<std::pair<std::int32_t, std::int32_t>, Border> borders;
    const auto normal = [&](std::size_t f) {
        const std::uint32_t* t = &mesh.triangles[3 * f];
        return cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0]));
    };
    for (std::size_t f = 0; f < generated.truth.size(); ++f) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = mesh.triangles[3 * f + k];
            const std::uint32_t b = mesh.triangles[3 * f + (k + 1) % 3];
            if (surface_of[a] != -2 || surface_of[b] != -2) continue;
            const auto [other, first] = open.try_emplace(std::minmax(a, b), f);
            if (first) continue;
            const std::int32_t s = generated.truth[f];
            const std::int32_t t = generated.truth[other->second];
            if (s != t) {
                Border& border = borders[std::minmax(s, t)];
                const double length = norm(at(b) - at(a));
                border.length += length;
                border.angle += length * angle_between(normal(f), normal(other->second)) * 180 / std::numbers::pi;
            }
            open.erase(other);
        }
    }
    return borders;
}

}  // namespace

std::string ground_truth_json(const Generated& generated, const Recipe& recipe) {
    std::string text;
    text.reserve(generated.truth.size() * 4 + 4096 + generated.surfaces.size() * 512);
    // The evaluators read text meshes; they look for this one beside the ground truth and do without it otherwise.
    text += "{\"format\": \"cadseg-gt-1\", \"model\": \"" + recipe.name + "\", \"variant\": \"dense\", \"mesh\": \"" +
            recipe.name + ".off\", \"source\": \"quadseg generate\", \"units\": \"mm\"";
    append_number(text, "vertices", static_cast<double>(generated.mesh.positions.size() / 3));
    append_number(text, "triangles", static_cast<double>(generated.truth.size()));
    append_number(text, "bbox_diagonal", generated.diagonal);
    append_number(text, "faces_wanted", static_cast<double>(recipe.faces));
    append_number(text, "noise", recipe.noise);
    append_number(text, "seed", static_cast<double>(recipe.seed));
    for (const char* list : {"faces", "groups"}) {
        const bool faces = list[0] == 'f';
        text += ",\n\"";
        text += list;
        text += "\": [";
        for (std::size_t k = 0; k < generated.surfaces.size(); ++k) {
            const TrueSurface& s = generated.surfaces[k];
            text += k == 0 ? "\n{\"id\": " : ",\n{\"id\": ";
            append(text, k);
            if (faces) {
                append_number(text, "group", static_cast<double>(k));
            } else {
                append_number(text, "surface", s.analytic);
                append_list(text, "faces", std::vector<std::size_t>{k});
            }
            text += ", \"type\": \"";
            text += to_string(s.surface.type);
            text += '"';
            append_number(text, "area", s.area);
            append_number(text, "triangles", static_cast<double>(s.triangles));
            append_parameters(text, s.surface);
            text += '}';
        }
        text += "\n]";
    }
    text += ",\n\"group_adjacency\": [";
    bool first = true;
    for (const auto& [pair, border] : adjacency(generated)) {
        text += first ? "[" : ", [";
        first = false;
        append(text, pair.first);
        text += ", ";
        append(text, pair.second);
        text += ", ";
        append(text, border.length);
        text += ", ";
        append(text, border.length > 0 ? border.angle / border.length : 0);
        text += ']';
    }
    text += "]";
    for (const char* list : {"brep_face", "surface_group"}) {
        text += ",\n\"";
        text += list;
        text += "\": [";
        for (std::size_t f = 0; f < generated.truth.size(); ++f) {
            if (f != 0) text += ',';
            append(text, generated.truth[f]);
        }
        text += ']';
    }
    text += "}\n";
    return text;
}

}  // namespace quadseg::datasets
