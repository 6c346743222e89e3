#include "partition/merge_candidates.h"

#include "box.h"

#include <atomic>
#include <gtest/gtest.h>

namespace quadseg::test {
namespace {

const runtime::RunControl never(nullptr);

/// A flat plate in three stripes and one bent up at its end.
class Stripes : public ::testing::Test {
  protected:
    Stripes() {
        Shape s = grid(8, 2);
        for (std::size_t v = 0; v < s.positions.size(); v += 3) {
            if (s.positions[v] > 6) s.positions[v + 2] = 2 * (s.positions[v] - 6);
        }
        mesh_ = work_mesh(s);
        labels_.resize(mesh_.face_count());
        for (std::size_t f = 0; f < labels_.size(); ++f) {
            labels_[f] = static_cast<std::int32_t>(mesh_.frame.to_input(mesh_.centroid(f)).x / 2);
        }
        lists_ = partition::region_faces(labels_, 4);
        fit_ = [this](const quadric::TriangleSoup& soup) {
            ++fits_;
            return quadric::fit_region(soup, {});
        };
        for (std::size_t r = 0; r < 4; ++r) {
            regions_.push_back({{lists_.face.data() + lists_.begin[r], lists_.size(r)}, 0, r + 1});
        }
        pairs_ = partition::region_pairs({&mesh_, nullptr, {}}, labels_, never);
    }
    mesh::WorkMesh mesh_;
    partition::Labels labels_;
    partition::RegionFaces lists_;
    partition::FitFunction fit_;
    std::vector<partition::MergeableRegion> regions_;
    std::vector<partition::RegionPair> pairs_;
    std::atomic<int> fits_{0};
};

TEST_F(Stripes, CoplanarPairsComeFirstAndCostNothing) {
    partition::MergeCandidates candidates;
    const auto found = candidates.evaluate(mesh_, pairs_, regions_, fit_, never);
    ASSERT_EQ(found.size(), 3U);
    EXPECT_LT(found[0].increase, 1e-12);
    EXPECT_LT(found[1].increase, 1e-12);
    EXPECT_TRUE(found[0].valid && found[1].valid);
    // The crease: no single quadric is both cheap and valid.
    EXPECT_EQ(found[2].pair.a, 2U);
    EXPECT_EQ(found[2].pair.b, 3U);
    EXPECT_TRUE(!found[2].valid || found[2].increase > 1e-3);
}

TEST_F(Stripes, OnlyPairsOfChangedRegionsAreFittedAgain) {
    partition::MergeCandidates candidates;
    const auto first = candidates.evaluate(mesh_, pairs_, regions_, fit_, never);
    EXPECT_EQ(fits_, 3);
    const auto second = candidates.evaluate(mesh_, pairs_, regions_, fit_, never);
    EXPECT_EQ(fits_, 3);
    ASSERT_EQ(first.size(), second.size());
    for (std::size_t i = 0; i < first.size(); ++i) {
        EXPECT_EQ(first[i].increase, second[i].increase);
        EXPECT_EQ(first[i].valid, second[i].valid);
    }
    regions_[0].stamp = 99;
    candidates.evaluate(mesh_, pairs_, regions_, fit_, never);
    EXPECT_EQ(fits_, 4);  // region 0 has one neighbour
}

TEST_F(Stripes, IncreaseIsSigned) {
    regions_[0].energy = 1;
    partition::MergeCandidates candidates;
    EXPECT_LT(candidates.evaluate(mesh_, pairs_, regions_, fit_, never)[0].increase, -0.99);
}

TEST_F(Stripes, FailedFitsAreNoCandidates) {
    const partition::FitFunction broken = [](const quadric::TriangleSoup&) {
        quadric::RegionFit fit;
        fit.total = std::nan("");
        return fit;
    };
    partition::MergeCandidates candidates;
    for (const auto& c : candidates.evaluate(mesh_, pairs_, regions_, broken, never)) EXPECT_FALSE(c.valid);
}

TEST_F(Stripes, Cancels) {
    Context context;
    context.cancel();
    partition::MergeCandidates candidates;
    EXPECT_THROW(candidates.evaluate(mesh_, pairs_, regions_, fit_, runtime::RunControl(&context)), runtime::Stopped);
}

}  // namespace
}  // namespace quadseg::test
