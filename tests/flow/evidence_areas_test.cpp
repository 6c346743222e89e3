#include "flow/evidence_areas.h"

#include "datasets/generate.h"
#include "tests/partition/box.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numeric>

namespace quadseg {
namespace {

const runtime::RunControl free_run(nullptr);

/// Two squares side by side, one divided `fine` times as finely as the other.
test::Shape uneven(std::uint32_t coarse, std::uint32_t fine) {
    test::Shape s;
    for (std::uint32_t square = 0; square < 2; ++square) {
        const std::uint32_t n = square == 0 ? coarse : fine * coarse;
        const auto first = static_cast<std::uint32_t>(s.positions.size() / 3);
        for (std::uint32_t j = 0; j <= n; ++j) {
            for (std::uint32_t i = 0; i <= n; ++i) s.vertex(2.0 * square + double(i) / n, double(j) / n, 0);
        }
        for (std::uint32_t j = 0; j < n; ++j) {
            for (std::uint32_t i = 0; i < n; ++i) {
                const std::uint32_t v = first + j * (n + 1) + i;
                s.quad(v, v + 1, v + n + 2, v + n + 1);
            }
        }
    }
    return s;
}

TEST(EvidenceAreas, SumToWhatIsAsked) {
    const mesh::WorkMesh mesh = mesh::build_work_mesh(datasets::generate("plate", 8000, 0).mesh.view(), free_run);
    const std::vector<double> weights = flow::evidence_areas(mesh, 7, free_run);
    ASSERT_EQ(weights.size(), mesh.face_count());
    EXPECT_NEAR(std::accumulate(weights.begin(), weights.end(), 0.0), 7, 1e-9);
}

TEST(EvidenceAreas, GoWithTheRootOfTheDensity) {
    const mesh::WorkMesh mesh = test::work_mesh(uneven(8, 4));
    const std::vector<double> weights = flow::evidence_areas(mesh, mesh.total_area, free_run);
    // Those inside, which have the most neighbours and so the least weight of their size.
    const double between = mesh.total_area / 2 / std::sqrt(128.0 * 2048.0);
    double coarse = mesh.total_area, fine = mesh.total_area;
    for (std::size_t f = 0; f < weights.size(); ++f) {
        double& least = mesh.areas[f] > between ? coarse : fine;
        least = std::min(least, weights[f]);
    }
    EXPECT_NEAR(fine / coarse, 0.25, 1e-9);
}

TEST(EvidenceAreas, FacesWithoutAreaCountNothing) {
    test::Shape shape = uneven(2, 1);
    const std::uint32_t v = shape.vertex(0.5, 0, 0);
    shape.face(0, 1, v);
    const mesh::WorkMesh mesh = test::work_mesh(shape);
    const std::vector<double> weights = flow::evidence_areas(mesh, 1, free_run);
    for (std::size_t f = 0; f < weights.size(); ++f) {
        EXPECT_TRUE(std::isfinite(weights[f]));
        EXPECT_EQ(weights[f] > 0, mesh.areas[f] > 0);
    }
}

}  // namespace
}  // namespace quadseg
