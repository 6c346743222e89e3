#include "capi/guard.h"
#include "capi/handles.h"

#include <limits>
#include <memory>

using namespace quadseg;
using capi::guarded, capi::null_pointer;

extern "C" {

quadseg_status quadseg_context_create(quadseg_context** context) {
    if (!context) return null_pointer("context");
    *context = nullptr;
    return guarded([&] {
        *context = std::make_unique<quadseg_context>().release();
        return QUADSEG_OK;
    });
}

void quadseg_context_destroy(quadseg_context* context) {
    delete context;
}

void quadseg_context_cancel(quadseg_context* context) {
    if (context) context->context.cancel();
}

int32_t quadseg_context_cancelled(const quadseg_context* context) {
    return context && context->context.cancelled() ? 1 : 0;
}

quadseg_status quadseg_context_set_time_limit(quadseg_context* context, double seconds) {
    if (!context) return null_pointer("context");
    return guarded([&] {
        context->context.set_time_limit(seconds);
        return QUADSEG_OK;
    });
}

quadseg_status quadseg_context_set_threads(quadseg_context* context, int32_t threads) {
    if (!context) return null_pointer("context");
    return guarded([&] {
        context->context.set_threads(threads);
        return QUADSEG_OK;
    });
}

quadseg_status quadseg_context_set_memory_limit(quadseg_context* context, uint64_t bytes) {
    if (!context) return null_pointer("context");
    if (bytes > std::numeric_limits<std::size_t>::max()) bytes = 0;  // no machine of this word size has more
    context->context.set_memory_limit(static_cast<std::size_t>(bytes));
    return QUADSEG_OK;
}

quadseg_status quadseg_context_set_progress(quadseg_context* context, quadseg_progress_function function,
                                            void* user_data) {
    if (!context) return null_pointer("context");
    return guarded([&] {
        if (!function) {
            context->context.on_progress(nullptr);
            return QUADSEG_OK;
        }
        context->context.on_progress([function, user_data](const Progress& progress) {
            const quadseg_progress report{sizeof(quadseg_progress), static_cast<std::int32_t>(progress.phase),
                                          progress.fraction, progress.regions, progress.energy};
            return function(&report, user_data) != 0;
        });
        return QUADSEG_OK;
    });
}

}  // extern "C"
