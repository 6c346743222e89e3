// What can go wrong, by name. Every exception that leaves the library is an Error (or std::bad_alloc).
#pragma once

#include <quadseg/export.h>

#include <stdexcept>
#include <string>

namespace quadseg {

enum class ErrorCode {
    invalid_argument,  ///< an option out of range or arrays of the wrong shape; the text names the option and its range
    invalid_mesh,  ///< the arrays are no mesh: index out of range, non-finite coordinate; the text names the face or
                   ///< vertex
    empty_mesh,    ///< no face has an area
    file_open,     ///< missing file, directory, no permission
    file_format,   ///< contents do not follow the format; the text names line or byte
    file_write,    ///< disk full, read-only folder
    cancelled,     ///< cancelled or out of time before there was any partial result
    memory_limit,  ///< the job would need more than Context::set_memory_limit allows; the text gives both figures
    internal       ///< a defect of ours
};

/// Thread-safe. what() says what, where (face, vertex, line, byte), and what to do.
class QUADSEG_API Error : public std::runtime_error {
  public:
    Error(ErrorCode code, const std::string& text) : std::runtime_error(text), code_(code) {}
    ErrorCode code() const noexcept { return code_; }

  private:
    ErrorCode code_;
};

/// "invalid_argument" and so on. Never null.
QUADSEG_API const char* to_string(ErrorCode code) noexcept;

}  // namespace quadseg
