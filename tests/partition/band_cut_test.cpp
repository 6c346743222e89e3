#include "partition/band_cut.h"

#include <gtest/gtest.h>
#include <limits>

namespace quadseg {
namespace {

using partition::BandCut;

class Random {  // splitmix64
  public:
    explicit Random(std::uint64_t seed) : state_(seed) {}
    double uniform() {
        state_ += 0x9e3779b97f4a7c15ULL;
        std::uint64_t z = state_;
        z = (z ^ z >> 30U) * 0xbf58476d1ce4e5b9ULL;
        z = (z ^ z >> 27U) * 0x94d049bb133111ebULL;
        return static_cast<double>((z ^ z >> 31U) >> 11U) * 0x1p-53;
    }

  private:
    std::uint64_t state_;
};

struct Edge {
    std::size_t i, slot_i, j, slot_j;
    double price;
};

TEST(BandCut, IsTheCheapestOfAllCuts) {
    Random random(3);
    for (int trial = 0; trial < 300; ++trial) {
        const std::size_t n = 2 + static_cast<std::size_t>(10 * random.uniform());
        std::vector<double> first(n), second(n);
        std::vector<std::size_t> used(n, 0);
        std::vector<Edge> edges;
        BandCut cut;
        for (std::size_t i = 0; i < n; ++i) {
            first[i] = random.uniform();
            second[i] = random.uniform();
            cut.add_node(first[i], second[i]);
        }
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = i + 1; j < n; ++j) {
                if (used[i] == 3 || used[j] == 3 || random.uniform() > 0.6) continue;
                edges.push_back({i, used[i]++, j, used[j]++, random.uniform()});
                cut.add_edge(i, edges.back().slot_i, j, edges.back().slot_j, edges.back().price);
            }
        }
        const auto cost = [&](const auto& side) {
            double sum = 0;
            for (std::size_t i = 0; i < n; ++i) sum += side(i) == 0 ? first[i] : second[i];
            for (const Edge& e : edges) sum += side(e.i) != side(e.j) ? e.price : 0;
            return sum;
        };
        double lowest = std::numeric_limits<double>::max();
        for (std::uint32_t mask = 0; mask < 1U << n; ++mask) {
            lowest = std::min(lowest, cost([mask](std::size_t i) { return mask >> i & 1U; }));
        }
        const std::vector<std::uint8_t>& side = cut.solve();
        EXPECT_NEAR(cost([&](std::size_t i) { return side[i]; }), lowest, 1e-9);
    }
}

TEST(BandCut, MovesAWholeRowThatNoSingleFaceWouldLeave) {
    // A ladder of two rows: the second row prefers the first side a little, less than one step of border costs.
    constexpr std::size_t columns = 20;
    BandCut cut;
    for (std::size_t i = 0; i < columns; ++i) cut.add_node(0, 1);
    for (std::size_t i = 0; i < columns; ++i) cut.add_node(0, 0.1);
    for (std::size_t i = 0; i < columns; ++i) {
        cut.add_edge(i, 2, columns + i, 2, 1);
        if (i + 1 == columns) continue;
        cut.add_edge(i, 0, i + 1, 1, 1);
        cut.add_edge(columns + i, 0, columns + i + 1, 1, 1);
    }
    for (const std::uint8_t side : cut.solve()) EXPECT_EQ(side, 0);
}

TEST(BandCut, NoNodesNoEdgesNoTrouble) {
    BandCut cut;
    EXPECT_TRUE(cut.solve().empty());
    cut.add_node(2, 1);
    cut.add_node(1, 2);
    EXPECT_EQ(cut.solve(), (std::vector<std::uint8_t>{1, 0}));
}

}  // namespace
}  // namespace quadseg
