#include "exact/tolerances.h"

#include "tests/mesh/shapes.h"

#include <cmath>
#include <gtest/gtest.h>

namespace quadseg::exact {
namespace {

TEST(CoordinatePrecision, IsTheRoundingOfTheFile) {
    test::Shape shape = test::bumpy_grid(20);
    for (double& x : shape.positions) x += 0.123456789012345;
    const auto precision = [](const test::Shape& s) {
        const runtime::RunControl control(nullptr);
        const mesh::WorkMesh mesh = mesh::build_work_mesh(s.view(), control);
        return coordinate_precision(mesh) / mesh.frame.scale;
    };
    EXPECT_LT(precision(shape), 1e-12);
    test::Shape decimals = shape;
    for (double& x : decimals.positions) x = std::round(x * 1e4) / 1e4;
    EXPECT_NEAR(precision(decimals), 1e-4 / std::sqrt(12.0), 1e-6);
    test::Shape floats = shape;
    for (double& x : floats.positions) x = static_cast<double>(static_cast<float>(x));
    EXPECT_GT(precision(floats), 1e-9);
    EXPECT_LT(precision(floats), 1e-6);
}

}  // namespace
}  // namespace quadseg::exact
