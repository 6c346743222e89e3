// Numbers and words of text files, independent of the locale. Every line of the text must end in '\n' (FileContents
// sees to that), which is what lets these functions look ahead without asking for the end.
#pragma once

#include <cctype>
#include <cstdint>
#include <cstring>
#include <fast_float/fast_float.h>
#include <string>
#include <string_view>
#include <system_error>

namespace quadseg::io {

inline bool is_blank(char c) noexcept {
    // Most are digits: one comparison.
    return c <= ' ' && (c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f');
}
inline void skip_blanks(const char*& p) noexcept {
    while (is_blank(*p)) ++p;
}
/// What may follow a number or word.
inline bool is_separator(char c) noexcept {
    return c == ' ' || c == '\n' || is_blank(c) || c == '#';
}
inline void skip_word(const char*& p) noexcept {
    while (!is_blank(*p) && *p != '\n') ++p;
}
/// The blank-separated word at p, which is moved behind it.
inline std::string_view take_word(const char*& p) noexcept {
    skip_blanks(p);
    const char* first = p;
    skip_word(p);
    return {first, static_cast<std::size_t>(p - first)};
}
/// Behind the '\n' that ends the line of p.
inline const char* next_line(const char* p, const char* end) noexcept {
    if (*p == '\n') return p + 1;
    return static_cast<const char*>(std::memchr(p, '\n', static_cast<std::size_t>(end - p) + 1)) + 1;
}

/// False if there is no number at p. NaN and infinity are numbers here: the caller tells the user where they stand.
inline bool take_real(const char*& p, const char* end, double& value) noexcept {
    skip_blanks(p);
    const char* first = p;
    if (*first == '+' && first[1] != '-') ++first;
    const auto result = fast_float::from_chars(first, end, value);
    if (result.ec == std::errc::invalid_argument || !is_separator(*result.ptr)) return false;
    p = result.ptr;
    return true;
}

/// Up to 18 digits with a sign; false if there is no integer at p. What follows is the caller's business.
inline bool take_digits(const char*& p, std::int64_t& value) noexcept {
    const char* q = p;
    const bool negative = *q == '-';
    if (negative || *q == '+') ++q;
    const char* digits = q;
    std::uint64_t sum = 0;  // wraps round where there are too many
    for (unsigned digit; (digit = static_cast<unsigned char>(*q) - unsigned{'0'}) <= 9; ++q) sum = 10 * sum + digit;
    if (q == digits || q - digits > 18) return false;
    p = q;
    value = negative ? -static_cast<std::int64_t>(sum) : static_cast<std::int64_t>(sum);
    return true;
}
inline bool take_integer(const char*& p, std::int64_t& value) noexcept {
    skip_blanks(p);
    const char* q = p;
    if (!take_digits(q, value) || !is_separator(*q)) return false;
    p = q;
    return true;
}

/// Up to nine digits behind blanks and before one or the line's end, which is nearly every index; false, and p as it
/// was, for whatever else take_integer() may find there.
inline bool take_plain_index(const char*& p, std::uint32_t& value) noexcept {
    const char* q = p;
    while (*q == ' ') ++q;
    const char* digits = q;
    std::uint32_t sum = 0;  // wraps round where there are too many
    for (unsigned digit; (digit = static_cast<unsigned char>(*q) - unsigned{'0'}) <= 9; ++q) sum = 10 * sum + digit;
    const auto count = static_cast<std::size_t>(q - digits);
    if (count - 1 >= 9 || (*q != ' ' && *q != '\n')) return false;
    p = q;
    value = sum;
    return true;
}

/// The word at p for a message: shortened, unprintable bytes as '?'.
inline std::string quoted_word(const char* p) {
    skip_blanks(p);
    if (*p == '\n') return "the end of the line";
    std::string word = "'";
    for (; !is_blank(*p) && *p != '\n'; ++p) {
        if (word.size() > 24) {
            word += "...";
            break;
        }
        word += std::isprint(static_cast<unsigned char>(*p)) != 0 ? *p : '?';
    }
    return word + "'";
}

}  // namespace quadseg::io
