// V and F matrices in, a vector of labels out.
#include <quadseg/adapters/eigen.h>

#include <Eigen/Core>
#include <cmath>
#include <cstdio>
#include <numbers>

int main() {
    // An open cylinder of 48 facets in 12 rows.
    constexpr int columns = 48;
    constexpr int rows = 12;
    Eigen::MatrixXd vertices(columns * (rows + 1), 3);
    for (int j = 0; j <= rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            const double angle = 2 * std::numbers::pi * i / columns;
            vertices.row(j * columns + i) << 2 * std::cos(angle), 2 * std::sin(angle), 0.25 * j;
        }
    }
    Eigen::MatrixXi faces(2 * columns * rows, 3);
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            const int a = j * columns + i;
            const int b = j * columns + (i + 1) % columns;
            faces.row(2 * a) << a, b, b + columns;
            faces.row(2 * a + 1) << a, b + columns, a + columns;
        }
    }

    Eigen::VectorXi labels;
    const quadseg::Segmentation result = quadseg::adapters::segment(vertices, faces, labels);

    const quadseg::Surface& surface = result.regions.at(0).surface;
    std::printf("%ld labels, %zu regions, first: %s of radius %.6f\n", static_cast<long>(labels.size()),
                result.regions.size(), to_string(surface.type), surface.radius);
    const bool right = labels.size() == faces.rows() && labels.maxCoeff() == 0 &&
                       surface.type == quadseg::SurfaceType::cylinder && std::abs(surface.radius - 2) < 1e-6;
    return right ? 0 : 1;
}
