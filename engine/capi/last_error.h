// The text behind quadseg_last_error(). One fixed buffer a thread: setting it can't fail, even when memory is out.
#pragma once

#include <quadseg/quadseg.h>

namespace quadseg::capi {

/// Keeps the text (cut to what fits, at a whole character) for the calling thread and returns the status.
quadseg_status fail(quadseg_status status, const char* format, ...) noexcept __attribute__((format(printf, 2, 3)));

}  // namespace quadseg::capi
