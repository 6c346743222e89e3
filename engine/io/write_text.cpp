// Text files: labels, and whatever the caller has put into a string.
#include <quadseg/error.h>
#include <quadseg/io.h>

#include "io/atomic_file.h"
#include "io/format_blocks.h"

#include <charconv>

namespace quadseg {

void write_text(const std::string& path, const std::string& text) {
    io::AtomicFile file(path);
    file.write(text);
    file.commit();
}

void write_labels(const std::string& path, std::span<const std::int32_t> labels,
                  std::span<const std::uint32_t> polygons) {
    if (!polygons.empty() && polygons.size() != labels.size()) {
        throw Error(ErrorCode::invalid_argument, path + ": " + std::to_string(labels.size()) + " labels but " +
                                                     std::to_string(polygons.size()) + " polygon numbers");
    }
    io::AtomicFile file(path);
    io::write_blocks<io::RawBytes>(file, labels.size(), [&](std::size_t begin, std::size_t end, io::RawBytes& out) {
        constexpr std::size_t longest_line = 12;
        char* const first = out.make((end - begin) * longest_line);
        char* p = first;
        for (std::size_t i = begin; i < end; ++i) {
            if (!polygons.empty() && i > 0 && polygons[i] == polygons[i - 1]) continue;
            p = std::to_chars(p, p + longest_line, labels[i]).ptr;
            *p++ = '\n';
        }
        out.shorten(static_cast<std::size_t>(p - first));
    });
    file.commit();
}

}  // namespace quadseg
