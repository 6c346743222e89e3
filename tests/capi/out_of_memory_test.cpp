// An allocation that fails, at every place where a small job allocates: a status, a text, nothing lost, no end of the
// process. Allocations inside TBB's own library are not reached by this.
#include "tests/hostile/failing_allocations.h"

#ifndef QUADSEG_THREAD_SANITIZER

#include <quadseg/quadseg.h>

#include "tests/capi/shapes.h"

#include <gtest/gtest.h>

namespace quadseg::capi_test {
namespace {

/// One small job from context to labels, with one thread so that allocations have an order.
quadseg_status small_job(const quadseg_mesh_view& view, int32_t* labels) {
    quadseg_context* context = nullptr;
    quadseg_segmentation* segmentation = nullptr;
    quadseg_status status = quadseg_context_create(&context);
    if (!status) status = quadseg_context_set_threads(context, 1);
    if (!status) status = quadseg_segment(&view, nullptr, context, &segmentation);
    if (!status) status = quadseg_segmentation_labels(segmentation, labels, view.face_count);
    quadseg_segmentation_destroy(segmentation);
    quadseg_context_destroy(context);
    return status;
}

TEST(OutOfMemory, AtEveryAllocationOfASmallJob) {
    const Arrays mesh = can(12, 2);
    const auto view = mesh.view();
    std::vector<std::int32_t> labels(view.face_count);
    ASSERT_EQ(small_job(view, labels.data()), QUADSEG_OK);  // what is allocated once a process is there from now on
    const long live_before = live.load();
    allocations = 0;
    ASSERT_EQ(small_job(view, labels.data()), QUADSEG_OK);
    const long total = allocations.load();
    ASSERT_GT(total, 50);
    EXPECT_EQ(live.load(), live_before) << "a job leaks";

    const long stride = std::max(1L, total / 1500);  // the fast tier; the first and last ones are always tried
    long tried = 0;
    for (long k = 0; k < total; k += k < 200 || k > total - 200 ? 1 : stride) {
        allocations = 0;
        failing = k;
        const quadseg_status status = small_job(view, labels.data());
        failing = -1;
        ASSERT_EQ(status, QUADSEG_OUT_OF_MEMORY) << "allocation " << k << ": " << quadseg_last_error();
        ASSERT_STREQ(quadseg_last_error(), "out of memory");
        ASSERT_EQ(live.load(), live_before) << "allocation " << k << " leaves something behind";
        ++tried;
    }
    RecordProperty("allocations", std::to_string(total));
    RecordProperty("tried", std::to_string(tried));
    EXPECT_EQ(small_job(view, labels.data()), QUADSEG_OK);
}

}  // namespace
}  // namespace quadseg::capi_test

#endif
