// Owner of a POSIX file descriptor.
#pragma once

#include <unistd.h>

namespace quadseg::io {

class FileDescriptor {
  public:
    explicit FileDescriptor(int number) noexcept : number_(number) {}
    ~FileDescriptor() {
        if (number_ >= 0) ::close(number_);
    }
    FileDescriptor(const FileDescriptor&) = delete;
    FileDescriptor& operator=(const FileDescriptor&) = delete;

    int number() const noexcept { return number_; }
    /// Gives the number away; the caller closes it.
    int release() noexcept {
        const int number = number_;
        number_ = -1;
        return number;
    }

  private:
    int number_;
};

}  // namespace quadseg::io
