#include <quadseg/error.h>
#include <quadseg/segmenter.h>

#include "loop_support.h"

#include <functional>
#include <gtest/gtest.h>
#include <set>

namespace quadseg::test {
namespace {

std::vector<std::int32_t> copy_of(std::span<const std::int32_t> labels) {
    return {labels.begin(), labels.end()};
}

ErrorCode code_of(const std::function<void()>& body) {
    try {
        body();
    } catch (const Error& error) {
        return error.code();
    }
    return ErrorCode::internal;
}

void expect_labels(const Segmenter& s, std::size_t faces) {
    ASSERT_EQ(s.labels().size(), faces);
    const std::set<std::int32_t> seen(s.labels().begin(), s.labels().end());
    EXPECT_EQ(seen.size(), s.region_count());
    EXPECT_EQ(*seen.begin(), 0);
    EXPECT_EQ(*seen.rbegin(), static_cast<std::int32_t>(s.region_count()) - 1);
}

TEST(Segmenter, BeginsWithTheComponents) {
    const Shape shape = joined(box(2), box(3, 5));
    const Segmenter s(shape.view(), paper_options());
    EXPECT_EQ(s.region_count(), 2U);
    expect_labels(s, shape.faces());
    EXPECT_EQ(s.input().components, 2U);
}

TEST(Segmenter, SegmentsABoxByHand) {
    const Shape shape = box(4);
    Segmenter s(shape.view(), paper_options());
    double energy = s.energy().total;
    EXPECT_GT(energy, 0.1);
    while (s.region_count() < 6) {
        const auto before = s.region_count();
        EXPECT_EQ(s.insert(), static_cast<std::int32_t>(before));
        expect_labels(s, shape.faces());
        s.relax(30);
    }
    EXPECT_LT(s.relax(30), energy);
}

TEST(Segmenter, InsertTakesTheGivenFace) {
    const Shape shape = box(4);
    Segmenter s(shape.view(), paper_options());
    const std::int32_t label = s.insert(17);
    EXPECT_EQ(label, 1);
    EXPECT_EQ(s.labels()[17], label);
    expect_labels(s, shape.faces());
}

TEST(Segmenter, MergesAndKnowsWhatItCosts) {
    const Shape shape = grid(6, 6);
    Segmenter s(shape.view(), paper_options());
    std::vector<std::int32_t> thirds(shape.faces());
    for (std::size_t f = 0; f < thirds.size(); ++f) thirds[f] = f < 24 ? -5 : f < 48 ? 100 : 7;
    s.set_labels(thirds);
    ASSERT_EQ(s.region_count(), 3U);
    const auto labels = copy_of(s.labels());
    const auto candidate = s.merge_candidate(labels[0], labels[30]);
    EXPECT_TRUE(candidate.valid);
    EXPECT_LT(std::abs(candidate.increase), 1e-12);
    EXPECT_EQ(copy_of(s.labels()), labels);  // nothing changed
    EXPECT_EQ(code_of([&] { s.merge(labels[0], labels[60]); }), ErrorCode::invalid_argument);
    EXPECT_EQ(code_of([&] { s.merge(labels[0], labels[0]); }), ErrorCode::invalid_argument);
    EXPECT_EQ(code_of([&] { s.merge(0, 99); }), ErrorCode::invalid_argument);
    EXPECT_EQ(s.region_count(), 3U);
    s.merge(labels[0], labels[30]);
    EXPECT_EQ(s.region_count(), 2U);
    expect_labels(s, shape.faces());
    EXPECT_EQ(s.labels()[0], s.labels()[30]);
    EXPECT_NE(s.labels()[0], s.labels()[60]);
}

TEST(Segmenter, SetLabelsSplitsWhatIsNotConnected) {
    const Shape shape = grid(6, 1);
    Segmenter s(shape.view(), paper_options());
    std::vector<std::int32_t> labels(shape.faces(), 3);
    labels[4] = labels[5] = 8;  // a square in the middle of the row
    s.set_labels(labels);
    EXPECT_EQ(s.region_count(), 3U);
    expect_labels(s, shape.faces());
    EXPECT_EQ(code_of([&] { s.set_labels(std::span<const std::int32_t>(labels).first(3)); }),
              ErrorCode::invalid_argument);
}

TEST(Segmenter, UndoRestoresBytes) {
    const Shape shape = bumpy_grid(12);
    Segmenter s(shape.view(), paper_options(5));
    std::vector<std::vector<std::int32_t>> labels;
    std::vector<Energy> energies;
    const auto note = [&] {
        labels.push_back(copy_of(s.labels()));
        energies.push_back(s.energy());
    };
    note();
    s.insert();
    note();
    s.insert(3);
    note();
    s.relax(2);
    note();
    s.run();
    note();
    s.merge(s.labels()[0], [&] {
        for (std::int32_t b = 0; b < static_cast<std::int32_t>(s.region_count()); ++b) {
            if (b == s.labels()[0]) continue;
            try {
                (void)s.merge_candidate(s.labels()[0], b);
                return b;
            } catch (const Error&) {
            }
        }
        return -1;
    }());
    for (std::size_t i = labels.size(); i-- > 0;) {
        EXPECT_TRUE(s.undo());
        EXPECT_EQ(copy_of(s.labels()), labels[i]);
        EXPECT_EQ(s.energy().total, energies[i].total);
        EXPECT_EQ(s.energy().normal, energies[i].normal);
    }
    EXPECT_FALSE(s.undo());
}

TEST(Segmenter, RepeatsItselfAfterUndo) {
    const Shape shape = bumpy_grid(12);
    Segmenter s(shape.view(), paper_options());
    s.insert();
    s.relax(3);
    const auto once = copy_of(s.labels());
    s.undo();
    s.relax(3);
    EXPECT_EQ(copy_of(s.labels()), once);
}

TEST(Segmenter, RunIsTheWholeSegmentation) {
    const Shape shape = box(5);
    Segmenter s(shape.view(), paper_options());
    EXPECT_EQ(s.run(), StopReason::tolerance);
    EXPECT_EQ(s.region_count(), 6U);
    EXPECT_LT(s.energy().total, 1e-10);
    const Segmentation result = s.result();
    EXPECT_EQ(result.regions.size(), 6U);
    EXPECT_EQ(result.labels, copy_of(s.labels()));
    EXPECT_EQ(result.stop, StopReason::tolerance);
}

TEST(Segmenter, ResultIsOfTheCurrentPartition) {
    const Shape shape = box(4);
    Segmenter s(shape.view(), paper_options());
    s.run();
    s.undo();
    EXPECT_EQ(s.result().regions.size(), 1U);
}

TEST(Segmenter, RefusesFacesAndNumbersThatAreNot) {
    const Shape shape = tetrahedron();
    Segmenter s(shape.view(), paper_options());
    EXPECT_EQ(code_of([&] { s.insert(4); }), ErrorCode::invalid_argument);
    EXPECT_EQ(code_of([&] { s.relax(0); }), ErrorCode::invalid_argument);
    while (s.region_count() < 4) s.insert();
    EXPECT_EQ(code_of([&] { s.insert(); }), ErrorCode::invalid_argument);
    EXPECT_EQ(code_of([&] { s.insert(0); }), ErrorCode::invalid_argument);
    EXPECT_EQ(s.region_count(), 4U);
    Options wrong = paper_options();
    wrong.weight = -1;
    EXPECT_EQ(code_of([&] { Segmenter bad(shape.view(), wrong); }), ErrorCode::invalid_argument);
}

TEST(Segmenter, CancelledOperationsChangeNothing) {
    const Shape shape = bumpy_grid(20);
    Context context;
    Segmenter s(shape.view(), paper_options(8), &context);
    s.insert();
    const auto labels = copy_of(s.labels());
    context.cancel();
    EXPECT_EQ(code_of([&] { s.relax(5); }), ErrorCode::cancelled);
    EXPECT_EQ(copy_of(s.labels()), labels);
    EXPECT_EQ(s.result().labels, labels);
    EXPECT_TRUE(s.undo());
    EXPECT_EQ(code_of([&] { Segmenter late(shape.view(), paper_options(), &context); }), ErrorCode::cancelled);
}

TEST(Segmenter, MayBeMoved) {
    const Shape shape = box(3);
    Segmenter a(shape.view(), paper_options());
    a.insert();
    Segmenter b = std::move(a);
    b.relax(2);
    EXPECT_TRUE(b.undo());
    EXPECT_TRUE(b.undo());
    EXPECT_EQ(b.region_count(), 1U);
}

TEST(Segmenter, RunsAgainUnderOtherOptionsAsIfPreparedForThem) {
    const Shape shape = joined(box(4), box(5, 5));
    for (const double angle : {0.0, 30.0}) {
        Options first = paper_options(), second;
        second.feature_angle = angle;
        Segmenter reused(shape.view(), first);
        reused.run();
        reused.set_options(second);
        EXPECT_FALSE(reused.undo());
        reused.run();
        Segmenter fresh(shape.view(), second);
        fresh.run();
        EXPECT_EQ(copy_of(reused.labels()), copy_of(fresh.labels()));
        EXPECT_EQ(reused.result().regions.size(), fresh.result().regions.size());
    }
    Options wrong;
    wrong.detail = -1;
    Segmenter s(shape.view(), paper_options());
    s.run();
    const auto before = copy_of(s.labels());
    EXPECT_EQ(code_of([&] { s.set_options(wrong); }), ErrorCode::invalid_argument);
    EXPECT_EQ(copy_of(s.labels()), before);
}

TEST(Segmenter, AnotherContextAfterACancelledOne) {
    const Shape shape = box(4);
    Context context;
    Segmenter s(shape.view(), paper_options(), &context);
    const auto before = copy_of(s.labels());
    context.cancel();
    EXPECT_EQ(code_of([&] { s.relax(); }), ErrorCode::cancelled);
    EXPECT_EQ(code_of([&] { s.set_options({}); }), ErrorCode::cancelled);
    EXPECT_EQ(copy_of(s.labels()), before);
    s.set_context(nullptr);
    s.run();
    EXPECT_EQ(s.region_count(), 6U);
}

}  // namespace
}  // namespace quadseg::test
