#include "bench/tables/report.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace quadseg::bench {
namespace {

Measured measured(const std::string& mesh, std::size_t faces, double seconds, const std::string& variant = {}) {
    Measured m;
    m.job.mesh = mesh;
    m.job.threads = 1;
    m.job.variant = variant;
    m.faces = faces;
    m.regions = 12;
    m.cpu = {seconds, 2 * seconds, 3 * seconds};
    m.wall = {seconds, seconds, 5 * seconds};
    m.peak = {500.0 * static_cast<double>(faces)};
    return m;
}

Manifest manifest() {
    Manifest result;
    result.meshes["a"].file = "a.off";
    result.meshes["b"].generator = "plate";
    result.meshes["b"].stands_for = "Tesa";
    return result;
}

TEST(Report, ScalingIsFittedToMedians) {
    const std::vector<Scaling> laws = scalings({measured("a", 1000, 0.1), measured("a", 100000, 20)});
    ASSERT_EQ(laws.size(), 1U);
    EXPECT_NEAR(laws[0].cpu_exponent, std::log10(200.0) / 2, 1e-12);
    EXPECT_DOUBLE_EQ(laws[0].bytes_a_face, 500);
}

TEST(Report, CsvHasAColumnForEachTitle) {
    Table table;
    table.name = "t, with \"quotes\"";
    const std::string row = csv(manifest(), table, {measured("a", 1000, 0.1)});
    EXPECT_NE(row.find("\"t, with \"\"quotes\"\"\""), std::string::npos);
    const std::string title = csv_header();
    // One comma of the row is inside quotes.
    EXPECT_EQ(std::count(title.begin(), title.end(), ',') + 1, std::count(row.begin(), row.end(), ','));
    EXPECT_NE(row.find(",0.2,0.1,0.3,"), std::string::npos);  // CPU: median, min, max
}

TEST(Report, ComparisonsNameStandInsAndGiveBothRatios) {
    Table table;
    table.name = "Table 1";
    table.variants = {"without", "with"};
    table.comparison.push_back({"Tesa", "b", 12, {20, 4}});
    const std::string text =
        markdown(manifest(), table, {measured("b", 22000, 0.5, "without"), measured("b", 22000, 0.1, "with")});
    EXPECT_NE(text.find("**stand-in** for Tesa"), std::string::npos);
    EXPECT_NE(text.find("| 20 | 4 | 5 | 1 | 0.2 | 5 | 20 | 20 |"), std::string::npos) << text;
}

TEST(Report, AJobThatFailedHasNoTime) {
    Measured failed;
    failed.job.mesh = "a";
    failed.exit_code = 139;
    Table table;
    const std::string text = markdown(manifest(), table, {failed});
    EXPECT_NE(text.find("exit code 139"), std::string::npos);
    failed.timed_out = true;
    EXPECT_NE(markdown(manifest(), table, {failed}).find("out of time"), std::string::npos);
    EXPECT_TRUE(scalings({failed}).empty());
}

}  // namespace
}  // namespace quadseg::bench
