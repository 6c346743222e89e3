// Operators new and delete that count, and that fail from a chosen allocation on. For one file of a test program.
#pragma once

// ThreadSanitizer under clang has operators new and delete of its own that cannot be replaced.
#if defined(__SANITIZE_THREAD__)
#define QUADSEG_THREAD_SANITIZER
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define QUADSEG_THREAD_SANITIZER
#endif
#endif
#ifndef QUADSEG_THREAD_SANITIZER

#include <atomic>
#include <cstddef>
#include <cstdlib>
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

#endif
