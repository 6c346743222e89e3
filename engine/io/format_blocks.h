// Files that are made block by block: blocks are formatted at once and written in order.
#pragma once

#include "io/atomic_file.h"
#include "runtime/parallel.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace quadseg::io {

/// Bytes that are not cleared before they are written: each is made just once.
class RawBytes {
  public:
    /// Of so many bytes that are not set; what was there is lost.
    char* make(std::size_t size) {
        if (size > capacity_) {
            bytes_ = std::make_unique_for_overwrite<char[]>(size);
            capacity_ = size;
        }
        size_ = size;
        return bytes_.get();
    }
    void shorten(std::size_t size) noexcept { size_ = size; }
    operator std::string_view() const noexcept { return {bytes_.get(), size_}; }

  private:
    std::unique_ptr<char[]> bytes_;
    std::size_t size_ = 0, capacity_ = 0;
};

/// format(begin, end, out) makes the bytes of the items [begin, end) of [0, count); `out` comes with old contents.
template <class Block = std::string, class Format>
void write_blocks(AtomicFile& file, std::size_t count, const Format& format) {
    constexpr std::size_t block_items = 32768;
    constexpr std::size_t blocks_at_once = 32;  // bounds the memory
    constexpr std::size_t round_items = block_items * blocks_at_once;
    std::vector<Block> blocks(std::min(blocks_at_once, (count + block_items - 1) / block_items));
    for (std::size_t first = 0; first < count; first += round_items) {
        const std::size_t items = std::min(round_items, count - first);
        runtime::parallel_blocks(items, block_items, [&](std::size_t begin, std::size_t end) {
            format(first + begin, first + end, blocks[begin / block_items]);
        });
        for (std::size_t b = 0; b * block_items < items; ++b) file.write(blocks[b]);
    }
}

}  // namespace quadseg::io
