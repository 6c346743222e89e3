// Ground truth from STEP parts: the solid with its exact faces, its two meshes, and the files written from them.
#pragma once

#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace step_truth {

using Vec3 = std::array<double, 3>;

inline Vec3 operator-(const Vec3& a, const Vec3& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline double dot(const Vec3& a, const Vec3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// One face of the solid on its exact surface. `point` is a point of the plane or of the axis, the apex or the centre.
struct Face {
    TopoDS_Face shape;
    std::string type, native_type;
    int group = -1;
    double area = 0;
    Vec3 point{}, axis{};  // the outward normal of a plane; from the apex into a cone
    double radius = 0, minor = 0, half_angle = 0;
    bool convex = false;

    bool analytic() const {
        return type == "plane" || type == "cylinder" || type == "cone" || type == "sphere" || type == "torus";
    }
};

// Two groups that touch: the length of their common boundary and the mean angle of the normals along it, in degrees.
struct Adjacency {
    int a, b;
    double length, angle;
};

struct Solid {
    TopoDS_Shape shape;
    double diagonal = 0;
    std::vector<Face> faces;  // in the order of TopExp_Explorer
    int groups = 0;
    std::vector<int> surface_of_group;  // equal for groups on the same surface, touching or not
    std::vector<Adjacency> adjacency;
};

struct Mesh {
    std::vector<Vec3> vertices;
    std::vector<std::array<int, 3>> triangles;
    std::vector<int> face;  // of each triangle
    double deflection = 0, target_edge = 0;
};

Solid read_solid(const std::string& step_file);          // throws std::runtime_error unless there is one solid
double distance(const Face& face, const Vec3& p);        // of a point to an analytic surface
Mesh tessellate(const Solid& solid, double deflection);  // the plain CAD tessellation

// The dense mesh: near-uniform with edges up to `largest`, shorter where a face wants it.
std::vector<double> fine_edges(const Solid& solid);  // wanted by each face
double expected_triangles(const Solid& solid, const std::vector<double>& edges, double largest);
Mesh dense_mesh(const Solid& solid, const std::vector<double>& edges, double largest);

// Orients the triangles outwards, drops unused vertices, and shuffles both. Throws unless the mesh is closed,
// 2-manifold, connected, and true to the faces.
void finish(const Solid& solid, Mesh& mesh, std::uint64_t seed);
void write_off(const std::string& file, const Mesh& mesh);
void write_truth(const std::string& file, const std::string& name, const std::string& source, const Solid& solid,
                 const Mesh& mesh);
// Gaussian noise along the vertex normals.
Mesh with_noise(const Mesh& mesh, double sigma, std::uint64_t seed);

}  // namespace step_truth
