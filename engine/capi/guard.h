// The catch-all at the border: no exception leaves a function of the C interface.
#pragma once

#include <quadseg/error.h>

#include "capi/last_error.h"

#include <exception>
#include <new>
#include <stdexcept>

namespace quadseg::capi {

inline quadseg_status status_of(ErrorCode code) noexcept {
    switch (code) {
        case ErrorCode::invalid_argument:
            return QUADSEG_INVALID_ARGUMENT;
        case ErrorCode::invalid_mesh:
            return QUADSEG_INVALID_MESH;
        case ErrorCode::empty_mesh:
            return QUADSEG_EMPTY_MESH;
        case ErrorCode::file_open:
            return QUADSEG_FILE_OPEN;
        case ErrorCode::file_format:
            return QUADSEG_FILE_FORMAT;
        case ErrorCode::file_write:
            return QUADSEG_FILE_WRITE;
        case ErrorCode::cancelled:
            return QUADSEG_CANCELLED;
        case ErrorCode::memory_limit:
            return QUADSEG_MEMORY_LIMIT;
        case ErrorCode::internal:
            break;
    }
    return QUADSEG_INTERNAL;
}

/// Runs `work`, which returns a status, and turns what it throws into one.
template <class Work>
quadseg_status guarded(const Work& work) noexcept {
    try {
        return work();
    } catch (const Error& error) {
        return fail(status_of(error.code()), "%s", error.what());
    } catch (const std::bad_alloc&) {
        return fail(QUADSEG_OUT_OF_MEMORY, "out of memory");
    } catch (const std::length_error&) {  // a container asked for more than there can be
        return fail(QUADSEG_OUT_OF_MEMORY, "out of memory");
    } catch (const std::exception& error) {
        return fail(QUADSEG_INTERNAL, "unexpected: %s", error.what());
    } catch (...) {
        return fail(QUADSEG_INTERNAL, "unexpected exception");
    }
}

/// For handles, outputs, texts: a null pointer is the caller's mistake, named.
inline quadseg_status null_pointer(const char* name) noexcept {
    return fail(QUADSEG_INVALID_ARGUMENT, "%s: must not be null", name);
}

}  // namespace quadseg::capi
