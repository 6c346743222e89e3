// What the tests of the variational loop share: shapes of known surfaces, one call, and what every result must fulfil.
#pragma once

#include "flow/paper.h"
#include "flow/paper_loop.h"
#include "mesh/features.h"
#include "runtime/parallel.h"
#include "tests/mesh/shapes.h"
#include "tests/partition/box.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace quadseg::test {

/// box(n) without its top.
inline Shape open_box(std::uint32_t n) {
    Shape closed = box(n), s;
    s.positions = closed.positions;
    for (std::size_t f = 0; f < closed.faces(); ++f) {
        const std::uint32_t* v = &closed.triangles[3 * f];
        const auto top = [&](std::uint32_t i) { return closed.positions[3 * i + 2] > 1 - 1e-9; };
        if (!(top(v[0]) && top(v[1]) && top(v[2]))) s.face(v[0], v[1], v[2]);
    }
    return s;
}

/// Half a sphere of radius 1 on a flat ring round it: two surfaces that meet at a right angle.
inline Shape dome_on_plate(std::uint32_t sectors, std::uint32_t rings) {
    Shape s;
    const double pi = std::acos(-1.0);
    const auto ring = [&](double r, double z) {
        for (std::uint32_t i = 0; i < sectors; ++i) {
            const double t = 2 * pi * i / sectors;
            s.vertex(r * std::cos(t), r * std::sin(t), z);
        }
    };
    const std::uint32_t pole = s.vertex(0, 0, 1);
    for (std::uint32_t j = 1; j <= rings; ++j) {
        const double a = 0.5 * pi * j / rings;
        ring(std::sin(a), std::cos(a));
    }
    for (std::uint32_t j = 1; j <= rings; ++j) ring(1 + static_cast<double>(j) / rings, 0);
    for (std::uint32_t i = 0; i < sectors; ++i) s.face(pole, 1 + i, 1 + (i + 1) % sectors);
    for (std::uint32_t j = 0; j + 1 < 2 * rings; ++j) {
        for (std::uint32_t i = 0; i < sectors; ++i) {
            const std::uint32_t a = 1 + j * sectors + i, b = 1 + j * sectors + (i + 1) % sectors;
            s.quad(a, a + sectors, b + sectors, b);
        }
    }
    return s;
}

inline Options paper_options(std::size_t regions = 0) {
    Options options;
    options.preset = Preset::paper;
    options.regions = regions;
    return options;
}

struct PaperRun {
    mesh::WorkMesh mesh;
    std::optional<mesh::FeatureEdges> features;
    flow::FlowResult result;

    partition::Passage passage() const { return {&mesh, features ? &*features : nullptr, {}}; }
    double energy(const Options& options) const {
        const runtime::RunControl control(nullptr);
        flow::VariationalLoop loop({mesh, features ? &*features : nullptr, options, control});
        loop.start_from_labels(result.labels);
        return loop.state().energy;
    }
};

inline PaperRun run_paper(const Shape& shape, const Options& options, Context* context = nullptr,
                          const partition::Labels* initial = nullptr) {
    PaperRun run;
    run.mesh = work_mesh(shape);
    const runtime::RunControl calm(nullptr), control(context);
    if (options.feature_angle > 0) run.features = mesh::find_feature_edges(run.mesh, options.feature_angle, calm);
    const flow::FlowInput input{run.mesh, run.features ? &*run.features : nullptr, options, control};
    run.result = flow::run_paper(input, initial);
    return run;
}

inline void expect_valid(const PaperRun& run) {
    ASSERT_EQ(run.result.labels.size(), run.mesh.face_count());
    expect_partition(run.passage(), run.result.labels, run.result.regions);
}

/// Fraction of the area on which two partitions of one mesh agree, matching labels of `a` to those of `b` by overlap.
inline double agreement(const std::vector<std::int32_t>& a, const std::vector<std::int32_t>& b) {
    std::map<std::pair<std::int32_t, std::int32_t>, std::size_t> overlap;
    for (std::size_t f = 0; f < a.size(); ++f) ++overlap[{a[f], b[f]}];
    std::map<std::int32_t, std::size_t> best_of_a;
    std::map<std::int32_t, std::int32_t> match;
    for (const auto& [pair, count] : overlap) {
        if (count > best_of_a[pair.first]) {
            best_of_a[pair.first] = count;
            match[pair.first] = pair.second;
        }
    }
    std::size_t agreed = 0;
    for (std::size_t f = 0; f < a.size(); ++f) agreed += match[a[f]] == b[f] ? 1U : 0U;
    return static_cast<double>(agreed) / static_cast<double>(a.size());
}

}  // namespace quadseg::test
