// A CGAL mesh whose face i is face i of ours.
#pragma once

#include <quadseg/mesh.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <array>
#include <cstddef>
#include <stdexcept>
#include <vector>

namespace quadseg::bench {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Vector = Kernel::Vector_3;
using CgalMesh = CGAL::Surface_mesh<Point>;

/// Vertices of non-manifold edges are duplicated: CGAL's meshes have none.
inline CgalMesh cgal_mesh(const Mesh& mesh) {
    std::vector<Point> points(mesh.positions.size() / 3);
    for (std::size_t v = 0; v < points.size(); ++v) {
        points[v] = {mesh.positions[3 * v], mesh.positions[3 * v + 1], mesh.positions[3 * v + 2]};
    }
    std::vector<std::array<std::size_t, 3>> faces(mesh.triangles.size() / 3);
    for (std::size_t c = 0; c < mesh.triangles.size(); ++c) faces[c / 3][c % 3] = mesh.triangles[c];
    namespace processing = CGAL::Polygon_mesh_processing;
    processing::orient_polygon_soup(points, faces);
    CgalMesh result;
    processing::polygon_soup_to_polygon_mesh(points, faces, result);
    if (result.number_of_faces() != faces.size()) throw std::runtime_error("CGAL's mesh dropped faces");
    return result;
}

}  // namespace quadseg::bench
