#include "capi/last_error.h"

#include <cstdarg>
#include <cstddef>
#include <cstdio>

namespace {

constexpr std::size_t text_size = 1024;
thread_local char text[text_size] = "";

bool continues_character(char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

}  // namespace

namespace quadseg::capi {

quadseg_status fail(quadseg_status status, const char* format, ...) noexcept {
    std::va_list arguments;
    va_start(arguments, format);
    const int wanted = std::vsnprintf(text, text_size, format, arguments);
    va_end(arguments);
    if (wanted < 0) {
        text[0] = '\0';
    } else if (static_cast<std::size_t>(wanted) >= text_size) {
        // The cut may have gone through a UTF-8 character: drop its rest.
        std::size_t end = text_size - 1;
        while (end > 0 && continues_character(text[end - 1])) --end;
        if (end > 0) text[end - 1] = '\0';
    }
    return status;
}

}  // namespace quadseg::capi

extern "C" const char* quadseg_last_error() {
    return text;
}
