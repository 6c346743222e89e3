#include "flow/evidence_areas.h"

#include <cmath>

namespace quadseg::flow {

std::vector<double> evidence_areas(const mesh::WorkMesh& mesh, double total, const runtime::RunControl& control) {
    const std::size_t faces = mesh.face_count();
    std::vector<double> around(mesh.vertex_count(), 0);  // area of the faces at a vertex
    std::size_t polls = 0;
    for (std::size_t f = 0; f < faces; ++f) {
        control.check_often(polls);
        for (const std::uint32_t v : mesh.faces[f]) around[v] += mesh.areas[f];
    }
    std::vector<double> weights(faces);
    double sum = 0;
    for (std::size_t f = 0; f < faces; ++f) {
        control.check_often(polls);
        double density = 0;
        for (const std::uint32_t v : mesh.faces[f]) density += around[v] > 0 ? 1 / around[v] : 0;
        weights[f] = mesh.areas[f] * std::sqrt(density);
        sum += weights[f];
    }
    if (sum > 0) {
        for (double& w : weights) w *= total / sum;
    }
    return weights;
}

}  // namespace quadseg::flow
