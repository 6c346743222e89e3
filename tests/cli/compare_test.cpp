// quadseg compare: against distances that are known.
#include <quadseg/io.h>

#include "tests/cli/program.h"
#include "tools/cli/hausdorff.h"

#include <cmath>
#include <gtest/gtest.h>

namespace quadseg {
namespace {

using cli_test::run;

/// n × n squares of [0, size]², at height z.
Mesh square(std::uint32_t n, double size, double z) {
    Mesh mesh;
    for (std::uint32_t j = 0; j <= n; ++j) {
        for (std::uint32_t i = 0; i <= n; ++i) {
            mesh.positions.insert(mesh.positions.end(), {size * i / n, size * j / n, z});
        }
    }
    for (std::uint32_t j = 0; j < n; ++j) {
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t a = j * (n + 1) + i;
            mesh.triangles.insert(mesh.triangles.end(), {a, a + 1, a + n + 2, a, a + n + 2, a + n + 1});
        }
    }
    return mesh;
}

Mesh sphere(std::uint32_t n) {
    Mesh mesh;
    const double pi = std::acos(-1.0);
    for (std::uint32_t j = 0; j <= n; ++j) {
        for (std::uint32_t i = 0; i < 2 * n; ++i) {
            const double u = pi * i / n, v = pi * j / n;
            mesh.positions.insert(mesh.positions.end(),
                                  {std::sin(v) * std::cos(u), std::sin(v) * std::sin(u), std::cos(v)});
        }
    }
    for (std::uint32_t j = 0; j < n; ++j) {
        for (std::uint32_t i = 0; i < 2 * n; ++i) {
            const std::uint32_t k = (i + 1) % (2 * n), a = j * 2 * n, b = a + 2 * n;
            if (j + 1 < n) mesh.triangles.insert(mesh.triangles.end(), {a + i, b + i, b + k});
            if (j > 0) mesh.triangles.insert(mesh.triangles.end(), {a + i, b + k, a + k});
        }
    }
    return mesh;
}

cli::MeshDistance measure(const Mesh& a, const Mesh& b, std::size_t samples = 20000) {
    return cli::measure_mesh_distance(a.view(), b.view(), samples, Context());
}

TEST(MeshDistance, OfParallelSquaresIsTheirGap) {
    const cli::MeshDistance d = measure(square(7, 2, 0), square(3, 2, .25));
    for (const cli::OneSidedDistance& side : {d.forward, d.backward}) {
        EXPECT_NEAR(side.max, .25, 1e-12);
        EXPECT_NEAR(side.mean, .25, 1e-12);
        EXPECT_NEAR(side.rms, .25, 1e-12);
        EXPECT_NEAR(side.area, 4, 1e-12);
        EXPECT_NEAR(static_cast<double>(side.surface_samples), 20000, 1);
    }
    EXPECT_NEAR(d.diagonal, std::sqrt(8.0), 1e-12);
}

TEST(MeshDistance, IsOneSidedWhereOneSurfaceIsPartOfTheOther) {
    const cli::MeshDistance d = measure(square(4, 1, 0), square(8, 2, 0), 100000);
    EXPECT_LT(d.forward.max, 1e-12);
    EXPECT_NEAR(d.backward.max, std::sqrt(2.0), 1e-12) << "the far corner";
    EXPECT_NEAR(d.backward.farthest[0], 2, 1e-12);
    EXPECT_NEAR(d.backward.farthest[1], 2, 1e-12);
    // ∫ of the distance to the unit square over [0, 2]², over its area 4: two strips of ∫x = ½, and the corner's
    // ∫∫ √(x² + y²) = (√2 + asinh 1)/3. Of the squares: ⅓ twice, and ⅔.
    EXPECT_NEAR(d.backward.mean, (1 + (std::sqrt(2.0) + std::asinh(1.0)) / 3) / 4, 2e-3);
    EXPECT_NEAR(d.backward.rms, std::sqrt((2.0 / 3 + 2.0 / 3) / 4), 2e-3);
    EXPECT_EQ(d.max, d.backward.max);
}

TEST(MeshDistance, OfAMeshFromItselfIsNothing) {
    const Mesh mesh = sphere(20);
    const cli::MeshDistance d = measure(mesh, mesh);
    EXPECT_LT(d.max, 1e-14);
}

TEST(MeshDistance, SeesFarBelowFloatPrecision) {
    const cli::MeshDistance d = measure(square(5, 1, 0), square(5, 1, 1e-11));
    EXPECT_NEAR(d.max, 1e-11, 1e-15);
    EXPECT_NEAR(d.rms, 1e-11, 1e-15);
}

TEST(MeshDistance, IsThatOfBruteForce) {
    const Mesh a = sphere(12), b = sphere(7);
    const auto point = [](const Mesh& m, std::size_t v) {
        return std::array<double, 3>{m.positions[3 * v], m.positions[3 * v + 1], m.positions[3 * v + 2]};
    };
    double worst = 0;
    for (const std::uint32_t v : a.triangles) {
        double nearest = 1e9;
        const auto p = point(a, v);
        for (std::size_t f = 0; f < b.triangles.size(); f += 3) {
            const auto q = cli::nearest_on_triangle(p, point(b, b.triangles[f]), point(b, b.triangles[f + 1]),
                                                    point(b, b.triangles[f + 2]));
            nearest = std::min(nearest, std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]));
        }
        worst = std::max(worst, nearest);
    }
    EXPECT_NEAR(measure(a, b, 0).forward.max, worst, 1e-14);
}

