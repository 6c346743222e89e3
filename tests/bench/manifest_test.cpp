#include "bench/tables/manifest.h"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

namespace quadseg::bench {
namespace {

nlohmann::json small() {
    return nlohmann::json::parse(R"({
        "title": "t",
        "meshes": {"plate": {"generator": "plate"}, "part": {"file": "part.off", "stands_for": "Part"}},
        "tables": [{"name": "a", "jobs": [
            {"mesh": "plate", "faces": [1000, 2000], "preset": ["default", "paper"], "regions": [0, 7], "threads": [1, 2]},
            {"mesh": "part", "arguments": ["--smooth"]}]}]})");
}

TEST(Manifest, ListsAreMultipliedOut) {
    const Manifest manifest = parse_manifest(small());
    const std::vector<Job>& jobs = manifest.tables.at(0).jobs;
    ASSERT_EQ(jobs.size(), 2U * 2 * 2 * 2 + 1);
    EXPECT_EQ(jobs[0].mesh, "plate-1000");
    EXPECT_EQ(jobs[0].regions, "");  // 0: found by itself
    EXPECT_EQ(jobs[15].mesh, "plate-2000");
    EXPECT_EQ(jobs[15].preset, "paper");
    EXPECT_EQ(jobs[15].regions, "7");
    EXPECT_EQ(jobs[15].threads, 2);
    EXPECT_EQ(manifest.meshes.at("plate-2000").faces, 2000U);
    EXPECT_EQ(jobs[16].arguments, std::vector<std::string>{"--smooth"});
    EXPECT_EQ(manifest.meshes.at("part").stands_for, "Part");
}

TEST(Manifest, MistakesAreNamed) {
    const auto refused = [](nlohmann::json json, const std::string& word) {
        try {
            parse_manifest(json);
        } catch (const std::invalid_argument& error) {
            return std::string(error.what()).find(word) != std::string::npos;
        }
        return false;
    };
    nlohmann::json misspelt = small();
    misspelt["tables"][0]["jobs"][0]["thread"] = 2;
    EXPECT_TRUE(refused(misspelt, "'thread'"));
    nlohmann::json unknown = small();
    unknown["tables"][0]["jobs"][0]["mesh"] = "nobody";
    EXPECT_TRUE(refused(unknown, "nobody"));
    nlohmann::json neither = small();
    neither["meshes"]["plate"].erase("generator");
    EXPECT_TRUE(refused(neither, "plate"));
    nlohmann::json sized_file = small();
    sized_file["tables"][0]["jobs"][1]["faces"] = 1000;
    EXPECT_TRUE(refused(sized_file, "part"));
    EXPECT_TRUE(refused(nlohmann::json::object(), "meshes"));
}

TEST(Manifest, OursAreAllReadable) {
    std::size_t count = 0;
    for (const auto& file : std::filesystem::directory_iterator(QUADSEG_SOURCE_DIR "/bench/tables/manifests")) {
        ++count;
        EXPECT_NO_THROW(parse_manifest(nlohmann::json::parse(std::ifstream(file.path())))) << file.path();
    }
    EXPECT_GE(count, 4U);
}

TEST(Manifest, ThePapersTablesHoldThePapersFigures) {
    const Manifest manifest =
        parse_manifest(nlohmann::json::parse(std::ifstream(QUADSEG_SOURCE_DIR "/bench/tables/manifests/paper.json")));
    const Table &one = manifest.tables.at(0), &two = manifest.tables.at(1);
    ASSERT_EQ(one.comparison.size(), 4U);
    ASSERT_EQ(two.comparison.size(), 6U);
    EXPECT_EQ(one.jobs.size(), 8U);
    EXPECT_EQ(two.jobs.size(), 12U);
    double sums[4] = {0, 0, 0, 0};
    for (std::size_t v = 0; v < 2; ++v) {
        for (const ComparisonRow& row : one.comparison) sums[v] += row.paper_seconds[v];
        for (const ComparisonRow& row : two.comparison) sums[2 + v] += row.paper_seconds[v];
    }
    EXPECT_DOUBLE_EQ(sums[0], 12 + 19 + 17 + 25);
    EXPECT_DOUBLE_EQ(sums[1], 3 + 4.7 + 7.8 + 5);
    EXPECT_DOUBLE_EQ(sums[2], 3 + 4.7 + 16 + 19 + 27 + 17);
    EXPECT_DOUBLE_EQ(sums[3], 1.8 + 2.6 + 7 + 4.9 + 8.2 + 6.1);
}

}  // namespace
}  // namespace quadseg::bench
