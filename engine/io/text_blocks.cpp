#include "io/text_blocks.h"

#include "runtime/parallel.h"

#include <algorithm>

namespace quadseg::io {
namespace {

constexpr std::ptrdiff_t block_bytes = std::ptrdiff_t{1} << 18U;  // about a millisecond of parsing

bool is_continued(const char* begin, const char* line_end) noexcept {
    const char* last = line_end;
    if (last > begin && last[-1] == '\r') --last;
    return last > begin && last[-1] == '\\';
}

}  // namespace

std::vector<TextBlock> cut_text(const char* begin, const char* end, Continuation continuation) {
    std::vector<TextBlock> blocks;
    blocks.reserve(static_cast<std::size_t>((end - begin) / block_bytes + 1));
    for (const char* p = begin; p < end;) {
        const char* cut = end;
        if (end - p > block_bytes) {
            cut = next_line(p + block_bytes, end);
            while (continuation == Continuation::backslash && cut < end && is_continued(begin, cut - 1)) {
                cut = next_line(cut, end);
            }
            cut = std::min(cut, end);
        }
        blocks.push_back({p, cut, 0});
        p = cut;
    }
    return blocks;
}

std::size_t count_data_lines(std::vector<TextBlock>& blocks, const char* end, bool comments,
                             const runtime::RunControl& control) {
    std::vector<std::size_t> counts(blocks.size());
    runtime::parallel_for(blocks.size(), 1, [&](std::size_t b) {
        control.check();
        std::size_t lines = 0;
        for_data_lines(blocks[b], end, comments, 0, static_cast<std::size_t>(-1), [&](const char*, std::size_t) {
            ++lines;
            return true;
        });
        counts[b] = lines;
    });
    const std::size_t total = runtime::exclusive_scan(counts);
    for (std::size_t b = 0; b < blocks.size(); ++b) blocks[b].first_item = counts[b];
    return total;
}

}  // namespace quadseg::io