TEST(MeshDistance, ScalesWithTheMeshesFarFromTheOriginToo) {
    Mesh a = sphere(16), b = sphere(9);
    const cli::MeshDistance here = measure(a, b);
    for (Mesh* m : {&a, &b}) {
        for (double& x : m->positions) x = 1e4 * x + 1e6;
    }
    const cli::MeshDistance there = measure(a, b);
    EXPECT_NEAR(there.max, 1e4 * here.max, 1e-6);
    EXPECT_NEAR(there.rms, 1e4 * here.rms, 1e-6);
}

TEST(NearestOnTriangle, IsNearerThanAnyOtherPointOfIt) {
    const std::array<double, 3> a{0, 0, 0}, b{1, .2, 0}, c{.3, .9, .4};
    std::uint64_t state = 1;
    const auto random = [&] {
        state = state * 6364136223846793005ULL + 1442695040888963407ULL;
        return static_cast<double>(state >> 33) * 0x1p-31 * 4 - 2;
    };
    for (int i = 0; i < 300; ++i) {
        const std::array<double, 3> p{random(), random(), random()};
        const auto q = cli::nearest_on_triangle(p, a, b, c);
        const double reached = std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
        for (int j = 0; j <= 20; ++j) {
            for (int k = 0; j + k <= 20; ++k) {
                double sum = 0;
                for (std::size_t m = 0; m < 3; ++m) {
                    const double x = a[m] + (b[m] - a[m]) * j / 20 + (c[m] - a[m]) * k / 20 - p[m];
                    sum += x * x;
                }
                EXPECT_LE(reached, std::sqrt(sum) + 1e-12);
            }
        }
    }
}

TEST(Compare, PrintsJsonAndText) {
    const cli_test::TemporaryFolder folder;
    const std::string a = folder / "a.ply", b = folder / "b.off";
    write_mesh(a, square(6, 2, 0).view());
    write_mesh(b, square(3, 2, .5).view());
    const auto json = run("compare " + a + " " + b + " --samples 5000 --json");
    ASSERT_EQ(json.code, 0) << json.output;
    const nlohmann::json report = nlohmann::json::parse(json.output);
    EXPECT_NEAR(report["symmetric"]["max"], .5, 1e-9);
    EXPECT_NEAR(report["symmetric"]["relative"]["rms"], .5 / std::sqrt(8.0), 1e-9);
    EXPECT_NEAR(report["a_to_b"]["samples_per_area"], 1250, 1);
    EXPECT_EQ(report["b_to_a"]["vertex_samples"], 16);
    const auto text = run("compare " + a + " " + b + " --samples 5000");
    EXPECT_EQ(text.code, 0);
    EXPECT_NE(text.output.find("symmetric"), std::string::npos);
    // The same bytes at any thread count.
    const auto one = run("compare " + a + " " + b + " --samples 5000 --threads 1 --json");
    EXPECT_EQ(one.output, json.output);
}

TEST(Compare, RefusesWhatItCannotRead) {
    const cli_test::TemporaryFolder folder;
    EXPECT_EQ(run("compare " + (folder / "none.ply") + " " + (folder / "none.ply")).code, 3);
    EXPECT_EQ(run("compare").code, 2);
}

}  // namespace
}  // namespace quadseg
