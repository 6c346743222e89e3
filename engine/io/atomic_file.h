// Files that appear under their name whole or not at all.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace quadseg::io {

/// Writes under a temporary name in the same folder; commit() flushes to disk and renames. Without commit() nothing is
/// left. A name that stands for a device or pipe is written to directly. All throw Error file_write.
class AtomicFile {
  public:
    explicit AtomicFile(const std::string& path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    void write(std::string_view bytes);
    void commit();

  private:
    [[noreturn]] void fail(const std::string& what, int number) const;
    void open_temporary();

    std::string path_;       ///< as the caller named it, for messages
    std::string target_;     ///< links resolved
    std::string temporary_;  ///< empty for a device and once renamed
    int descriptor_ = -1;
};

}  // namespace quadseg::io
