// A whole input file in memory, and how a fault in it is reported.
#pragma once

#include <quadseg/error.h>

#include "runtime/run_control.h"

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace quadseg::io {

/// Something wrong at a place of the file. Blocks that are parsed at once keep theirs; the first one is reported.
struct Fault {
    ErrorCode code = ErrorCode::file_format;
    const char* where = nullptr;  ///< into the contents
    std::string text;
};

/// Read rather than mapped: a file that another program cuts short must give an Error, not a SIGBUS.
class FileContents {
  public:
    /// Reads a regular file or a pipe. Throws Error file_open, memory_limit; runtime::Stopped.
    FileContents(const std::string& path, const runtime::RunControl& control, std::size_t memory_limit);
    /// A copy of bytes that are in memory already; `name` stands for the path in messages.
    FileContents(std::string_view bytes, const std::string& name);

    const char* begin() const noexcept { return data_.get(); }
    /// *end() is '\n', so that every line ends in one.
    const char* end() const noexcept { return data_.get() + size_; }
    std::size_t size() const noexcept { return size_; }
    std::string_view text() const noexcept { return {data_.get(), size_}; }
    const std::string& path() const noexcept { return path_; }

    /// Blanks out a byte order mark of UTF-8; where no line ends in '\n' (old Macintosh files), makes every '\r' one.
    void unify_text() noexcept;

    [[noreturn]] void fail_at_line(const Fault& fault) const;
    [[noreturn]] void fail_at_byte(const Fault& fault) const;
    /// For faults that concern the file as a whole.
    [[noreturn]] void fail(ErrorCode code, const std::string& text) const;

  private:
    void read_regular(int descriptor, const runtime::RunControl& control);
    void read_pipe(int descriptor, const runtime::RunControl& control);

    std::string path_;
    std::unique_ptr<char[]> data_;
    std::size_t size_ = 0;
};

}  // namespace quadseg::io
