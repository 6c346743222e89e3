// The files of the set: OFF meshes, and the ground truth as JSON.
#include "step.h"

#include <cstdarg>
#include <cstdio>
#include <memory>
#include <numbers>
#include <stdexcept>

namespace step_truth {
namespace {

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

File open(const std::string& name) {
    File file(std::fopen(name.c_str(), "w"), std::fclose);
    if (!file) throw std::runtime_error("cannot write " + name);
    return file;
}

void vector(std::FILE* f, const char* key, const Vec3& v) {
    std::fprintf(f, ",\"%s\":[%.12g,%.12g,%.12g]", key, v[0], v[1], v[2]);
}

void parameters(std::FILE* f, const Face& face) {
    if (!face.analytic()) return;
    const std::string& type = face.type;
    vector(f, type == "cone" ? "apex" : type == "sphere" || type == "torus" ? "center" : "point", face.point);
    if (type == "plane") return vector(f, "normal", face.axis);
    if (type != "sphere") vector(f, "axis", face.axis);
    if (type == "cone") std::fprintf(f, ",\"half_angle_deg\":%.12g", face.half_angle * 180 / std::numbers::pi);
    if (type == "torus") std::fprintf(f, ",\"major_radius\":%.12g,\"minor_radius\":%.12g", face.radius, face.minor);
    if (type == "cylinder" || type == "sphere") std::fprintf(f, ",\"radius\":%.12g", face.radius);
    std::fprintf(f, ",\"convex\":%s", face.convex ? "true" : "false");
}

template <class Value>
void list(std::FILE* f, const char* key, std::size_t n, Value value) {
    std::fprintf(f, "\"%s\":[", key);
    for (std::size_t i = 0; i < n; ++i) std::fprintf(f, "%s%d", i ? "," : "", value(i));
    std::fputc(']', f);
}

void groups(std::FILE* f, const Solid& solid, const std::vector<int>& triangles) {
    std::vector<std::vector<std::size_t>> faces(static_cast<std::size_t>(solid.groups));
    for (std::size_t i = 0; i < solid.faces.size(); ++i) faces[solid.faces[i].group].push_back(i);
    for (std::size_t g = 0; g < faces.size(); ++g) {
        double area = 0;
        int count = 0;
        for (const std::size_t i : faces[g]) {
            area += solid.faces[i].area;
            count += triangles[i];
        }
        const Face& first = solid.faces[faces[g][0]];
        std::fprintf(f, "%s\n{\"id\":%zu,\"type\":\"%s\",\"surface\":%d,\"area\":%.9g,\"triangles\":%d,", g ? "," : "",
                     g, first.type.c_str(), solid.surface_of_group[g], area, count);
        list(f, "faces", faces[g].size(), [&](std::size_t i) { return static_cast<int>(faces[g][i]); });
        parameters(f, first);
        std::fputc('}', f);
    }
}

}  // namespace

void write_off(const std::string& file, const Mesh& mesh) {
    const File f = open(file);
    std::fprintf(f.get(), "OFF\n%zu %zu 0\n", mesh.vertices.size(), mesh.triangles.size());
    for (const Vec3& v : mesh.vertices) std::fprintf(f.get(), "%.9g %.9g %.9g\n", v[0], v[1], v[2]);
    for (const auto& t : mesh.triangles) std::fprintf(f.get(), "3 %d %d %d\n", t[0], t[1], t[2]);
}

void write_truth(const std::string& file, const std::string& name, const std::string& source, const Solid& solid,
                 const Mesh& mesh) {
    std::vector<int> triangles(solid.faces.size());
    for (const int face : mesh.face) ++triangles[face];
    const bool dense = mesh.target_edge > 0;
    const File out = open(file);
    std::FILE* f = out.get();
    std::fprintf(f, "{\"format\":\"cadseg-gt-1\",\"model\":\"%s\",\"variant\":\"%s\",\"mesh\":\"%s%s.off\",\n",
                 name.c_str(), dense ? "dense" : "cad", name.c_str(), dense ? "" : "_cad");
    std::fprintf(f, "\"source\":\"%s\",\n\"units\":\"mm\",\"vertices\":%zu,\"triangles\":%zu,", source.c_str(),
                 mesh.vertices.size(), mesh.triangles.size());
    std::fprintf(f, "\"bbox_diagonal\":%.9g,\"deflection\":%.6g,\"angular_deflection_deg\":12,\"target_edge\":%.6g,\n",
                 solid.diagonal, mesh.deflection, mesh.target_edge);
    std::fprintf(f, "\"faces\":[");
    for (std::size_t i = 0; i < solid.faces.size(); ++i) {
        const Face& face = solid.faces[i];
        std::fprintf(f, "%s\n{\"id\":%zu,\"group\":%d,\"type\":\"%s\"", i ? "," : "", i, face.group, face.type.c_str());
        if (!face.native_type.empty()) std::fprintf(f, ",\"native_type\":\"%s\"", face.native_type.c_str());
        std::fprintf(f, ",\"area\":%.9g,\"triangles\":%d", face.area, triangles[i]);
        parameters(f, face);
        std::fputc('}', f);
    }
    std::fprintf(f, "],\n\"groups\":[");
    groups(f, solid, triangles);
    std::fprintf(f, "],\n\"group_adjacency\":[");
    for (std::size_t i = 0; i < solid.adjacency.size(); ++i) {
        const Adjacency& a = solid.adjacency[i];
        std::fprintf(f, "%s[%d,%d,%.6g,%.4g]", i ? "," : "", a.a, a.b, a.length, a.angle);
    }
    std::fprintf(f, "],\n");
    list(f, "brep_face", mesh.face.size(), [&](std::size_t t) { return mesh.face[t]; });
    std::fprintf(f, ",\n");
    list(f, "surface_group", mesh.face.size(), [&](std::size_t t) { return solid.faces[mesh.face[t]].group; });
    std::fprintf(f, "}\n");
}

}  // namespace step_truth
