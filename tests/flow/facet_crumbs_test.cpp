#include "flow/facet_crumbs.h"

#include "exact/tolerances.h"
#include "tests/partition/box.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace quadseg {
namespace {

const runtime::RunControl free_run(nullptr);

/// A cylinder (label 0) with a cap (label 1), and what a test labels as it likes.
struct Capped {
    mesh::WorkMesh mesh = test::work_mesh(test::capped_cylinder(36, 12));
    exact::Facets facets =
        exact::find_facets(mesh, exact::choose_tolerances(mesh), exact::face_heights(mesh), free_run);
    std::vector<Surface> surfaces = std::vector<Surface>(3);
    partition::Labels labels = partition::Labels(mesh.face_count(), 0);

    Capped() {
        surfaces[0].type = SurfaceType::cylinder;
        surfaces[1].type = surfaces[2].type = SurfaceType::plane;
        for (std::size_t f = 0; f < labels.size(); ++f) labels[f] = mesh.normals[f].z > 0.9 ? 1 : 0;
    }
    std::size_t some_face_of_the_wall() const {
        std::size_t f = 0;
        while (labels[f] != 0 || mesh.centroid(f).z > 0.2 || mesh.centroid(f).z < -0.2) ++f;
        return f;
    }
    partition::Labels absorbed() const {
        partition::Labels result = labels;
        flow::absorb_facet_crumbs(mesh, facets, surfaces, free_run, result);
        return result;
    }
};

TEST(FacetCrumbs, AFacetAmidACylinderJoinsIt) {
    Capped c;
    const partition::Labels whole = c.labels;
    const std::size_t crumb = c.some_face_of_the_wall();
    for (const std::int32_t label : {2, -1}) {
        c.labels[crumb] = label;
        EXPECT_EQ(c.absorbed(), whole);
    }
}

TEST(FacetCrumbs, WhatIsLargeOrLiesAcrossACreaseStays) {
    Capped c;
    EXPECT_EQ(c.absorbed(), c.labels);
    // A third of the wall.
    for (std::size_t f = 0; f < c.labels.size(); ++f) {
        if (c.labels[f] == 0 && c.mesh.centroid(f).x > 0.25) c.labels[f] = 2;
    }
    EXPECT_EQ(c.absorbed(), c.labels);
}

}  // namespace
}  // namespace quadseg
