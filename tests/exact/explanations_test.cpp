#include "exact/explanations.h"

#include "datasets/generate.h"
#include "exact/hypothesis.h"
#include "mesh/work_mesh.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <vector>

namespace quadseg::exact {
namespace {

TEST(Explanations, DependOnTheSetOfFacesAlone) {
    const datasets::Generated part = datasets::generate("shaft", 6000);
    const runtime::RunControl control(nullptr);
    const mesh::WorkMesh mesh = mesh::build_work_mesh(part.mesh.view(), control);
    const Scene scene = build_scene(mesh, control);
    Marks marks;
    Explanations known(scene, scene.tolerances.fit);
    std::size_t explained = 0;
    for (std::uint32_t seed = 0; seed < mesh.face_count(); seed += 97) {
        const auto any = [](std::uint32_t) { return true; };
        std::vector<std::uint32_t> faces = collect_patch(scene, seed, 16, {}, any, marks).faces;
        const std::optional<Surface> first = known.of(faces, true, marks), again = known.of(faces, true, marks);
        std::reverse(faces.begin(), faces.end());
        Explanations afresh(scene, scene.tolerances.fit);
        for (const std::optional<Surface>& other :
             {again, known.of(faces, true, marks), afresh.of(faces, true, marks)}) {
            ASSERT_EQ(other.has_value(), first.has_value());
            if (first) {
                EXPECT_EQ(other->type, first->type);
                EXPECT_EQ(other->point, first->point);
                EXPECT_EQ(other->axis, first->axis);
                EXPECT_EQ(other->radius, first->radius);
            }
        }
        // What is known is not mixed up with other sets.
        std::sort(faces.begin(), faces.end());
        const std::optional<Surface> direct = explain(scene, faces, scene.tolerances.fit, true, marks);
        ASSERT_EQ(direct.has_value(), first.has_value());
        if (first) {
            EXPECT_EQ(direct->point, first->point);
        }
        if (first) ++explained;
    }
    EXPECT_GT(explained, 10u);
}

}  // namespace
}  // namespace quadseg::exact
