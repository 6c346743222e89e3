#include <quadseg/context.h>
#include <quadseg/error.h>
#include <quadseg/options.h>
#include <quadseg/segmentation.h>

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <set>
#include <string>

namespace quadseg {
namespace {

TEST(Options, DefaultsAreFine) {
    EXPECT_TRUE(validate(Options{}).empty());
    Options paper;
    paper.preset = Preset::paper;
    paper.regions = 22;
    paper.feature_angle = 30;
    EXPECT_TRUE(validate(paper).empty());
}

TEST(Options, EveryBadValueIsNamed) {
    const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
    const std::pair<const char*, std::function<void(Options&)>> bad[] = {
        {"preset", [](Options& o) { o.preset = static_cast<Preset>(7); }},
        {"method", [](Options& o) { o.method = static_cast<Method>(-1); }},
        {"tolerance", [](Options& o) { o.tolerance = -1e-9; }},
        {"tolerance", [=](Options& o) { o.tolerance = nan; }},
        {"detail", [](Options& o) { o.detail = 0; }},
        {"detail", [=](Options& o) { o.detail = infinity; }},
        {"feature_angle", [](Options& o) { o.feature_angle = 180.5; }},
        {"feature_angle", [=](Options& o) { o.feature_angle = nan; }},
        {"weight", [](Options& o) { o.weight = -0.5; }},
        {"weight", [=](Options& o) { o.weight = infinity; }},
        {"coarse", [](Options& o) { o.coarse = -2; }},
        {"paper.lloyd_iterations", [](Options& o) { o.paper.lloyd_iterations = 0; }},
        {"paper.convergence", [=](Options& o) { o.paper.convergence = nan; }},
        {"paper.plane_tolerance", [](Options& o) { o.paper.plane_tolerance = -1; }},
        {"paper.merge_tolerance", [](Options& o) { o.paper.merge_tolerance = -1; }},
        {"paper.teleportations", [](Options& o) { o.paper.teleportations = -1; }},
        {"paper.energy_threshold", [](Options& o) { o.paper.energy_threshold = 0; }},
        {"paper.maximum_regions", [](Options& o) { o.paper.maximum_regions = 0; }},
        {"smoothing.band", [](Options& o) { o.smoothing.band = 0; }},
        {"smoothing.lambda", [](Options& o) { o.smoothing.lambda = -1; }},
    };
    Options all;
    std::set<std::string> names;
    for (const auto& [name, spoil] : bad) {
        Options o;
        spoil(o);
        const auto problems = validate(o);
        ASSERT_EQ(problems.size(), 1U) << name;
        EXPECT_TRUE(problems[0].starts_with(std::string(name) + ":")) << problems[0];
        spoil(all);
        names.insert(name);
    }
    EXPECT_EQ(validate(all).size(), names.size()) << "all problems at once";
}

template <class Enum>
std::set<std::string> names_of(int count) {
    std::set<std::string> names;
    for (int i = 0; i < count; ++i) names.insert(to_string(static_cast<Enum>(i)));
    return names;
}

TEST(Names, AreDistinctAndThoseOfTheContract) {
    EXPECT_EQ(names_of<Phase>(6), (std::set<std::string>{"read", "prepare", "coarse", "fine", "post", "write"}));
    EXPECT_EQ(names_of<ErrorCode>(9).size(), 9U);
    EXPECT_EQ(names_of<StopReason>(6).size(), 6U);
    EXPECT_EQ(names_of<Regularity::Kind>(6).size(), 6U);
    const auto types = names_of<SurfaceType>(static_cast<int>(surface_type_count));
    EXPECT_EQ(types.size(), surface_type_count);
    for (const char* name : {"plane", "torus", "hyperboloid_two_sheets", "parabolic_cylinder", "quadric"}) {
        EXPECT_TRUE(types.contains(name)) << name;
    }
    EXPECT_STREQ(to_string(Preset::standard), "default");
    EXPECT_STREQ(to_string(static_cast<SurfaceType>(200)), "unknown");
}

TEST(Names, ComeBack) {
    for (int i = 0; i < 7; ++i) {
        Method m = Method::quadric;
        EXPECT_TRUE(from_string(to_string(static_cast<Method>(i)), m));
        EXPECT_EQ(m, static_cast<Method>(i));
    }
    Preset p = Preset::paper;
    EXPECT_TRUE(from_string("default", p));
    EXPECT_EQ(p, Preset::standard);
    EXPECT_FALSE(from_string("standard", p));
    EXPECT_FALSE(from_string("", p));
    EXPECT_EQ(p, Preset::standard);
}

}  // namespace
}  // namespace quadseg
