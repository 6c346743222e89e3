// The default preset on the generated parts: the true surfaces, counted and compared by area.
#include <quadseg/segmentation.h>

#include "datasets/generate.h"
#include "tests/pipeline/result_checks.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace quadseg::test {
namespace {

/// What is demanded, and where today's engine falls short of the truth by how much: tighten, never loosen.
struct Part {
    const char* name;
    std::size_t faces;
    double agreement = 0.999;
    std::size_t surplus = 0;  ///< regions beyond the true number
    double typed = 0.99;      ///< share of the area of the right type
    double deviation = 1e-6;
};

void PrintTo(const Part& part, std::ostream* out) {
    *out << part.name << "_" << part.faces;
}

class Parts : public testing::TestWithParam<Part> {};

TEST_P(Parts, AreTheirTrueSurfaces) {
    const datasets::Generated part = datasets::generate(GetParam().name, GetParam().faces);
    const Segmentation s = segment(part.mesh.view());
    ASSERT_EQ(broken_rule(part.mesh.view(), s), "");
    const Part& demand = GetParam();
    EXPECT_GE(s.regions.size(), part.surfaces.size());
    EXPECT_LE(s.regions.size(), part.surfaces.size() + demand.surplus);
    EXPECT_GE(area_agreement(part.mesh.view(), part.truth, s.labels), demand.agreement);

    // Types by area, each region judged by the true surface that most of it lies on.
    std::vector<std::map<std::int32_t, std::size_t>> votes(s.regions.size());
    for (std::size_t f = 0; f < s.labels.size(); ++f) ++votes[static_cast<std::size_t>(s.labels[f])][part.truth[f]];
    double right = 0, all = 0;
    for (const Region& r : s.regions) {
        const auto& of_region = votes[static_cast<std::size_t>(r.id)];
        const auto best = std::max_element(of_region.begin(), of_region.end(),
                                           [](const auto& a, const auto& b) { return a.second < b.second; });
        const SurfaceType truth = part.surfaces[static_cast<std::size_t>(best->first)].surface.type;
        all += r.area;
        if (truth == r.surface.type) right += r.area;
    }
    EXPECT_GE(right, demand.typed * all);
    EXPECT_LE(s.max, demand.deviation);
}

INSTANTIATE_TEST_SUITE_P(Generated, Parts,
                         testing::Values(Part{"plate", 3000, 0.998, 3, 0.97, 6e-3}, Part{"shaft", 3000},
                                         Part{"flange", 3000}, Part{"fillets", 3000}, Part{"rounded_octahedron", 3000},
                                         Part{"quadrics", 8000, 0.998, 13, 0.998, 2e-4}, Part{"plate", 20000},
                                         Part{"shaft", 20000}, Part{"flange", 20000}, Part{"fillets", 20000},
                                         Part{"rounded_octahedron", 20000},
                                         Part{"quadrics", 20000, 0.998, 12, 0.998, 2.6e-3}));

/// Normals of rough vertices tell no type: every cylinder was free-form.
TEST(NoisyParts, KeepTheNamesOfTheirSurfaces) {
    const datasets::Generated flange = datasets::generate("flange", 30000, 0.002);
    const Segmentation s = segment(flange.mesh.view());
    const auto count = [&](SurfaceType type) {
        return std::count_if(s.regions.begin(), s.regions.end(),
                             [&](const Region& r) { return r.surface.type == type; });
    };
    EXPECT_GE(count(SurfaceType::cylinder), 9);
    EXPECT_GE(count(SurfaceType::torus), 1);
    EXPECT_LE(count(SurfaceType::freeform), 3);
    std::size_t named = 0;
    for (std::size_t f = 0; f < s.labels.size(); ++f) {
        const SurfaceType found = s.regions[static_cast<std::size_t>(s.labels[f])].surface.type;
        named += found == flange.surfaces[static_cast<std::size_t>(flange.truth[f])].surface.type ? 1 : 0;
    }
    // A cone found beside pieces of the fillet counted as one of three before.
    EXPECT_GE(static_cast<double>(named), 0.975 * static_cast<double>(s.labels.size()));
}

}  // namespace
}  // namespace quadseg::test
