// For those who hold V and F matrices, a vertex and a triangle a row, as libigl does. Header-only.
#pragma once

#include <quadseg/error.h>
#include <quadseg/mesh.h>
#include <quadseg/segmentation.h>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>

namespace quadseg::adapters {

/// V × 3 coordinates and F × 3 vertex indices, of any scalar and storage order, as flat arrays. Throws Error
/// invalid_argument when a matrix has not three columns, invalid_mesh for a negative index.
template <class Vertices, class Faces>
Mesh to_mesh(const Eigen::MatrixBase<Vertices>& vertices, const Eigen::MatrixBase<Faces>& faces) {
    if (vertices.cols() != 3 || faces.cols() != 3) {
        throw Error(ErrorCode::invalid_argument, "V and F must have three columns");
    }
    Mesh result;
    result.positions.reserve(static_cast<std::size_t>(vertices.size()));
    for (Eigen::Index v = 0; v < vertices.rows(); ++v) {
        for (Eigen::Index a = 0; a < 3; ++a) result.positions.push_back(static_cast<double>(vertices(v, a)));
    }
    result.triangles.reserve(static_cast<std::size_t>(faces.size()));
    for (Eigen::Index f = 0; f < faces.rows(); ++f) {
        for (Eigen::Index k = 0; k < 3; ++k) {
            if (faces(f, k) < 0) {
                throw Error(ErrorCode::invalid_mesh, "face " + std::to_string(f) + " has a negative vertex index");
            }
            result.triangles.push_back(static_cast<std::uint32_t>(faces(f, k)));
        }
    }
    result.file_faces = static_cast<std::size_t>(faces.rows());
    return result;
}

/// Segments the mesh; labels(f) becomes the label of row f of F.
template <class Vertices, class Faces>
Segmentation segment(const Eigen::MatrixBase<Vertices>& vertices, const Eigen::MatrixBase<Faces>& faces,
                     Eigen::VectorXi& labels, const Options& options = {}, Context* context = nullptr) {
    const Mesh arrays = to_mesh(vertices, faces);
    Segmentation result = quadseg::segment(arrays.view(), options, context);
    labels = Eigen::Map<const Eigen::VectorXi>(result.labels.data(), static_cast<Eigen::Index>(result.labels.size()));
    return result;
}

}  // namespace quadseg::adapters
