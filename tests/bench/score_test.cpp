#include "bench/support/score.h"

#include "bench/rivals/verdict.h"
#include "datasets/generate.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <limits>
#include <numeric>
#include <set>

namespace quadseg::bench {
namespace {

/// A plate without tori: the truth is made of planes and quadrics only.
datasets::Generated quadrics() {
    return datasets::generate("quadrics", 5000);
}

TEST(Score, TheTruthHasNextToNoEnergyAndItsOwnNumberOfPieces) {
    const datasets::Generated part = quadrics();
    const Score truth = score(part.mesh.view(), part.truth);
    EXPECT_EQ(truth.regions, part.surfaces.size());
    EXPECT_EQ(truth.pieces, part.surfaces.size());
    EXPECT_EQ(truth.unlabelled_area, 0);
    EXPECT_LT(truth.rms, 1e-3);
    const Score blind = score(part.mesh.view(), blind_partition(part.mesh.view(), truth.regions));
    EXPECT_LT(10 * truth.rms, blind.rms);
    EXPECT_LT(10 * truth.energy_density, blind.energy_density);
}

TEST(Score, UnlabelledFacesCountAsAreaAndAreNotFitted) {
    const datasets::Generated part = quadrics();
    std::vector<std::int32_t> labels = part.truth;
    double left_out = 0, area = 0;
    for (std::size_t s = 0; s < part.surfaces.size(); ++s) {
        area += part.surfaces[s].area;
        if (s < 5) left_out += part.surfaces[s].area;
    }
    for (std::int32_t& label : labels) label = label < 5 ? -1 : label;
    const Score truth = score(part.mesh.view(), part.truth), rest = score(part.mesh.view(), labels);
    EXPECT_EQ(rest.regions, truth.regions - 5);
    EXPECT_EQ(rest.pieces, truth.pieces - 5);
    EXPECT_NEAR(rest.unlabelled_area, left_out / area, 1e-3);
    EXPECT_LE(rest.energy, truth.energy * (1 + 1e-9));
}

TEST(Score, NothingLabelledIsNoRegion) {
    const datasets::Generated part = quadrics();
    const Score nothing = score(part.mesh.view(), std::vector<std::int32_t>(part.truth.size(), -1));
    EXPECT_EQ(nothing.regions, 0U);
    EXPECT_EQ(nothing.pieces, 0U);
    EXPECT_NEAR(nothing.unlabelled_area, 1, 1e-12);
    EXPECT_EQ(nothing.energy, 0);
}

TEST(Score, LabelsDontDependOnTheirNumbers) {
    const datasets::Generated part = quadrics();
    std::vector<std::int32_t> labels = part.truth;
    for (std::int32_t& label : labels) label = 1000 - 7 * label;
    EXPECT_DOUBLE_EQ(score(part.mesh.view(), labels).rms, score(part.mesh.view(), part.truth).rms);
}

TEST(Score, AWrongNumberOfLabelsIsRefused) {
    const datasets::Generated part = quadrics();
    EXPECT_THROW(score(part.mesh.view(), std::vector<std::int32_t>(10, 0)), std::invalid_argument);
}

TEST(BlindPartition, IsCompleteConnectedAndOfTheNumberAsked) {
    const datasets::Generated part = quadrics();
    const std::vector<std::int32_t> labels = blind_partition(part.mesh.view(), 20);
    const Score blind = score(part.mesh.view(), labels);
    EXPECT_EQ(blind.regions, 20U);
    EXPECT_EQ(blind.pieces, 20U);
    EXPECT_EQ(blind.unlabelled_area, 0);
}

class Verdict : public ::testing::Test {
  protected:
    std::vector<std::string> judge(const std::vector<std::int32_t>& labels, const Traits& traits, std::size_t regions) {
        const Score result = score(part_.mesh.view(), labels);
        return faults(traits, regions, result,
                      score(part_.mesh.view(), blind_partition(part_.mesh.view(), result.regions)));
    }
    const datasets::Generated part_ = quadrics();
    const Traits exact_{true, true, false};
};

TEST_F(Verdict, TheTruthIsSound) {
    EXPECT_TRUE(judge(part_.truth, exact_, part_.surfaces.size()).empty());
}

/// What an adapter does that writes its labels in the rival's order of faces.
TEST_F(Verdict, LabelsOfOtherFacesAreNot) {
    std::vector<std::int32_t> labels = part_.truth;
    std::uint64_t state = 1;
    for (std::size_t i = labels.size(); i > 1; --i) {
        state = state * 6364136223846793005ULL + 1442695040888963407ULL;
        std::swap(labels[i - 1], labels[(state >> 33) % i]);
    }
    EXPECT_FALSE(judge(labels, exact_, part_.surfaces.size()).empty());
    std::vector<std::int32_t> backwards(part_.truth.rbegin(), part_.truth.rend());
    EXPECT_FALSE(judge(backwards, exact_, part_.surfaces.size()).empty());
}

TEST_F(Verdict, AnotherNumberOfRegionsThanAskedIsNot) {
    EXPECT_FALSE(judge(part_.truth, exact_, 2 * part_.surfaces.size()).empty());
    EXPECT_TRUE(judge(part_.truth, {false, true, false}, 2 * part_.surfaces.size()).empty());
}

TEST_F(Verdict, HolesAreNotWhereAllFacesArePromised) {
    std::vector<std::int32_t> labels = part_.truth;
    std::replace(labels.begin(), labels.end(), 0, -1);
    EXPECT_FALSE(judge(labels, exact_, part_.surfaces.size()).empty());
    EXPECT_TRUE(judge(labels, {true, false, false}, part_.surfaces.size()).empty());
}

TEST_F(Verdict, NothingIsNot) {
    EXPECT_FALSE(judge(std::vector<std::int32_t>(part_.truth.size(), -1), {false, false, false}, 5).empty());
}

TEST(VerdictOnNumbers, NotANumberIsNot) {
    Score score, blind;
    score.regions = 1;
    score.energy_density = 1;
    blind.energy_density = 2;
    blind.rms = 1;
    const Traits traits{false, false, false};
    EXPECT_TRUE(faults(traits, 0, score, blind).empty());
    score.energy_density = 3;  // one of the two is enough
    EXPECT_TRUE(faults(traits, 0, score, blind).empty());
    score.rms = 1;
    EXPECT_FALSE(faults(traits, 0, score, blind).empty());
    score.energy_density = 1;
    score.rms = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(faults(traits, 0, score, blind).empty());
}

}  // namespace
}  // namespace quadseg::bench
