// Any arrays: a sound result or an Error that says what is wrong, soon.
#include <quadseg/error.h>
#include <quadseg/io.h>
#include <quadseg/segmentation.h>
#include <quadseg/segmenter.h>

#include "tests/hostile/nasty_shapes.h"
#include "tests/pipeline/result_checks.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <functional>
#include <gtest/gtest.h>

namespace quadseg::test {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double most_seconds = 10;
/// Large meshes take up to 7 s on a quiet machine; a step of quadratic time takes minutes.
constexpr double most_seconds_large = 40;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

struct NamedOptions {
    const char* name;
    std::function<void(Options&)> set;
};

const std::vector<NamedOptions>& many_options() {
    static const std::vector<NamedOptions> all = {
        {"default", [](Options&) {}},
        {"five_regions", [](Options& o) { o.regions = 5; }},
        {"more_regions_than_faces", [](Options& o) { o.regions = 1000000; }},
        {"one_region", [](Options& o) { o.regions = 1; }},
        {"tolerance", [](Options& o) { o.tolerance = 1e-3; }},
        {"features", [](Options& o) { o.feature_angle = 30; }},
        {"post", [](Options& o) { o.smooth = o.project = o.project_joint = true; }},
        {"paper", [](Options& o) { o.preset = Preset::paper; }},
        {"paper_seven",
         [](Options& o) {
             o.preset = Preset::paper;
             o.regions = 7;
             o.feature_angle = 30;
         }},
        {"paper_random_seeds",
         [](Options& o) {
             o.preset = Preset::paper;
             o.regions = 12;
             o.paper.initial_regions = 0;
             o.smooth = o.project = true;
         }},
        {"paper_coarse",
         [](Options& o) {
             o.preset = Preset::paper;
             o.regions = 5;
             o.coarse = 200;
         }},
        {"paper_planes",
         [](Options& o) {
             o.preset = Preset::paper;
             o.method = Method::vsa_l21;
             o.regions = 6;
         }},
    };
    return all;
}

/// Empty when the job ends as it must.
std::string verdict(const MeshView& mesh, const Options& options, double limit = most_seconds) {
    const auto start = Clock::now();
    const std::clock_t cpu = std::clock();
    std::string wrong;
    try {
        const Segmentation s = segment(mesh, options);
        wrong = broken_rule(mesh, s);
        if (s.partial) wrong += "partial without a reason; ";
        if (options.regions > 0 && s.regions.size() > std::max(options.regions, s.input.components) + 5 &&
            options.feature_angle <= 0 && mesh.polygons.empty()) {
            wrong += std::to_string(s.regions.size()) + " regions; ";
        }
    } catch (const Error& error) {
        if (error.code() == ErrorCode::internal || std::string(error.what()).empty()) wrong = error.what();
    }
    // The machine may be shared: what others take does not count.
    const double used = static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC;
    const double seconds = std::min(seconds_since(start), used);
    if (seconds > limit) wrong += std::to_string(seconds) + " s; ";
    return wrong;
}

class Nasty : public testing::TestWithParam<NamedShape> {};

TEST_P(Nasty, EndsWellUnderAllOptions) {
    for (const NamedOptions& chosen : many_options()) {
        Options options;
        chosen.set(options);
        EXPECT_EQ(verdict(GetParam().shape.view(), options), "") << chosen.name;
    }
}

TEST_P(Nasty, EndsWellStepByStep) {
    const MeshView mesh = GetParam().shape.view();
    Options options;
    options.preset = Preset::paper;
    try {
        Segmenter s(mesh, options);
        std::size_t undone = 0;
        const auto attempt = [&](const std::function<void()>& operation) {
            try {
                operation();
            } catch (const Error& error) {
                EXPECT_EQ(error.code(), ErrorCode::invalid_argument) << error.what();
            }
        };
        for (int i = 0; i < 4; ++i) attempt([&] { s.insert(); });
        attempt([&] { s.insert(mesh.face_count() / 2); });
        attempt([&] { s.merge(0, 1); });
        attempt([&] { s.relax(3); });
        std::vector<std::int32_t> labels(mesh.face_count());
        for (std::size_t f = 0; f < labels.size(); ++f) labels[f] = f % 3 == 0 ? -2147483647 : static_cast<int>(f % 5);
        attempt([&] { s.set_labels(labels); });
        EXPECT_EQ(broken_rule(mesh, s.result()), "");
        while (s.undo()) ++undone;
        EXPECT_GE(undone, 1U);
        EXPECT_EQ(s.region_count(), s.input().components);
        EXPECT_EQ(broken_rule(mesh, s.result()), "");
    } catch (const Error& error) {
        EXPECT_TRUE(error.code() == ErrorCode::empty_mesh || error.code() == ErrorCode::invalid_mesh) << error.what();
    }
}

INSTANTIATE_TEST_SUITE_P(Shapes, Nasty, testing::ValuesIn(nasty_shapes()),
                         [](const auto& one) { return one.param.name; });

ErrorCode code_of(const MeshView& mesh) {
    try {
        segment(mesh);
    } catch (const Error& error) {
        return error.code();
    }
    ADD_FAILURE() << "no error";
    return ErrorCode::internal;
}

TEST(Refused, NoFaceWithAnArea) {
    Shape none, degenerate;
    EXPECT_EQ(code_of(none.view()), ErrorCode::empty_mesh);
    for (int i = 0; i < 4; ++i) degenerate.vertex(i, 0, 0);
    degenerate.face(0, 0, 1);
    degenerate.face(2, 2, 2);
    EXPECT_EQ(code_of(degenerate.view()), ErrorCode::empty_mesh);
    degenerate.triangles.clear();
    degenerate.face(0, 1, 2);
    degenerate.face(1, 2, 3);
    EXPECT_EQ(code_of(degenerate.view()), ErrorCode::empty_mesh);
}

TEST(Refused, CoordinatesThatAreNoNumbers) {
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                             -std::numeric_limits<double>::infinity()}) {
        Shape shape = box(2);
        shape.positions[10] = bad;
        EXPECT_EQ(code_of(shape.view()), ErrorCode::invalid_mesh);
    }
    Shape shape = box(2);
    shape.positions[0] = -1.7e308;
    shape.positions[3] = 1.7e308;
    EXPECT_EQ(code_of(shape.view()), ErrorCode::invalid_mesh);
}

