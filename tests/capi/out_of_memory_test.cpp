// An allocation that fails, at every place where a small job allocates: a status, a text, nothing lost, no end of the
// process. Allocations inside TBB's own library are not reached by this.
// ThreadSanitizer under clang has operators new and delete of its own that cannot be replaced.
#if defined(__SANITIZE_THREAD__)
#define QUADSEG_THREAD_SANITIZER
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define QUADSEG_THREAD_SANITIZER
#endif
#endif
#ifndef QUADSEG_THREAD_SANITIZER

#include <quadseg/quadseg.h>

#include "tests/capi/shapes.h"

#include <atomic>
#include <cstdlib>
#include <gtest/gtest.h>
#include <new>

namespace {

std::atomic<long> allocations{0};
std::atomic<long> failing{-1};  // number of the allocation that fails, and all after it
std::atomic<long> live{0};

void* allocate(std::size_t size, std::size_t alignment) {
    const long number = allocations.fetch_add(1);
    const long from = failing.load();
    void* memory = from >= 0 && number >= from ? nullptr
                   : alignment == 0            ? std::malloc(size > 0 ? size : 1)
                                    : std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
    if (!memory) throw std::bad_alloc();
    live.fetch_add(1);
    return memory;
}

void release(void* memory) noexcept {
    if (memory) live.fetch_sub(1);
    std::free(memory);
}

}  // namespace

void* operator new(std::size_t size) {
    return allocate(size, 0);
}
void* operator new[](std::size_t size) {
    return allocate(size, 0);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
    return allocate(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
    return allocate(size, static_cast<std::size_t>(alignment));
}
// The library's own ones would do, but a sanitizer's do not go through those above.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    try {
        return allocate(size, 0);
    } catch (const std::bad_alloc&) {
        return nullptr;
    }
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
    return operator new(size, std::nothrow);
}
void operator delete(void* memory) noexcept {
    release(memory);
}
void operator delete[](void* memory) noexcept {
    release(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    release(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
    release(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
    release(memory);
}
void operator delete[](void* memory, std::align_val_t) noexcept {
    release(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
    release(memory);
}
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept {
    release(memory);
}

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
