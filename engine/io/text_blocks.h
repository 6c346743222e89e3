// Text cut at line ends into blocks that can be parsed at once.
#pragma once

#include "io/file_contents.h"
#include "io/numbers.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace quadseg::io {

struct TextBlock {
    const char* begin = nullptr;
    const char* end = nullptr;   ///< begin of the next block
    std::size_t first_item = 0;  ///< data lines before this block, once counted
};

enum class Continuation { none, backslash };  ///< backslash: a line that ends in one goes on in the next

std::vector<TextBlock> cut_text(const char* begin, const char* end, Continuation continuation = Continuation::none);

/// Fills first_item and returns the number of data lines: neither blank nor, with `comments`, beginning with '#'.
std::size_t count_data_lines(std::vector<TextBlock>& blocks, const char* end, bool comments,
                             const runtime::RunControl& control);

/// visit(line begin, index of the data line) for the data lines of a block whose index is in [first, last), until it
/// returns false.
template <class Visit>
void for_data_lines(const TextBlock& block, const char* end, bool comments, std::size_t first, std::size_t last,
                    const Visit& visit) {
    std::size_t item = block.first_item;
    for (const char* p = block.begin; p < block.end && item < last;) {
        skip_blanks(p);
        if (*p != '\n' && !(comments && *p == '#')) {
            if (item >= first && !visit(p, item)) return;
            ++item;
        }
        p = next_line(p, end);
    }
}

/// The fault of the first block that has one.
inline const Fault* first_fault(const std::vector<std::optional<Fault>>& faults) noexcept {
    for (const auto& fault : faults) {
        if (fault) return &*fault;
    }
    return nullptr;
}

}  // namespace quadseg::io