TEST(Refused, IndicesOutOfRange) {
    Shape shape = box(2);
    shape.triangles[7] = 1000;
    EXPECT_EQ(code_of(shape.view()), ErrorCode::invalid_mesh);
    shape.triangles[7] = 0xffffffffU;
    EXPECT_EQ(code_of(shape.view()), ErrorCode::invalid_mesh);
}

TEST(Refused, ArraysOfTheWrongShape) {
    Shape shape = box(2);
    MeshView view = shape.view();
    view.positions = view.positions.first(view.positions.size() - 1);
    EXPECT_EQ(code_of(view), ErrorCode::invalid_argument);
    view = shape.view();
    view.triangles = view.triangles.first(view.triangles.size() - 1);
    EXPECT_EQ(code_of(view), ErrorCode::invalid_argument);
    const std::vector<std::uint32_t> polygons(3);
    view = shape.view();
    view.polygons = polygons;
    EXPECT_EQ(code_of(view), ErrorCode::invalid_argument);
}

class Large : public testing::TestWithParam<NamedShape> {};

TEST_P(Large, EndsSoon) {
    Options regions, paper;
    regions.regions = 4;
    paper.preset = Preset::paper;
    paper.regions = 4;
    for (const Options& options : {Options{}, regions, paper}) {
        EXPECT_EQ(verdict(GetParam().shape.view(), options, most_seconds_large), "")
            << to_string(options.preset) << ", " << options.regions << " regions";
    }
}

INSTANTIATE_TEST_SUITE_P(Shapes, Large,
                         testing::Values(NamedShape{"cone_of_100000_faces", fan(100000, 0.5)},
                                         NamedShape{"disc_of_100000_faces", fan(100000, 0)},
                                         NamedShape{"needles_30000", needles(30000)},
                                         NamedShape{"book_of_20000_pages", book(20000)},
                                         NamedShape{"soup_20000", random_soup(20000, 0, 4)},
                                         NamedShape{"tangle_20000", random_soup(20000, 3000, 5)}),
                         [](const auto& one) { return one.param.name; });

/// Long: QUADSEG_LONG_TESTS=1.
TEST(LargeLong, FanOfAMillion) {
    if (std::getenv("QUADSEG_LONG_TESTS") == nullptr) GTEST_SKIP() << "set QUADSEG_LONG_TESTS to run it";
    EXPECT_EQ(verdict(fan(1000000, 0.5).view(), {}), "");
    Options options;
    options.regions = 4;
    EXPECT_EQ(verdict(fan(1000000, 0.5).view(), options), "");
}

std::vector<std::string> shared_files(const char* folder) {
    std::vector<std::string> files;
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
        const std::string extension = entry.path().extension().string();
        if (extension == ".off" || extension == ".obj" || extension == ".ply" || extension == ".stl") {
            files.push_back(entry.path().string());
        }
    }
    std::sort(files.begin(), files.end());
    return files;
}

TEST(SharedNasty, EveryMeshEndsWell) {
    const auto files = shared_files(QUADSEG_SHARED_DIR "/meshes/nasty");
    if (files.empty()) GTEST_SKIP() << "no shared meshes here";
    for (const std::string& file : files) {
        SCOPED_TRACE(file);
        Mesh mesh;
        try {
            mesh = read_mesh(file);
        } catch (const Error& error) {
            EXPECT_NE(error.code(), ErrorCode::internal) << error.what();
            continue;
        }
        Options features;
        features.feature_angle = 30;
        features.regions = 30;
        EXPECT_EQ(verdict(mesh.view(), {}), "");
        EXPECT_EQ(verdict(mesh.view(), features), "");
        if (mesh.view().face_count() < 12000) {
            Options paper;
            paper.preset = Preset::paper;
            paper.regions = 10;
            EXPECT_EQ(verdict(mesh.view(), paper), "");
        }
    }
}

}  // namespace
}  // namespace quadseg::test
